# pyright: reportArgumentType=false, reportReturnType=false, reportIndexIssue=false, reportCallIssue=false
# pyright: reportAttributeAccessIssue=false, reportGeneralTypeIssues=false, reportOptionalSubscript=false
# shapely's types do not tell one shape from an array of them.
"""What keeps two places near each other apart, measured on the mesh: a passage too narrow or too low, a slope
too steep, a step, a gap, a wall.

One rule after the other is taken loosely until the places join, and then ever less loosely, until they just
do: what the rule was then is what the level has there.
"""

import math
from bisect import bisect_left
from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple

import numpy as np
import shapely

from navmesh.level.mesh_queries import MeshGrid, crossed
from runtime.playtest.floorplan import Allowance, FloorPlan
from runtime.playtest.mesh import Mesh

__all__ = ["Barrier", "Opening"]

_FINE = 0.002  # [m] to which a measure is narrowed down
_ANGLE = 0.001  # [rad] the same for slopes
_BACK = 0.004  # [m] or [rad] before the measure, where the places just do not join
_ASIDE = 0.12  # [m] that the graph's places may be off the room that they are in
_LEVEL = 0.3  # [m] floors on both sides of a gap differ in height by at most this
_FLAT = 0.5  # [m] floors on both sides of a wall differ by at most this
_TIGHT = 0.1  # [m] more on each side than the body needs, and a passage is not tight
_FARTHEST = 5.0  # [m] across
_OFF = 0.25  # [m] that heights beside a face may be off its own: so much a slope of 60° rises over a crack


class Barrier(NamedTuple):
    """What is in the way, by ``kind``, and its ``size``: "narrow", the width [m] of a passage; "passes", the
    same of one that the body just fits through (infinite: any); "low", the free height [m] of a passage;
    "steep", a slope [°]; "rise", a height [m], negative where it falls; "gap", its width [m]; "wall", its
    thickness [m].

    ``place`` (3,) [m], of a wall on this side of it; ``span`` (2, 3) [m]: the ends of what was measured.
    """

    kind: str
    size: float
    place: np.ndarray
    span: np.ndarray


class Opening:
    """A box of the level with places on both sides of what is in the way: ``here`` (k, 3) and ``there``
    (m, 3) [m], where there is room for the middle of a body of ``radius`` [m]."""

    def __init__(
        self,
        mesh: Mesh,
        box: np.ndarray,
        allowed: Allowance,
        radius: float,
        here: np.ndarray,
        there: np.ndarray,
    ) -> None:
        """``box`` (2, 3) [m]: its least and greatest corner."""
        self._mesh, self._allowed, self._radius = mesh, allowed, radius
        self.here, self.there = here, there
        self._low, self._high = box
        self._plans: dict[Allowance, FloorPlan] = {}

    def _plan(self, **loose: float) -> FloorPlan:
        allowed = self._allowed._replace(**loose)
        if allowed not in self._plans:
            self._plans[allowed] = FloorPlan(self._mesh, self._low, self._high, allowed)
        return self._plans[allowed]

    @cached_property
    def _strict(self) -> FloorPlan:
        return self._plan()

    @cached_property
    def passes(self) -> bool:
        """Whether the body gets across by the rules as they are."""
        return self.passes_with()

    def may_join(self, most: float) -> bool:
        """Whether there are floors at heights between those of its two sides, with no more than ``most`` [m]
        from one to the next. Where there are not, no rule is so loose that the sides join, nor are they at
        about the same height."""
        mesh = self._mesh
        faces = mesh.within(self._low, self._high)
        faces = faces[mesh.up[faces] > 0.0]
        order = np.argsort(mesh.low[faces, 2], kind="stable")
        low, high = mesh.low[faces[order], 2], np.maximum.accumulate(mesh.high[faces[order], 2])
        begin = np.append(-np.inf, low[1:][low[1:] > high[:-1] + most + 2.0 * _OFF])
        here, there = (np.searchsorted(begin, side[:, 2] + _OFF, "right") for side in (self.here, self.there))
        return bool(np.isin(here, there).any())

    def passes_with(self, **loose: float) -> bool:
        """Whether the body gets across where rules of the `Allowance` are as ``loose`` as this."""
        return self._joins(self._plan(**loose), self._radius)

    def narrow(self, least: float) -> Barrier | None:
        """The passage that is wide enough for everything but the body, at least ``least`` [m]."""
        return self._passage("narrow", self._radius, 0.5 * least)

    def tight(self) -> Barrier:
        """The passage that is only just wide enough for the body, where it ``passes``."""
        found = self._passage("passes", self._radius + _TIGHT, self._radius)
        middle = 0.5 * (self.here[0] + self.there[0])
        return found or Barrier("passes", math.inf, middle, np.array([middle, middle]))

    def _passage(self, kind: str, strict: float, loose: float) -> Barrier | None:
        """The widest passage, in halves of its width [m] less than ``strict`` and at least ``loose``."""
        plan = self._strict
        half = _least_loose(lambda half: self._joins(plan, half), strict, loose)
        if half is None:
            return None
        way = self._way(plan, half, plan, half + _BACK)
        if way is None:
            return None
        place, along = way
        span = _across(plan, place, along, 2.0 * half)
        floor = self._on_floor(plan, place)[0]
        return Barrier(kind, 2.0 * half, floor, np.column_stack([span, [floor[2], floor[2]]]))

    def low(self, least: float) -> Barrier | None:
        """The passage that is high enough for everything but the body, at least ``least`` [m]."""
        height = _least_loose(
            lambda headroom: self.passes_with(headroom=headroom), self._allowed.headroom, least
        )
        if height is None:
            return None
        plan = self._plan(headroom=height)
        way = self._way(plan, self._radius, self._plan(headroom=height + _BACK), self._radius)
        if way is None:
            return None
        place = self._on_floor(plan, way[0])[0]
        return Barrier("low", height, place, np.array([place, [*place[:2], place[2] + height]]))

    def steep(self, most: float) -> Barrier | None:
        """The slope that is too steep for the body, at most ``most`` [rad]."""
        slopes = np.arccos(self._mesh.up[self._mesh.within(self._low, self._high)])
        slopes = slopes[(slopes > self._allowed.slope) & (slopes <= most)]
        # only with another face can a way open
        tried = (np.unique(np.ceil(slopes / _ANGLE)) * _ANGLE).tolist()
        if not tried or self.passes or not self.passes_with(slope=tried[-1]):
            return None
        slope = tried[bisect_left(tried, True, key=lambda angle: self.passes_with(slope=angle))]
        plan, strict = self._plan(slope=slope), self._plan(slope=slope - _BACK)
        way = self._way(plan, self._radius, strict, self._radius)
        if way is None:
            return None
        # straight down from the middle of the way to the floor at its foot, and up to that at its head
        middle = shapely.points(way[0])
        ends = [
            shapely.get_coordinates(shapely.shortest_line(room, middle))[0]
            for room in self._rooms(strict, 0.0)
        ]
        span = np.vstack(
            [
                self._on_floor(strict, end, side)
                for end, side in zip(ends, (self.here, self.there), strict=True)
            ]
        )
        place = self._on_floor(plan, way[0])[0]
        return Barrier("steep", math.degrees(slope), place, span)

    def rise(self, most: float) -> Barrier | None:
        """The step up (negative: down) that is too high for the body, at most ``most`` [m]."""
        step = _least_loose(lambda height: self.passes_with(step=height), self._allowed.step, most)
        if step is None:
            return None
        plan = self._plan(step=step + _BACK)
        pairs, ends, rises = plan.contacts
        label = plan.joined(step - _BACK)
        here = np.isin(label, label[plan.pieces_at(self.here)[1]])
        # a flight of steps leads on: what joins the other side without coming back here
        beyond = plan.joined(step + _BACK, ~here)
        there = ~here & np.isin(beyond, beyond[plan.pieces_at(self.there)[1]])
        up, down = here[pairs[:, 0]] & there[pairs[:, 1]], here[pairs[:, 1]] & there[pairs[:, 0]]
        found = np.flatnonzero(up | down)
        if not len(found):
            return None
        best = found[np.argmin(plan.contacts.least[found])]
        least = np.abs(rises[best])
        even = abs(least[0] - least[1]) < 0.01
        place = ends[best].mean(axis=0) if even else ends[best][np.argmin(least)]
        heights = [float(plan.height(pairs[best, [side]], place[None])[0]) for side in (0, 1)]
        span = np.array([[*place, each] for each in (heights if up[best] else heights[::-1])])
        return Barrier("rise", span[1, 2] - span[0, 2], span[np.argmax(span[:, 2])], span)

    def gap(self, mesh_grid: MeshGrid, origin: np.ndarray) -> Barrier | None:
        """The gap between floors at about the same height with nothing in it but air."""
        ends = self._floors_apart
        if ends is None or abs(ends[1, 2] - ends[0, 2]) > _LEVEL or self._is_walled(ends, mesh_grid, origin):
            return None
        return Barrier("gap", float(np.linalg.norm((ends[1] - ends[0])[:2])), ends.mean(axis=0), ends)

    def wall(self, mesh_grid: MeshGrid, origin: np.ndarray) -> Barrier | None:
        """The wall between floors at about the same height."""
        ends = self._floors_apart
        if (
            ends is None
            or abs(ends[1, 2] - ends[0, 2]) > _FLAT
            or not self._is_walled(ends, mesh_grid, origin)
        ):
            return None
        return Barrier("wall", float(np.linalg.norm((ends[1] - ends[0])[:2])), ends[0], ends)

    @cached_property
    def _floors_apart(self) -> np.ndarray | None:
        """(2, 3): where the floors on both sides end, between the places of a body that are nearest to each
        other, in the middle of a long stretch of such places."""
        here, there = self._rooms(self._strict, self._radius)
        if shapely.is_empty(here) or shapely.is_empty(there):
            return None
        close = shapely.distance(here, there) + 0.005
        stretch = shapely.get_parts(shapely.intersection(there, shapely.buffer(here, close)))
        if not len(stretch):
            return None
        middle = shapely.centroid(stretch[np.argmax(shapely.length(stretch))])
        end = shapely.get_coordinates(shapely.shortest_line(there, middle))[0]
        line = shapely.shortest_line(here, shapely.points(end))
        air = shapely.difference(line, shapely.union_all(self._rooms(self._strict, 0.0)))
        parts = shapely.get_parts(air)
        parts = parts[shapely.length(parts) > self._allowed.crack]
        if not len(parts):  # a slit joins them that no body fits into
            return None
        ends = shapely.get_coordinates(parts)[[0, -1]]
        return np.vstack(
            [
                self._on_floor(self._strict, place, side)
                for place, side in zip(ends, (self.here, self.there), strict=True)
            ]
        )

    def _is_walled(self, ends: np.ndarray, mesh_grid: MeshGrid, origin: np.ndarray) -> bool:
        """Whether anything stands between two places, at the height of a body."""
        along = (ends[1] - ends[0]) / max(float(np.linalg.norm(ends[1] - ends[0])), 1e-9)
        (ax, ay, az), (bx, by, bz) = np.array([ends[0] - 0.05 * along, ends[1] + 0.05 * along]) - origin
        heights = np.linspace(self._allowed.step + 0.05, 0.95 * self._allowed.headroom, 4)
        return any(crossed(mesh_grid.arrays, ax, ay, az + up, bx, by, bz + up) for up in heights)

    def _rooms(self, plan: FloorPlan, radius: float) -> tuple[shapely.Geometry, shapely.Geometry]:
        """The room for the middle of a body of ``radius`` that the places on this and on that side are in."""
        here, there = (self._places_on(plan, side) for side in (self.here, self.there))
        sides = []
        for places in (here, there):
            rooms = [_room(plan, label, radius, points) for label, points in places.items()]
            sides.append(shapely.union_all([part for parts in rooms for part in parts]))
        return sides[0], sides[1]

    def _joins(self, plan: FloorPlan, radius: float) -> bool:
        """Whether a body of ``radius`` gets from the places on this side to those on that."""
        here, there = (self._places_on(plan, side) for side in (self.here, self.there))
        for label in here.keys() & there.keys():
            one = _room(plan, label, radius, here[label])
            if len(one) and shapely.dwithin(one, there[label], _ASIDE).any():
                return True
        return False

    def _places_on(self, plan: FloorPlan, side: np.ndarray) -> dict[int, shapely.Geometry]:
        """The places of a ``side`` by the label of the floor of ``plan`` that they are on."""
        which, piece = plan.pieces_at(side)
        label = plan.label[piece]
        return {
            each: shapely.multipoints(side[np.unique(which[label == each]), :2])
            for each in np.unique(label).tolist()
        }

    def _way(
        self, loose: FloorPlan, radius: float, strict: FloorPlan, strict_radius: float
    ) -> tuple[np.ndarray, np.ndarray] | None:
        """The middle (2,) [m] of the way that is there in ``loose`` and not in ``strict``, and the vector
        (2,) from its one end to the other."""
        here, there = self._rooms(strict, strict_radius)
        if shapely.is_empty(here) or shapely.is_empty(there):
            return None
        whole = self._rooms(loose, radius)[0]
        grown = shapely.buffer(shapely.union(here, there), 1.5 * (strict_radius - radius) + 0.001)
        ways = shapely.get_parts(shapely.difference(whole, grown))
        ways = ways[shapely.dwithin(ways, here, 0.02) & shapely.dwithin(ways, there, 0.02)]
        if not len(ways):
            along = shapely.get_coordinates(shapely.shortest_line(here, there))
            return along.mean(axis=0), along[1] - along[0]
        way = ways[np.argmax(shapely.area(ways))]
        middle = shapely.centroid(way)
        if not shapely.dwithin(way, middle, 0.02):
            middle = shapely.point_on_surface(way)
        ends = [
            shapely.get_coordinates(shapely.centroid(shapely.intersection(way, shapely.buffer(side, 0.02))))
            for side in (here, there)
        ]
        along = (ends[1] - ends[0])[0] if len(ends[0]) and len(ends[1]) else np.zeros(2)
        return shapely.get_coordinates(middle)[0], along

    def _on_floor(self, plan: FloorPlan, place: np.ndarray, side: np.ndarray | None = None) -> np.ndarray:
        """(1, 3): ``place`` (2,) at the height [m] of the floor of ``plan`` there; of several floors the one
        nearest to the height of the places of ``side``."""
        side = self.here if side is None else side
        expected = side[np.argmin(np.linalg.norm(side[:, :2] - place, axis=1)), 2]
        piece = plan.nearest_piece(place, float(expected))
        return np.column_stack([place[None], plan.height(np.array([piece]), place[None])])


def _room(plan: FloorPlan, label: int, radius: float, places: shapely.Geometry) -> np.ndarray:
    """(k,) shapely: the parts of the room for the middle of a body of ``radius`` that ``places`` are in."""
    room = plan.region(label)
    if radius > 0.0:
        room = shapely.buffer(room, -radius, quad_segs=8)
    parts = shapely.get_parts(room)
    return parts[shapely.dwithin(parts, places, _ASIDE)]


def _least_loose(joins: Callable[[float], bool], strict: float, loose: float) -> float | None:
    """The value nearest to ``strict`` at which it ``joins``; None where it does at ``strict``, and where it
    does not at ``loose`` either."""
    if joins(strict) or not joins(loose):
        return None
    while abs(strict - loose) > _FINE:
        middle = 0.5 * (strict + loose)
        if joins(middle):
            loose = middle
        else:
            strict = middle
    return loose


def _across(plan: FloorPlan, place: np.ndarray, along: np.ndarray, width: float) -> np.ndarray:
    """(2, 2) [m]: the ends of a passage at ``place`` (2,) across the way ``along`` it."""
    length = float(np.linalg.norm(along))
    aside = np.array([-along[1], along[0]]) / length if length > 1e-6 else np.array([0.0, 1.0])
    label = int(plan.label[plan.nearest_piece(place, None)])
    cut = shapely.linestrings([place - _FARTHEST * aside, place + _FARTHEST * aside])
    parts = shapely.get_parts(shapely.intersection(plan.region(label), cut))
    parts = parts[shapely.dwithin(parts, shapely.points(place), 0.01)]
    if len(parts) and abs(shapely.length(parts[0]) - width) < 0.5 * width:
        return shapely.get_coordinates(parts[0])[[0, -1]]
    return np.array([place - 0.5 * width * aside, place + 0.5 * width * aside])
