"""Typed links: the ways over obstacles that a route can take, as edges of the graph.

A link is straight: from the run-up point, at right angles over the edge, to the landing point. An obstacle
has several side by side, spread over its usable width, so that a route need not detour to its middle.
"""

import math
from dataclasses import dataclass, fields

import numpy as np

from navmesh.obstacles.free_length import cells_of, room
from navmesh.obstacles.kinds import CROSSINGS, kind_of
from navmesh.obstacles.obstacles import Obstacles
from navmesh.rules import WalkRules
from navmesh.surface.columns import column_of
from navmesh.surface.floor_store import gradient_of, height_of
from navmesh.surface.surface import Surface
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["LONGEST_RUN_UP", "Links", "make_links"]

LONGEST_RUN_UP = 3.0
"""[m] from the run-up point to the edge, where there is room; at least `_SHORTEST` otherwise."""
_LONGEST_LANDING = 1.5  # [m] from the (far) edge to the landing point
_SHORTEST = 0.5  # [m] both, at least
_WIDE = 0.6  # [m] clearance that is enough at an end: a wider place is not worth a shorter run-up
_STRIDE = 0.125  # [m] between the points that are tried
_ABREAST = 1.0  # [m] between links side by side
_ONTO, _OVER, _OFF, _ACROSS, _UNDER = range(len(CROSSINGS))


@dataclass(frozen=True, slots=True, eq=False)
class Links:
    """l typed links in world coordinates, those of one obstacle together, left to right."""

    start: np.ndarray
    """(l, 3) float64 [m]: run-up point on the surface, straight before the edge."""
    edge: np.ndarray
    """(l, 3) float64 [m]: where it crosses the rim."""
    end: np.ndarray
    """(l, 3) float64 [m]: landing point on the surface: on top, behind or below."""
    start_cell: np.ndarray
    """(l,) int32: the surface's cell that `start` is in."""
    end_cell: np.ndarray
    """(l,) int32: the surface's cell that `end` is in."""
    obstacle: np.ndarray
    """(l,) int32: index into the obstacles."""
    affordance: np.ndarray
    """(l,) str, of the obstacle."""
    height: np.ndarray
    """(l,) float64 [m], what a skill's range is compared with: the obstacle's height at this link; for a gap,
    its width. To 0.1 mm, so that a platform of 0.3 m is not a hair above or below it."""
    run_up: np.ndarray
    """(l,) float64 [m], horizontal distance from `start` to `edge`, 0.5 to 3."""
    radius: np.ndarray
    """(l,) float64 [m], of the widest body that passes: room to both ends of the rim and clearance at both
    ends of the link."""
    cost: np.ndarray
    """(l,) float64 [m]: its length and, on top, what the effort is worth in metres walked
    (`ObstacleKind.effort`): 1 + 2·height for a jump, 3 for a vault, 2 + height for a drop, 1 + width for a
    gap."""

    def __len__(self) -> int:
        return len(self.cost)

    @classmethod
    def empty(cls) -> "Links":
        """No links."""
        return make_links_from(np.zeros((0, _COLUMNS)), Obstacles.empty())

    def arrays(self) -> dict[str, np.ndarray]:
        """The arrays by name, for an archive; ``Links(**arrays)`` makes them links again."""
        return {field.name: getattr(self, field.name) for field in fields(self)}


# Columns of the kernel's table: points [m]; cells; index of the obstacle; height or width [m]; [m]; [m]; [m]
_START, _EDGE, _END = slice(0, 3), slice(3, 6), slice(6, 9)
_START_CELL, _END_CELL, _OWNER, _MEASURED, _RUN_UP, _RADIUS, _COST = range(9, 16)
_COLUMNS = 16


def make_links(obstacles: Obstacles, surface: Surface, walking: WalkRules, body_radius: float = 0.3) -> Links:
    """The links over ``obstacles`` on ``surface`` (built under ``walking``).

    The outermost links of an obstacle keep ``body_radius`` [m] from the ends of its rim. Where there is no
    cell of the surface to start from or to land on there is no link.
    """
    if not len(obstacles):
        return Links.empty()
    rim = obstacles.rim - surface.origin
    kinds = [kind_of(name) for name in obstacles.affordance.tolist()]
    table = _trace_links(
        cells_of(surface),
        surface.clearance,
        np.array([CROSSINGS.index(kind.crossing) for kind in kinds], np.int64),
        np.array([kind.effort for kind in kinds], np.float64),
        np.stack((rim[:, 0], obstacles.position - surface.origin, rim[:, 1]), axis=1),
        np.column_stack((obstacles.rim_height[:, 0], obstacles.height, obstacles.rim_height[:, 1])),
        -obstacles.normal[:, :2],
        np.column_stack((obstacles.depth, obstacles.rise, obstacles.width)),
        math.tan(walking.max_slope),
        body_radius,
    )
    for point in (_START, _EDGE, _END):
        table[:, point] += surface.origin
    return make_links_from(table, obstacles)


def make_links_from(table: np.ndarray, obstacles: Obstacles) -> Links:
    """Links from the rows of the kernel's ``table`` (l, 16), in world coordinates."""
    owner = table[:, _OWNER].astype(np.int32)
    return Links(
        start=table[:, _START].copy(),
        edge=table[:, _EDGE].copy(),
        end=table[:, _END].copy(),
        start_cell=table[:, _START_CELL].astype(np.int32),
        end_cell=table[:, _END_CELL].astype(np.int32),
        obstacle=owner,
        affordance=obstacles.affordance[owner],
        height=table[:, _MEASURED].round(4),
        run_up=table[:, _RUN_UP].copy(),
        radius=table[:, _RADIUS].copy(),
        cost=table[:, _COST].copy(),
    )


@kernel
def _place(cells, clearance, x, y, z, dx, dy, slope, longest, lateral, point):
    """Choose the point straight ahead of an edge point, at most ``longest`` away: the farthest with enough
    clearance, or else the one with most. Writes it to ``point`` (3,).

    Returns (distance or -1, cell, clearance), all distances in metres.
    """
    size = cells.size
    free, _, cell, _ = room(cells, x, y, z, dx, dy, slope, longest)
    if cell < 0 or free < _SHORTEST:
        return -1.0, -1, 0.0
    enough = min(lateral, _WIDE)
    best, best_cell, best_gap = -1.0, -1, -1.0
    away = free
    while away >= _SHORTEST - 1e-9:
        _, _, first, k = room(cells, x, y, z, dx, dy, slope, away)
        if first >= 0:
            column = column_of(cells, k)
            ix = column // cells.ny
            ux = x + away * dx - (ix + 0.5) * size
            uy = y + away * dy - (column - ix * cells.ny + 0.5) * size
            inside = abs(ux) <= 0.5 * size + 1e-9 and abs(uy) <= 0.5 * size + 1e-9
            gap = clearance[k] - math.sqrt(ux * ux + uy * uy)
            if inside and gap > best_gap + 1e-9:
                best, best_cell, best_gap = away, k, gap
                point[0] = x + away * dx
                point[1] = y + away * dy
                slope_x, slope_y = gradient_of(cells, k)
                point[2] = height_of(cells, k) + slope_x * ux + slope_y * uy
                if gap >= enough:
                    break
        away -= _STRIDE
    return best, best_cell, max(best_gap, 0.0)


@allocating_kernel
def _trace_links(cells, clearance, crossing, efforts, rim, height, heading, size, slope, body_radius):
    """Rows of links, see `_COLUMNS`. ``rim`` (k, 3, 3): left, middle, right; ``height`` (k, 3) at these;
    ``heading`` (k, 2) of the run; ``size`` (k, 3): depth, rise, width; ``crossing`` (k,) indexes
    CROSSINGS; ``efforts`` (k, 2): of the kind."""
    total = 0
    for i in range(len(crossing)):
        total += 2 * int(0.5 * size[i, 2] / _ABREAST) + 1
    table = np.zeros((total, _COLUMNS), np.float64)
    count = 0
    for i in range(len(crossing)):
        width = size[i, 2]
        dx, dy = heading[i, 0], heading[i, 1]
        margin = min(0.5 * width, body_radius + 0.05)
        steps = int((0.5 * width - margin) / _ABREAST)
        for j in range(-steps, steps + 1):
            offset = j * _ABREAST  # [m] right of the middle
            share = min(abs(offset) / (0.5 * width), 1.0)
            side = 2 if j > 0 else 0
            row = table[count]
            edge = row[_EDGE]
            for axis in range(3):
                edge[axis] = (1.0 - share) * rim[i, 1, axis] + share * rim[i, side, axis]
            tall = (1.0 - share) * height[i, 1] + share * height[i, side]
            x, y, z = edge
            lateral = 0.5 * width - abs(offset)
            before = z
            behind = z
            depth = 0.0
            if crossing[i] == _ONTO:
                before = z - tall
            elif crossing[i] == _OVER:
                before = z - tall
                behind = before + size[i, 1]
                depth = size[i, 0]
            elif crossing[i] == _OFF:
                behind = z - tall
            elif crossing[i] == _UNDER:
                behind = z + size[i, 1]
                depth = size[i, 0]
            else:
                behind = z + tall
                depth = size[i, 0]
            measured = depth if crossing[i] == _ACROSS else tall
            effort = efforts[i, 0] + efforts[i, 1] * measured
            away, start, gap = _place(
                cells, clearance, x, y, before, -dx, -dy, slope, LONGEST_RUN_UP, lateral, row[_START]
            )
            if start < 0:
                continue
            fx, fy = x + depth * dx, y + depth * dy
            reach = _LONGEST_LANDING
            onward, end, gap_there = _place(
                cells, clearance, fx, fy, behind, dx, dy, slope, reach, lateral, row[_END]
            )
            if end < 0:
                continue
            row[_START_CELL] = start
            row[_END_CELL] = end
            row[_OWNER] = i
            row[_MEASURED] = measured
            row[_RUN_UP] = away
            row[_RADIUS] = min(lateral, gap, gap_there)
            row[_COST] = away + depth + onward + effort
            count += 1
    return table[:count]
