"""The arrays that searches with area costs read, bundled as those of `navmesh.graph.kernel_arrays`."""

from typing import Any

import numpy as np
from numba import float64, int16, int32, int64

from surefoot.kernels.bundles import Bundle, BundleType, aligned, rows

__all__ = ["BENT", "LANDMARKS", "PRICED", "STRAIGHT", "TRIP", "make_priced", "make_trip"]

LANDMARKS = 8
"""Places from and to which the cost of all others is known."""
STRAIGHT, BENT = -1, -2
"""Kinds of roads: a body fits on the straight line; it is led off the line
(`navmesh.routes.string_pulling.mend`). Of the roads that are leaps the kind is the leap's number in
`DOORS`."""

_STOP = np.dtype([("x", "f8"), ("y", "f8"), ("z", "f8"), ("stop_cell", "i4"), ("", "i4")])
_ROAD = np.dtype([("toll", "f8"), ("to", "i4"), ("kind", "i4")])
_SEEN = np.dtype(
    [("stamp", "i8"), ("spent", "f8"), ("total", "f8"), ("rest", "f8"),
     ("parent", "i4"), ("road", "i4"), ("done", "i8"), ("", "f8", 2)]
)  # fmt: skip

PRICED = BundleType(
    area=int16[::1],
    row=int32[::1],
    part=int16[:, ::1],
    dear=int16[:, ::1],
    factor=float64[::1],
    least=float64,
    forbids=int64,
    stops=rows(_STOP),
    group_start=int32[::1],
    group=int32[::1],
    road_start=int32[::1],
    roads=rows(_ROAD),
    road_node=int32[::1],
    landmark=float64[:, ::1],
)
"""A roadmap (`navmesh.areas.roadmap`) with the prices that one set of costs gives it.

area, row, part: `navmesh.areas.areas.Areas`; dear: what `navmesh.areas.areas.dearest` makes of the parts.
factor: cost of each area; least: the least of them, at most 1 where there are leaps; forbids: whether one is
infinite. For each of the s stops: x, y, z [m], stop_cell. The stops in node i are
group[group_start[i]:group_start[i + 1]]. The roads that leave stop i are road_start[i]:road_start[i + 1]; for
each: toll, what it costs [m]; to, the stop that it leads to; kind; road_node, the node that it runs through.
landmark (s, 2 * LANDMARKS): cost from each landmark to the stop, then from the stop to each; nan where there
is no way.
"""

TRIP = BundleType(
    numbers=int64[::1],
    ends=float64[::1],
    seen=rows(_SEEN),
    heap_key=float64[::1],
    heap_item=int32[::1],
    goal_stamp=int64[::1],
    goal_toll=float64[::1],
    bound=float64[::1],
    near=int32[::1],
    far=float64[::1],
    point=float64[:, ::1],
    point_cell=int32[::1],
    point_node=int32[::1],
    point_kind=int32[::1],
    point_cost=float64[::1],
)
"""Memory for one search over a roadmap.

numbers, ends: see `navmesh.areas.roadmap_search`. For each stop, then for the start and the goal: stamp, the
last search that saw it; spent, total, rest, parent, and the road that leads to it; done, the last search that
went on from it. goal_stamp, goal_toll: the stops of the goal's node and what is left from them. bound (2 *
LANDMARKS,): at most what it costs from each landmark to the goal, and at least what it costs from there to
each. near, far: stops near an end, and how far. point, point_cell: the line; point_node, point_kind,
point_cost: node, kind and cost of the leg that leads to each.
"""


def make_priced(**values: Any) -> Bundle:
    """`PRICED`; ``x``, ``y``, ``z``, ``stop_cell`` and ``toll``, ``to``, ``kind`` are given as columns."""
    stops = aligned(len(values["x"]), _STOP)
    for name in ("x", "y", "z", "stop_cell"):
        stops[name] = values.pop(name)
    roads = aligned(len(values["to"]), _ROAD)
    for name in ("toll", "to", "kind"):
        roads[name] = values.pop(name)
    return Bundle(PRICED, stops=stops, roads=roads, **values)


def make_trip(stops: int, roads: int) -> Bundle:
    """`TRIP` for a roadmap of so many stops and roads."""
    most = 4 * stops + 64
    return Bundle(
        TRIP,
        numbers=np.zeros(12, np.int64),
        ends=np.zeros(8),
        seen=aligned(stops + 2, _SEEN),
        heap_key=np.empty(roads + 2 * stops + 4),
        heap_item=np.empty(roads + 2 * stops + 4, np.int32),
        goal_stamp=np.zeros(stops + 2, np.int64),
        goal_toll=np.empty(stops + 2),
        bound=np.empty(2 * LANDMARKS),
        near=np.empty(128, np.int32),
        far=np.empty(128),
        point=np.empty((most, 2)),
        point_cell=np.empty(most, np.int32),
        point_node=np.empty(most, np.int32),
        point_kind=np.empty(most, np.int32),
        point_cost=np.empty(most),
    )
