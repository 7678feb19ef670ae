"""Check saved states of walkers."""

from __future__ import annotations

import math

import numpy as np

import navmesh
from locomotion.crowd import layout as at
from locomotion.crowd.walker import WalkerState
from locomotion.errors import LocomotionError
from locomotion.saved_arrays import FARTHEST, Slots, check_array, check_number

__all__ = ["check_walker"]

_COUNT = (0.0, FARTHEST)
_ROW = Slots(
    "the row of a walker",
    at.ROW,
    [
        (at.CELL, (-1.0, FARTHEST)),
        (slice(at.VX, at.VY + 1), (-100.0, 100.0)),
        (at.YAW, (-100.0, 100.0)),
        (at.RADIUS, (1e-3, 10.0)),
        (at.WISH, (1e-6, 100.0)),
        (at.ACCELERATION, (1e-6, 1e4)),
        (at.WEIGHT, (1e-6, FARTHEST)),
        (at.MODE, (at.STANDING, at.ROOTED)),
        (at.ROUTE_START, _COUNT),
        (at.ROUTE_COUNT, _COUNT),
        (at.NEXT, _COUNT),
        (at.NOTE, (at.QUIET, at.OFF_ROUTE)),
        (at.AGE, _COUNT),
        (slice(at.GO_X, at.GO_Y + 1), (-100.0, 100.0)),
        (at.GATE_START, _COUNT),
        (at.GATE_COUNT, _COUNT),
        (at.GATE_NEXT, _COUNT),
        (at.PASSAGE, (at.FAR, at.RETREATING)),
    ],
    whole=(
        at.CELL,
        at.MODE,
        at.ROUTE_START,
        at.ROUTE_COUNT,
        at.NEXT,
        at.NOTE,
        at.AGE,
        at.GATE_START,
        at.GATE_COUNT,
        at.GATE_NEXT,
        at.PASSAGE,
    ),
    open_ended=(at.FACING, at.BEST, at.RIGHT_UNTIL),
)
_LEAST_ROUTE = 2


def check_walker(state: WalkerState, graph: navmesh.NodeGraph) -> None:
    """Raise `LocomotionError` if no walker on ``graph`` can have this ``state``."""
    row, route, surface = state.row, state.route, graph.surface
    _ROW.check(row)
    check_array("the route of a walker", route, None, at.POINT)
    if math.isinf(row[at.FACING]) or math.isnan(row[at.BEST] + row[at.RIGHT_UNTIL]):
        raise LocomotionError(
            "the facing of a walker is infinite, or its least length left or right of way is not a number"
        )
    cell, walks = int(row[at.CELL]), row[at.MODE] == at.WALKING
    if cell >= len(surface) or (cell < 0) != (row[at.MODE] == at.LED):
        raise LocomotionError(f"a walker is in cell {cell} of {len(surface)}, in mode {row[at.MODE]:g}")
    if cell >= 0:
        h, ny = surface.resolution, surface.shape[1]
        column = int(surface.columns(np.array([cell]))[0])
        away = max(abs(row[at.X] - (column // ny + 0.5) * h), abs(row[at.Y] - (column % ny + 0.5) * h))
        check_number("the distance of a walker from its cell", away, 0.0, h)
    if row[at.ROUTE_COUNT] != len(route):
        raise LocomotionError(
            f"the route of a walker has {len(route)} corners; its row says {row[at.ROUTE_COUNT]:g}"
        )
    if walks and not (len(route) >= _LEAST_ROUTE and 1 <= row[at.NEXT] < len(route)):
        raise LocomotionError(f"a walker heads for corner {row[at.NEXT]:g} of {len(route)}")
    if walks and not ((route[:, at.VIA] == 0.0) | (route[:, at.VIA] == 1.0)).all():
        raise LocomotionError("the route of a walker has corners that are neither visited nor cut")
    if (walks or row[at.NOTE] != at.QUIET) and not state.goals:
        raise LocomotionError("a walker walks without a goal")
    check_number("the replans of a walker", state.replans, 0, FARTHEST)
    if state.goals and not np.isfinite(np.array(state.goals)).all():
        raise LocomotionError("a goal of a walker is not finite")
