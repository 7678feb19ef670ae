"""Free lengths: how far one can go straight on from an edge before walking ends.

The walkable surface's cells say where walking ends to within a square; the triangles there say it to within
a few centimetres.
"""

import math
from typing import NamedTuple

import numpy as np

from navmesh.level.mesh_queries import crossed, lowest_above, surface_below
from navmesh.level.raster import FLOOR, KIND
from navmesh.surface.columns import column_of
from navmesh.surface.floor_store import gradient_of, height_of
from navmesh.surface.storeys import linked
from navmesh.surface.surface import Surface
from surefoot.kernels import kernel

__all__ = ["REACH", "SAME", "CellArrays", "cells_of", "free_length", "march", "room", "seek"]

REACH = 50.0
"""[m] free lengths are measured up to this."""
SAME = 0.05
"""[m] surfaces this close in height go on into each other."""

_STRIDE = 0.05  # [m] between the points at which the end of a free length is looked for


class CellArrays(NamedTuple):
    """A `Surface` as kernels take it; what it says of its fields holds for those of the same name."""

    column_start: np.ndarray
    milestone: np.ndarray
    floor_shift: np.ndarray
    """(blocks,) int32, and the arrays of `navmesh.surface.floor_store.FloorStore`: see `height_of`."""
    floor_height: np.ndarray
    floor_slope: np.ndarray
    slopes: np.ndarray
    storey: np.ndarray
    size: float
    """[m], side of a cell."""
    nx: int
    ny: int


def cells_of(surface: Surface) -> CellArrays:
    """What the kernels take as ``cells``."""
    floor = surface.floor
    return CellArrays(
        surface.column_start, surface.milestone, floor.shift(surface.column_start), floor.height,
        floor.slope, floor.slopes, surface.storey, surface.resolution, *surface.shape,
    )  # fmt: skip


@kernel(error_model="numpy")
def seek(cells, x, y, z, dx, dy, slope, nearest, farthest):
    """The first cell from (x, y, z) in direction (dx, dy): a floor near height z whose centre is ahead.

    Returns (distance [m], cell), cell -1 when there is none from ``nearest`` to ``farthest``.
    """
    size = cells.size
    ny = cells.ny
    stride = 0.25 * size
    ahead = nearest
    while ahead <= farthest:
        px = x + ahead * dx
        py = y + ahead * dy
        ix = math.floor(px / size)
        iy = math.floor(py / size)
        if 0 <= ix < cells.nx and 0 <= iy < ny:
            ux = (ix + 0.5) * size - x
            uy = (iy + 0.5) * size - y
            if ux * dx + uy * dy > 1e-6:
                column = ix * ny + iy
                best = -1
                least = SAME + ahead * slope
                for k in range(cells.column_start[column], cells.column_start[column + 1]):
                    slope_x, slope_y = gradient_of(cells, k)
                    there = height_of(cells, k) + slope_x * (px - x - ux) + slope_y * (py - y - uy)
                    if abs(there - z) < least:
                        least = abs(there - z)
                        best = k
                if best >= 0:
                    return ahead, best
        ahead += stride
    return 0.0, -1


@kernel(error_model="numpy")
def march(cells, cell, x, y, dx, dy, limit):
    """Free length [m] from (x, y) in ``cell`` straight in direction (dx, dy), at most ``limit``.

    Returns (length, cell where it ends).
    """
    size = cells.size
    column = column_of(cells, cell)
    ix = column // cells.ny
    iy = column - ix * cells.ny
    way_x = 1 if dx > 0.0 else -1
    way_y = 1 if dy > 0.0 else -1
    next_x = ((ix + (dx > 0.0)) * size - x) / dx if abs(dx) > 1e-12 else np.inf
    next_y = ((iy + (dy > 0.0)) * size - y) / dy if abs(dy) > 1e-12 else np.inf
    step_x = size / abs(dx) if abs(dx) > 1e-12 else np.inf
    step_y = size / abs(dy) if abs(dy) > 1e-12 else np.inf
    while True:
        if next_x < next_y:
            gone = next_x
            direction = 0 if way_x > 0 else 2
            next_x += step_x
        else:
            gone = next_y
            direction = 1 if way_y > 0 else 3
            next_y += step_y
        if gone >= limit:
            return limit, cell
        following = linked(cells, cell, direction)
        if following < 0:
            return gone, cell
        cell = following


@kernel(error_model="numpy")
def room(cells, x, y, z, dx, dy, slope, limit):
    """Free length from an edge point (x, y, z) on, in direction (dx, dy), at most ``limit``.

    The square at the edge may have its centre inside what the edge belongs to, and one beside the line behind
    a slanting wall: where the line ends at once, it is tried again from the next square.
    Returns (length [m], distance to the first cell [m], first cell or -1, last cell).
    """
    farthest = 1.6 * cells.size
    best, at, first, last = 0.0, 0.0, -1, -1
    nearest = 0.02
    while nearest <= farthest:
        ahead, cell = seek(cells, x, y, z, dx, dy, slope, nearest, farthest)
        if cell < 0:
            break
        length, end = march(cells, cell, x + ahead * dx, y + ahead * dy, dx, dy, limit - ahead)
        if ahead + length > best:
            best, at, first, last = ahead + length, ahead, cell, end
        if length >= 1.5 * cells.size or ahead + length >= limit:
            break
        nearest = ahead + 0.25 * cells.size
    return best, at, first, last


@kernel(error_model="numpy")
def free_length(grid, cells, x, y, z, dx, dy, slope, step, headroom, limit):
    """`room`, with its end looked for on the triangles: (length [m], distance to the first cell [m], cell).

    ``grid`` is `MeshGrid.arrays`, ``step`` and ``headroom`` [m] are those of the walk rules.
    """
    length, ahead, first, last = room(cells, x, y, z, dx, dy, slope, limit)
    if first < 0 or length >= limit:
        return length, ahead, first
    size = cells.size
    column = column_of(cells, last)
    ix = column // cells.ny
    ux = x - (ix + 0.5) * size
    uy = y - (column - ix * cells.ny + 0.5) * size
    end = max(length - 0.5 * size, ahead)
    farthest = min(length + 0.5 * size, limit)
    before = np.nan
    while True:
        at = end + _STRIDE
        px, py = x + at * dx, y + at * dy
        slope_x, slope_y = gradient_of(cells, last)
        expected = height_of(cells, last) + slope_x * (ux + at * dx) + slope_y * (uy + at * dy)
        floor, t = surface_below(grid, px, py, expected - step - SAME, expected + step + SAME)
        if t < 0 or grid.triangles[t, KIND] != FLOOR:
            break
        if lowest_above(grid, px, py, floor + step + SAME, floor + headroom) < np.inf:
            break
        if before == before:
            qx, qy = x + end * dx, y + end * dy
            low = max(before, floor) + step + SAME
            if crossed(grid, qx, qy, low, px, py, low):
                break
            if crossed(grid, qx, qy, low + 0.5 * headroom, px, py, low + 0.5 * headroom):
                break
        before = floor
        end = at
        if end >= farthest:
            break
    return min(max(end, ahead), farthest), ahead, first
