# pyright: reportArgumentType=false, reportReturnType=false, reportIndexIssue=false, reportCallIssue=false
# pyright: reportAttributeAccessIssue=false, reportGeneralTypeIssues=false, reportOptionalSubscript=false
# shapely's types do not tell one shape from an array of them.
"""The floor of a piece of a level, seen from above, exact: polygons of the mesh's own faces, no cells.

The rules are those of `navmesh.WalkRules`. `FloorPlan` takes them loosely where asked to, so that one can
find out which rule keeps two places apart, and by how much: that is what a designer needs to know.
"""

import math
from typing import NamedTuple

import numpy as np
import shapely
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

import navmesh
from navmesh.surface.ledges import GAP
from runtime.playtest.mesh import THIN, Mesh, parts_within, united

__all__ = ["Allowance", "FloorPlan"]

_SAME = 0.01  # [m] parts of the mesh nearer to each other in height are one surface, as in the graph
_TOUCH = 0.003  # [m] apart in plan, floors share a border: two walls' thickness and a rounding error
_COPLANAR = 1e-5  # [m] and slopes
_SLIVER = 1e-5  # [m] narrower strips of floor come of rounding
_WELD = 5e-4  # [m] corners nearer to each other than this are one
_NEAR = 0.15  # [m] that a place may be off the floor that it stands on: the graph samples


class Allowance(NamedTuple):
    """What a body gets over: slope [rad], step [m], free height [m], and gaps in the floor [m]."""

    slope: float
    step: float
    headroom: float
    crack: float

    @classmethod
    def of(cls, rules: navmesh.WalkRules) -> "Allowance":
        """What ``rules`` allow, and the gaps that the graph takes for floor."""
        return cls(rules.max_slope, rules.max_step, rules.headroom, GAP)


class FloorPlan:
    """The floor that a body could walk on inside a box of the level, under an `Allowance`."""

    def __init__(self, mesh: Mesh, low: np.ndarray, high: np.ndarray, allowed: Allowance) -> None:
        """``low``, ``high`` (3,) [m]: the box; floors above or below it are left out."""
        self.allowed = allowed
        room = np.array([0.0, 0.0, allowed.headroom])
        near = mesh.within(low, high + room)
        flat = mesh.up[near] >= math.cos(allowed.slope) - 1e-9
        walked = (flat | _on_risers(mesh, near, flat, allowed.step)) & (mesh.low[near, 2] <= high[2])
        floors = near[walked]
        pieces, plane = _flat_pieces(mesh, floors, 0.5 * (low + high)[:2])
        window = shapely.box(*low[:2], *high[:2])
        pieces = shapely.intersection(pieces, window)
        roofs, walls = _in_the_way(mesh, near, pieces, plane, allowed)
        pieces = shapely.difference(shapely.difference(pieces, roofs), walls)
        parts, origin = shapely.get_parts(pieces, return_index=True)
        kept = shapely.area(parts) > 1e-9
        self.pieces, origin = parts[kept], origin[kept]
        self.plane, self._walls = plane[origin], walls[origin]
        self._tree = shapely.STRtree(self.pieces)
        self.contacts = self._contacts()
        self.label = self.joined(allowed.step)
        """(p,) int: pieces with the same number join, as far as heights go."""
        self._regions: dict[int, shapely.Geometry] = {}

    def height(self, piece: np.ndarray, points: np.ndarray) -> np.ndarray:
        """(k,) [m]: heights of ``piece`` (k,) at ``points`` (k, 2)."""
        return np.einsum("kc,kc->k", self.plane[piece], np.column_stack([points, np.ones(len(points))]))

    def pieces_at(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Which of ``points`` (k, 3) stand on which pieces: (index of point, piece)."""
        which, piece = self._tree.query(shapely.points(points[:, :2]), predicate="dwithin", distance=_NEAR)
        high = self.height(piece, points[which, :2])
        on = np.abs(high - points[which, 2]) <= self.allowed.step + _NEAR
        return which[on], piece[on]

    def nearest_piece(self, place: np.ndarray, height: float | None) -> int:
        """The piece nearest to ``place`` (2,) [m], of several the nearest to ``height`` [m]."""
        away = shapely.distance(self.pieces, shapely.points(place))
        close = np.flatnonzero(away <= away.min() + _TOUCH)
        if height is None:
            return int(close[0])
        off = np.abs(self.height(close, np.repeat(place[None], len(close), axis=0)) - height)
        return int(close[np.argmin(off)])

    def region(self, label: int) -> shapely.Geometry:
        """The floor of pieces that join, as one shape; cracks that a body does not notice are closed."""
        if label not in self._regions:
            whole = shapely.union_all([*self.pieces[self.label == label], *self._bridges(label)])
            self._regions[label] = shapely.difference(whole, self._ledges(label))
        return self._regions[label]

    def _bridges(self, label: int) -> np.ndarray:
        """What closes the cracks between pieces of one region that one walks between, where no wall stands in
        them."""
        pairs = self.contacts.pairs[self.contacts.least <= self.allowed.step + 1e-6]
        one, two = pairs[self.label[pairs[:, 0]] == label].T
        half = 0.5 * max(self.allowed.crack, _TOUCH) + 1e-4
        both = shapely.union(self.pieces[one], self.pieces[two])
        # what is narrower than both halves closes when it is grown and shrunk again; ends and corners stay
        closed = shapely.buffer(shapely.buffer(both, half, join_style="mitre"), -half, join_style="mitre")
        return shapely.difference(shapely.difference(closed, self._walls[one]), self._walls[two])

    def _ledges(self, label: int) -> shapely.Geometry:
        """Where floors of one region lie beside each other at heights more than a step apart."""
        contacts, step = self.contacts, self.allowed.step + 1e-6
        own = (self.label[contacts.pairs] == label).all(axis=1) & (np.abs(contacts.rises) > step).any(axis=1)
        ends, rises = contacts.ends[own], contacts.rises[own]
        slope = rises[:, 1] - rises[:, 0]
        lines = []
        for sign in (1.0, -1.0):
            # of the way from the first end to the second, the part where the rise is beyond the step
            beyond = sign * rises > step
            with np.errstate(divide="ignore", invalid="ignore"):
                at = (sign * step - rises[:, 0]) / slope
            begin, stop = np.where(beyond[:, 0], 0.0, at), np.where(beyond[:, 1], 1.0, at)
            part = np.stack([begin, stop], axis=1)[beyond.any(axis=1)]
            along = (ends[:, 1] - ends[:, 0])[beyond.any(axis=1)]
            lines.append(ends[beyond.any(axis=1), None, 0] + part[..., None] * along[:, None])
        return shapely.union_all(shapely.buffer(shapely.linestrings(np.concatenate(lines)), 2.0 * _TOUCH))

    def _contacts(self) -> "Contacts":
        crack = max(self.allowed.crack, _TOUCH)
        one, two = self._tree.query(self.pieces, predicate="dwithin", distance=crack)
        one, two = one[one < two], two[one < two]
        if not len(one):
            return Contacts(np.empty((0, 2), np.int64), np.empty((0, 2, 2)), np.empty((0, 2)))
        border = shapely.intersection(shapely.buffer(self.pieces[one], _TOUCH, quad_segs=1), self.pieces[two])
        apart = shapely.is_empty(border)
        border[apart] = shapely.shortest_line(self.pieces[one[apart]], self.pieces[two[apart]])
        # the border of two flat pieces is straight: it runs between the corners that are farthest apart
        points, pair = shapely.get_coordinates(border, return_index=True)
        first = points[np.searchsorted(pair, np.arange(len(one)))]
        begin = points[_last_of(pair, np.linalg.norm(points - first[pair], axis=1))]
        stop = points[_last_of(pair, np.linalg.norm(points - begin[pair], axis=1))]
        ends = np.stack([begin, stop], axis=1)
        rises = np.stack(
            [self.height(two, ends[:, k]) - self.height(one, ends[:, k]) for k in (0, 1)], axis=1
        )
        return Contacts(np.column_stack([one, two]), ends, rises)

    def joined(self, step: float, among: np.ndarray | None = None) -> np.ndarray:
        """(p,) int: pieces with the same number join by steps of at most ``step`` [m], over pieces ``among``
        (p,) bool, or over all."""
        pairs = self.contacts.pairs
        walks = self.contacts.least <= step + 1e-6
        walked = pairs[walks if among is None else walks & among[pairs].all(axis=1)]
        count = len(self.pieces)
        links = coo_array((np.ones(len(walked)), (walked[:, 0], walked[:, 1])), shape=(count, count))
        return connected_components(links, directed=False)[1]


class Contacts(NamedTuple):
    """Pairs of pieces that lie beside each other: ``pairs`` (k, 2) int, the ``ends`` (k, 2, 2) [m] of their
    border, and how far it rises from the first to the second at both, ``rises`` (k, 2) [m]; it changes evenly
    in between."""

    pairs: np.ndarray
    ends: np.ndarray
    rises: np.ndarray

    @property
    def least(self) -> np.ndarray:
        """(k,) [m]: the least height that there is between the two."""
        level = (self.rises.min(axis=1) <= 0.0) & (self.rises.max(axis=1) >= 0.0)
        return np.where(level, 0.0, np.abs(self.rises).min(axis=1))


def _last_of(group: np.ndarray, value: np.ndarray) -> np.ndarray:
    """Where in each ``group`` (n,) the greatest ``value`` (n,) is; groups rise from 0 and none is left
    out."""
    order = np.lexsort((value, group))
    return order[np.append(np.flatnonzero(np.diff(group[order])), len(order) - 1)]


def _on_risers(mesh: Mesh, faces: np.ndarray, flat: np.ndarray, step: float) -> np.ndarray:
    """(k,) bool: the steep ones of ``faces`` (k,) that hang together with steep ones no higher than a
    ``step``, all of them: risers, which are walked over."""
    found = np.zeros(len(faces), dtype=bool)
    steep = np.flatnonzero((mesh.up[faces] > 1e-3) & ~flat)
    if not len(steep):
        return found
    corners = mesh.corners[faces[steep]]
    place = np.unique(np.rint(corners.reshape(-1, 3) / _WELD), axis=0, return_inverse=True)[1].reshape(-1)
    count = len(steep) + int(place.max()) + 1
    face = np.repeat(np.arange(len(steep)), 3)
    links = coo_array((np.ones(len(face)), (face, len(steep) + place)), shape=(count, count))
    group = connected_components(links, directed=False)[1][: len(steep)]
    low, high = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(low, group, corners[..., 2].min(axis=1))
    np.maximum.at(high, group, corners[..., 2].max(axis=1))
    found[steep] = (high - low)[group] <= step + 1e-6
    return found


def _flat_pieces(mesh: Mesh, faces: np.ndarray, middle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """``faces`` (k,) that lie in one plane united: shapely (p,), and their planes (p, 3)."""
    plane = mesh.plane[faces]
    height = plane[:, :2] @ middle + plane[:, 2]
    key = np.rint(np.column_stack([plane[:, :2], height]) / _COPLANAR).astype(np.int64)
    _, first, group = np.unique(key, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(group.reshape(-1), kind="stable")
    starts = np.searchsorted(group.reshape(-1)[order], np.arange(len(first)))
    pieces = [shapely.union_all(each) for each in np.split(mesh.outlines[faces][order], starts[1:])]
    return np.array(pieces, dtype=object), plane[first]


def _in_the_way(
    mesh: Mesh, near: np.ndarray, pieces: np.ndarray, plane: np.ndarray, allowed: Allowance
) -> tuple[np.ndarray, np.ndarray]:
    """What of the faces ``near`` stands in a body's way over each of ``pieces`` (p,): shapely (p,) each, what
    hangs above it lower than the headroom, and what is higher than a step over it."""
    piece, other = shapely.STRtree(mesh.outlines[near]).query(pieces, predicate="intersects")
    other = near[other]
    x, y, z = np.moveaxis(mesh.corners[other], 2, 0)
    above = z - plane[piece, :1] * x - plane[piece, 1:2] * y - plane[piece, 2:]
    hangs = np.abs(mesh.up[other]) >= 1e-3
    top = allowed.headroom - 1e-6
    roofs = _united(mesh, piece[hangs], other[hangs], above[hangs], (_SAME, top), len(pieces))
    walls = _united(mesh, piece, other, above, (allowed.step + 1e-4, top), len(pieces))
    # no slivers of floor beside a roof that ends where the floor does
    roofs = shapely.buffer(roofs, _SLIVER, join_style="mitre")
    return roofs, shapely.buffer(walls, THIN, join_style="mitre")


def _united(
    mesh: Mesh, piece: np.ndarray, other: np.ndarray, above: np.ndarray, band: tuple[float, float], count: int
) -> np.ndarray:
    """(count,) shapely: the parts of faces ``other`` (k,) whose heights ``above`` a ``piece`` (k, 3) are
    within ``band``, united by piece."""
    low, high = band
    inside = (above.max(axis=1) > low) & (above.min(axis=1) < high)
    found = np.full(count, shapely.Polygon(), dtype=object)
    if not inside.any():
        return found
    shapes = parts_within(mesh, other[inside], above[inside], low, high)
    owner = piece[inside]
    order = np.argsort(owner, kind="stable")
    owners, first = np.unique(owner[order], return_index=True)
    for each, group in zip(owners.tolist(), np.split(shapes[order], first[1:]), strict=True):
        found[each] = united(group)
    return found
