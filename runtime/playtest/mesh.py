# pyright: reportArgumentType=false, reportReturnType=false, reportIndexIssue=false, reportCallIssue=false
# pyright: reportAttributeAccessIssue=false, reportGeneralTypeIssues=false, reportOptionalSubscript=false
# shapely's types do not tell one shape from an array of them.
"""A level's triangles seen from above, as shapes that can be cut and joined."""

from functools import cached_property

import numpy as np
import shapely

__all__ = ["THIN", "Mesh", "parts_within", "standing", "united"]

THIN = 0.001
"""[m] to every side that a wall without thickness counts."""
_SNAP = 1e-4  # [m] lines nearer to each other than this are one,
_TURN = 1e-5  # [rad] and turned against each other by no more


class Mesh:
    """A level's triangles with what is asked of them again and again. ``corners`` (t, 3, 3) [m]."""

    def __init__(self, corners: np.ndarray) -> None:
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        size = np.linalg.norm(normal, axis=1)
        whole = size > 1e-12
        self.corners = corners[whole]
        self.up = normal[whole, 2] / size[whole]
        """(t,): z of the unit normals."""
        normal = normal[whole]
        steep = np.abs(self.up) < 1e-6
        slope = -normal[:, :2] / np.where(steep, 1.0, normal[:, 2])[:, None]
        offset = self.corners[:, 0, 2] - np.einsum("tc,tc->t", slope, self.corners[:, 0, :2])
        self.plane = np.column_stack([slope, offset])
        """(t, 3): height = plane · (x, y, 1); of no use where a face is upright."""
        self.low, self.high = self.corners.min(axis=1), self.corners.max(axis=1)

    @cached_property
    def outlines(self) -> np.ndarray:
        """(t,) shapely: the triangles seen from above: polygons, and lines where they are upright."""
        return _outlines(self.corners[..., :2])

    @cached_property
    def upward(self) -> tuple[np.ndarray, shapely.STRtree]:
        """The faces that face up (k,) int, however steep, and a tree of their outlines."""
        faces = np.flatnonzero(self.up > 1e-3)
        return faces, shapely.STRtree(self.outlines[faces])

    def within(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """(k,) int: the triangles whose box meets the box from ``low`` to ``high`` (3,) [m]."""
        near = np.sort(self._boxes.query(shapely.box(*low[:2], *high[:2])))
        return near[((self.high[near] >= low) & (self.low[near] <= high)).all(axis=1)]

    @cached_property
    def _boxes(self) -> shapely.STRtree:
        """Of the triangles' boxes, seen from above."""
        return shapely.STRtree(shapely.box(*self.low[:, :2].T, *self.high[:, :2].T))


def _outlines(points: np.ndarray) -> np.ndarray:
    """(k,) shapely: the hulls of ``points`` (k, n, 2): polygons or lines."""
    count, size = points.shape[:2]
    if size == 3:
        hulls = shapely.polygons(points)
    else:
        owner = np.repeat(np.arange(count), size)
        hulls = shapely.convex_hull(shapely.multipoints(points.reshape(-1, 2), indices=owner))
    # an upright face is a line, and a sliver only by its rounding errors
    one = _farthest(points, points[:, 0])
    two = _farthest(points, one)
    thin = shapely.area(hulls) <= 1e-7 * np.linalg.norm(two - one, axis=1)
    hulls[thin] = shapely.linestrings(np.stack([one, two], axis=1)[thin])
    return hulls


def standing(mesh: Mesh, low: np.ndarray, high: np.ndarray, bottom: float, top: float) -> shapely.Geometry:
    """What of the mesh is between two heights [m], seen from above, near the box from ``low`` to ``high``
    (2,)."""
    near = mesh.within(np.append(low, bottom), np.append(high, top))
    parts = parts_within(mesh, near, mesh.corners[near, :, 2], bottom, top)
    return shapely.buffer(united(parts), THIN, join_style="mitre")


def parts_within(mesh: Mesh, faces: np.ndarray, above: np.ndarray, low: float, high: float) -> np.ndarray:
    """(k,) shapely: the parts of ``faces`` (k,), seen from above, whose heights ``above`` (k, 3) something
    are within ``low`` and ``high``."""
    parts = mesh.outlines[faces]
    cut = (above.min(axis=1) < low) | (above.max(axis=1) > high)
    parts[cut] = _outlines(_clipped(mesh.corners[faces[cut], :, :2], above[cut], low, high))
    return parts


def united(shapes: np.ndarray) -> shapely.Geometry:
    """The union of ``shapes`` (k,), polygons and lines of two ends."""
    is_line = shapely.get_dimensions(shapes) == 1
    lines = shapely.linestrings(_bundled(shapely.get_coordinates(shapes[is_line]).reshape(-1, 2, 2)))
    return shapely.union_all([*shapes[~is_line], *lines])


def _bundled(ends: np.ndarray) -> np.ndarray:
    """(m, 2, 2): the lines ``ends`` (k, 2, 2), those on one straight line that meet in one piece.

    A wall of small triangles is many short lines, side by side but for rounding errors; shapely takes a long
    time to find out that they are one.
    """
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    ends = ends[length > 0.0][np.argsort(-length[length > 0.0], kind="stable")]
    if not len(ends):
        return ends
    x, y = (ends[:, 1] - ends[:, 0]).T
    angle = np.arctan2(y, x) % np.pi
    way = np.column_stack([np.cos(angle), np.sin(angle)])
    middle = ends.mean(axis=(0, 1))
    x, y = (ends[:, 0] - middle).T
    aside = way[:, 0] * y - way[:, 1] * x
    key = np.rint(np.column_stack([angle / _TURN, aside / _SNAP]))
    _, first, group = np.unique(key, axis=0, return_index=True, return_inverse=True)
    group = group.reshape(-1)
    carrier = way[first]  # of the longest of each group
    foot = middle + aside[first, None] * np.column_stack([-carrier[:, 1], carrier[:, 0]])
    along = np.einsum("kec,kc->ke", ends - foot[group, None], carrier[group])
    apart = 4.0 * np.abs(along).max() + 1.0  # so far from each other groups are laid on one line
    low, high = along.min(axis=1) + apart * group, along.max(axis=1) + apart * group
    order = np.argsort(low, kind="stable")
    low, high, group = low[order], np.maximum.accumulate(high[order]), group[order]
    begin = np.flatnonzero(np.append(True, low[1:] > high[:-1] + _SNAP))
    stop = np.append(begin[1:], len(low)) - 1
    group = group[begin]
    reach = np.column_stack([low[begin], high[stop]]) - apart * group[:, None]
    return foot[group, None] + reach[..., None] * carrier[group, None]


def _farthest(points: np.ndarray, of: np.ndarray) -> np.ndarray:
    """(k, 2): of ``points`` (k, n, 2) the ones farthest from ``of`` (k, 2)."""
    away = np.linalg.norm(points - of[:, None], axis=2)
    return points[np.arange(len(points)), away.argmax(axis=1)]


def _clipped(corners: np.ndarray, above: np.ndarray, low: float, high: float) -> np.ndarray:
    """(k, 9, 2): points whose hull is the part of each triangle ``corners`` (k, 3, 2) where ``above`` (k, 3),
    linear in between, is within [low, high]; points repeat where there are fewer."""
    points = [np.where(((above >= low) & (above <= high))[..., None], corners, np.nan)]
    after, rises = np.roll(corners, -1, axis=1), np.roll(above, -1, axis=1) - above
    for level in (low, high):
        with np.errstate(divide="ignore", invalid="ignore"):
            part = (level - above) / rises
            points.append(
                np.where(
                    ((part >= 0) & (part <= 1))[..., None],
                    corners + part[..., None] * (after - corners),
                    np.nan,
                )
            )
    every = np.concatenate(points, axis=1)
    valid = ~np.isnan(every[..., 0])
    first = every[np.arange(len(every)), valid.argmax(axis=1)]
    return np.where(valid[..., None], every, first[:, None])
