"""Measuring at rims: for points along the mesh's own edges, what kind of obstacle is there and how big.

Heights, depths and widths come from the triangles (`navmesh.level.mesh_queries`), the free lengths before and
behind from the cells of the walkable surface. One pass of `measure` over all rims; each sample stands alone.
"""

import math
from typing import NamedTuple

import numpy as np

from navmesh.level.mesh_queries import crossed, lowest_above, surface_below
from navmesh.level.raster import FLOOR, KIND, PLANE, height_at
from navmesh.obstacles.free_length import SAME, free_length
from navmesh.obstacles.rules import ObstacleRules
from navmesh.rules import WalkRules
from navmesh.surface.floor_store import height_of
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["FOUND", "Limits", "measure"]

JUMP, VAULT, DROP, GAP = 1, 2, 3, 4
FOUND = (("jump", JUMP, 0), ("vault", VAULT, 0), ("drop", DROP, 1), ("gap", GAP, 2))
"""What `measure` finds: affordance, code, and slot of its answer."""
_NEAR = 0.03  # [m] beside an edge
_SCAN = 0.05  # [m] stride of a scan across an obstacle, refined by halving
_BEND = 0.02  # [m] a face that hangs from an edge may lean this little and still count as its foot


class Limits(NamedTuple):
    """`ObstacleRules` and `WalkRules` as plain numbers, with the walkable rises taken out."""

    jump_low: float
    jump_high: float
    vault_low: float
    vault_high: float
    vault_depth: float
    drop_low: float
    drop_high: float
    gap_low: float
    gap_high: float
    level: float
    run_up: float
    landing: float
    step: float
    headroom: float
    slope: float

    @classmethod
    def of(cls, obstacles: ObstacleRules, walking: WalkRules) -> "Limits":
        """The limits that the two sets of rules give together; free lengths are measured to 5 cm."""
        above = walking.max_step + 1e-3
        return cls(
            max(obstacles.jump_rise[0] - 1e-6, above),
            obstacles.jump_rise[1] + 1e-6,
            max(obstacles.vault_height[0] - 1e-6, above),
            obstacles.vault_height[1] + 1e-6,
            obstacles.vault_depth,
            max(obstacles.drop_height[0] - 1e-6, above),
            obstacles.drop_height[1] + 1e-6,
            obstacles.gap_width[0] - 1e-6,
            obstacles.gap_width[1] + 1e-6,
            obstacles.level,
            obstacles.run_up - SAME,
            obstacles.landing - SAME,
            walking.max_step,
            walking.headroom,
            math.tan(walking.max_slope),
        )


@kernel(error_model="numpy")
def _foot(grid, x, y, z, dx, dy, lowest):
    """The floor at the foot of an edge: (state, its height at the edge [m]).

    State 0: the surface goes on, there is no fall. 1: a floor. 2: nothing to stand on.
    """
    for j in range(4):
        off = (0.03, 0.1, 0.2, 0.3)[j]
        px = x + off * dx
        py = y + off * dy
        found, t = surface_below(grid, px, py, lowest, z + _BEND)
        if t < 0:
            continue
        if grid.triangles[t, KIND] == FLOOR:
            if found > z - SAME:
                return 0, 0.0
            return 1, height_at(grid.triangles, t, x, y)
        if grid.triangles[t, KIND] == PLANE and found > z - 1e-4:
            return 0, 0.0
    return 2, 0.0


@kernel(error_model="numpy")
def _air(grid, ax, ay, az, bx, by, bz, headroom):
    """Whether a body passes upright from a to b (heights of its feet) without touching the mesh."""
    for j in range(4):
        up = (0.08, 0.3 * headroom, 0.6 * headroom, 0.95 * headroom)[j]
        if crossed(grid, ax, ay, az + up, bx, by, bz + up):
            return False
    return True


@kernel(error_model="numpy")
def _behind(grid, x, y, z, dx, dy, floor, limits):
    """Scan across something thin: (its depth [m] or -1, height of the floor behind it [m])."""
    last = 0.0
    t = _SCAN
    while t <= limits.vault_depth + 0.3:
        found, which = surface_below(grid, x + t * dx, y + t * dy, -np.inf, z + limits.headroom)
        if which >= 0:
            if found > z + SAME:
                return -1.0, 0.0
            if found > z - 0.15:
                last = t
                if last > limits.vault_depth:
                    return -1.0, 0.0
            elif grid.triangles[which, KIND] == FLOOR and abs(found - floor) <= limits.level + 1e-6:
                low, high = last, last + _SCAN
                while high - low > 5e-4:
                    middle = 0.5 * (low + high)
                    there, _ = surface_below(grid, x + middle * dx, y + middle * dy, z - 0.15, z + SAME)
                    if there > -np.inf:
                        low = middle
                    else:
                        high = middle
                return 0.5 * (low + high), found
            elif grid.triangles[which, KIND] == FLOOR:
                return -1.0, 0.0
        t += _SCAN
    return -1.0, 0.0


@kernel(error_model="numpy")
def _floor_below(cells, x, y, z, dx, dy, limits, deepest):
    """Whether there are cells close by, at most ``deepest`` below z: a quick look before the triangles."""
    size = cells.size
    ny = cells.ny
    slack = SAME + 2.0 * size * limits.slope
    t = 0.02
    while t <= 1.6 * size:
        ix = math.floor((x + t * dx) / size)
        iy = math.floor((y + t * dy) / size)
        if 0 <= ix < cells.nx and 0 <= iy < ny:
            for k in range(cells.column_start[ix * ny + iy], cells.column_start[ix * ny + iy + 1]):
                if -deepest - slack <= height_of(cells, k) - z <= slack - limits.step:
                    return True
        t += 0.25 * size
    return False


@kernel(error_model="numpy")
def _floor_opposite(cells, x, y, z, dx, dy, limits):
    """Whether there are cells at about height z within the width of a gap: a quick look before a scan."""
    size = cells.size
    ny = cells.ny
    near = limits.level + size * limits.slope
    t = max(0.5 * size, limits.gap_low - size)
    while t <= limits.gap_high + size:
        ix = math.floor((x + t * dx) / size)
        iy = math.floor((y + t * dy) / size)
        if 0 <= ix < cells.nx and 0 <= iy < ny:
            for k in range(cells.column_start[ix * ny + iy], cells.column_start[ix * ny + iy + 1]):
                if abs(height_of(cells, k) - z) <= near:
                    return True
        t += 0.5 * size
    return False


@kernel(error_model="numpy")
def _across(grid, x, y, z, dx, dy, limits):
    """Scan across a gap: (its width [m] or -1, height of the floor on the other side [m])."""
    below = z - max(limits.step, limits.level)
    t = _SCAN
    while t <= limits.gap_high + _SCAN:
        found, which = surface_below(grid, x + t * dx, y + t * dy, below, z + limits.headroom)
        if which >= 0:
            if found > z + limits.level or grid.triangles[which, KIND] != FLOOR:
                return -1.0, 0.0
            low, high = t - _SCAN, t
            while high - low > 5e-4:
                middle = 0.5 * (low + high)
                there, _ = surface_below(grid, x + middle * dx, y + middle * dy, below, z + limits.level)
                if there > -np.inf:
                    high = middle
                else:
                    low = middle
            width = 0.5 * (low + high)
            if width < limits.gap_low or width > limits.gap_high:
                return -1.0, 0.0
            # floor that comes up gently to the other side is walked, not leapt
            before = max(low - _NEAR, 0.0)
            there, which = surface_below(grid, x + before * dx, y + before * dy, -np.inf, found)
            if which >= 0 and grid.triangles[which, KIND] == FLOOR and there > found - limits.step - SAME:
                return -1.0, 0.0
            return width, found
        t += _SCAN
    return -1.0, 0.0


@kernel(error_model="numpy")
def _free(grid, cells, x, y, z, dx, dy, limits, reach):
    slope, step, headroom = limits.slope, limits.step, limits.headroom
    return free_length(grid, cells, x, y, z, dx, dy, slope, step, headroom, reach)


@kernel(error_model="numpy", forceinline=True)
def _note(row, height, depth, run_up, landing, rise):
    row[0] = height
    row[1] = depth
    row[2] = run_up
    row[3] = landing
    row[4] = rise


@kernel(error_model="numpy")
def _measure_one(grid, cells, x, y, z, ox, oy, limits, reach, kind, size):
    """Measure at the edge point (x, y, z) with the fall towards (ox, oy); see `measure` for the slots."""
    deepest = max(limits.drop_high, limits.vault_high, limits.jump_high)
    reachable = _floor_below(cells, x, y, z, ox, oy, limits, deepest)
    leapable = _floor_opposite(cells, x, y, z, ox, oy, limits)
    if not reachable and not leapable:
        return
    state, floor = _foot(grid, x, y, z, ox, oy, z - deepest - 1.0)
    if state == 0:
        return
    height = z - floor if state == 1 else np.inf
    if height <= limits.step:
        return
    jumps = limits.jump_low <= height <= limits.jump_high
    vaults = limits.vault_low <= height <= limits.vault_high
    drops = limits.drop_low <= height <= limits.drop_high
    reachable = reachable and (jumps or vaults or drops)
    if not reachable and not leapable:
        return
    lean = SAME + _NEAR * limits.slope
    if lowest_above(grid, x + _NEAR * ox, y + _NEAR * oy, z + lean, z + limits.headroom) < np.inf:
        return
    if lowest_above(grid, x - _NEAR * ox, y - _NEAR * oy, z + lean, z + limits.headroom) < np.inf:
        return
    _, t = surface_below(grid, x - _NEAR * ox, y - _NEAR * oy, z - lean, z + lean)
    rim = t >= 0 and grid.triangles[t, KIND] == FLOOR
    # free lengths take most of the time: none is measured that decides nothing
    low, low_ahead, low_cell = 0.0, 0.0, -1
    if reachable:
        low, low_ahead, low_cell = _free(grid, cells, x, y, floor, ox, oy, limits, reach)
    width, other = -1.0, 0.0
    if leapable and rim:
        width, other = _across(grid, x, y, z, ox, oy, limits)
    on_top = low_cell >= 0 and ((jumps and low >= limits.run_up) or (drops and low >= limits.landing))
    top, top_ahead, top_cell = 0.0, 0.0, -1
    if rim and (on_top or width >= 0.0):
        top, top_ahead, top_cell = _free(grid, cells, x, y, z, -ox, -oy, limits, reach)
    lx, ly = x + low_ahead * ox, y + low_ahead * oy
    tx, ty = x - top_ahead * ox, y - top_ahead * oy
    top_z = max(z, height_of(cells, top_cell)) if top_cell >= 0 else z
    if low_cell >= 0 and low >= limits.run_up:
        if top >= limits.landing and jumps:
            if _air(grid, lx, ly, z, tx, ty, top_z, limits.headroom):
                kind[0] = JUMP
                _note(size[0], height, top, low, top, height)
        elif vaults:
            depth, behind = _behind(grid, x, y, z, -ox, -oy, floor, limits)
            if depth >= 0.0:
                bx, by = x - depth * ox, y - depth * oy
                free, ahead, cell = _free(grid, cells, bx, by, behind, -ox, -oy, limits, reach)
                if cell >= 0 and free >= limits.landing:
                    fx, fy = bx - ahead * ox, by - ahead * oy
                    if _air(grid, lx, ly, z, fx, fy, z, limits.headroom):
                        kind[0] = VAULT
                        _note(size[0], height, depth, low, free, behind - floor)
    if top_cell < 0 or top < limits.run_up:
        return
    if low_cell >= 0 and low >= limits.landing and drops:
        if _air(grid, tx, ty, top_z, lx, ly, z, limits.headroom):
            kind[1] = DROP
            _note(size[1], height, 0.0, top, low, -height)
    if width >= 0.0:
        bx, by = x + width * ox, y + width * oy
        free, ahead, cell = _free(grid, cells, bx, by, other, ox, oy, limits, reach)
        if cell >= 0 and free >= limits.landing:
            fx, fy = bx + ahead * ox, by + ahead * oy
            if _air(grid, tx, ty, top_z, fx, fy, max(other, height_of(cells, cell)), limits.headroom):
                kind[2] = GAP
                _note(size[2], other - z, width, top, free, other - z)


@allocating_kernel(error_model="numpy", nogil=True)
def measure(grid, cells, start, end, outward, first, limits, reach):
    """Measure every rim at evenly spread points: the middles of first[i + 1] - first[i] equal parts.

    ``start``, ``end`` (n, 3), ``outward`` (n, 2), ``first`` (n + 1,) int64; free lengths are measured up to
    ``reach`` [m]. Returns ``kind`` (s, 3) int8, 0 where there is nothing, and ``size`` (s, 3, 5) float64 [m]:
    height, depth, run-up, landing, rise from the floor before to the floor behind. Slots: 0 what one meets
    from below (jump or vault), 1 the drop, 2 the gap.
    """
    samples = first[-1]
    kind = np.zeros((samples, 3), np.int8)
    size = np.zeros((samples, 3, 5), np.float64)
    for i in range(len(start)):
        parts = first[i + 1] - first[i]
        for j in range(parts):
            s = (j + 0.5) / parts
            x = start[i, 0] + s * (end[i, 0] - start[i, 0])
            y = start[i, 1] + s * (end[i, 1] - start[i, 1])
            z = start[i, 2] + s * (end[i, 2] - start[i, 2])
            at = first[i] + j
            _measure_one(
                grid, cells, x, y, z, outward[i, 0], outward[i, 1], limits, reach, kind[at], size[at]
            )
    return kind, size
