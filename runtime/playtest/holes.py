"""Holes: places where the floor ends with nothing below, all the way down."""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from scipy import ndimage

from navmesh.free_length import cells_of
from navmesh.probes import crossed
from navmesh.raster import UPRIGHT, is_over
from navmesh.risers import faces_up
from runtime.playtest.site import Site

__all__ = ["Hole", "find_holes"]

_LEAST_AREA = 0.1  # [m²] smaller ones are cracks that a foot does not notice


class Hole(NamedTuple):
    """A place without floor. ``place`` (3,) [m]: its middle, at the height of the rim; ``rim`` (r, 3) [m]:
    where
    walking ends beside it; ``area`` [m²]; ``enclosed``: whether floor or walls are all around it, so that it
    is not the outer edge of the level."""

    place: np.ndarray
    rim: np.ndarray
    area: float
    enclosed: bool


def find_holes(site: Site) -> list[Hole]:
    """The holes that a walking body can fall through, and the open edges of the level."""
    surface = site.graph.surface
    nx, ny = surface.shape
    empty = _bottomless(site.probe.arrays, surface.resolution, nx, ny)
    open_cells, beside = _open_rim(
        site.probe.arrays, cells_of(surface), surface.cell_column, empty, site.graph.rules.max_step,
        site.graph.rules.headroom,
    )  # fmt: skip
    label = np.asarray(ndimage.label(empty.reshape(nx, ny))[0])  # type: ignore[index]
    outside = set(np.unique(np.concatenate([label[0], label[-1], label[:, 0], label[:, -1]])).tolist())
    owner = label.ravel()[beside]
    # only where a body can come to: the rim belongs to a place that it fits in
    near = (surface.clearance[open_cells] >= 0.0) & (site.graph.label[open_cells] >= 0)
    near &= site.node_part[site.graph.label[open_cells]] >= 0
    holes = []
    for which in np.unique(owner[near]):
        mine = near & (owner == which)
        rim = surface.centers(open_cells[mine])
        columns = np.flatnonzero(label.ravel() == which)
        area = len(columns) * surface.resolution**2
        if area < _LEAST_AREA:
            continue
        if int(which) in outside:
            middle = rim[len(rim) // 2]
        else:
            ix, iy = np.divmod(columns, ny)
            middle = np.array([ix.mean() + 0.5, iy.mean() + 0.5, 0.0]) * surface.resolution + surface.origin
            middle[2] = np.median(rim[:, 2])
        holes.append(Hole(middle, rim, area, int(which) not in outside))
    return holes


@njit(cache=True)
def _bottomless(grid, size, nx, ny):
    """(nx·ny,) bool: columns at whose centre there is no surface, or whose lowest one faces down."""
    empty, table = np.ones(nx * ny, np.bool_), grid[0]
    for ix in range(nx):
        for iy in range(ny):
            x, y = (ix + 0.5) * size, (iy + 0.5) * size
            jx, jy = math.floor(x / grid[3]), math.floor(y / grid[3])
            if jx >= grid[4] or jy >= grid[5]:
                continue
            lowest = np.inf
            for k in range(grid[1][jx * grid[5] + jy], grid[1][jx * grid[5] + jy + 1]):
                f = grid[2][k]
                if table[f, 14] == UPRIGHT or not is_over(table, f, x, y):
                    continue
                z = table[f, 9] * x + table[f, 10] * y + table[f, 11]
                if z < lowest:
                    lowest = z
                    empty[ix * ny + iy] = not faces_up(table, f)
    return empty


@njit(cache=True)
def _open_rim(grid, cells, cell_column, empty, step, headroom):
    """Cells beside an empty column with no wall between: (cell, column) (k,) each."""
    _, _, height, _, link, size, nx, ny = cells
    found = np.empty(4 * len(height), np.int32)
    beside = np.empty(4 * len(height), np.int32)
    count = 0
    for c in range(len(height)):
        ix = cell_column[c] // ny
        iy = cell_column[c] - ix * ny
        for d in range(4):
            jx = ix + (1 if d == 0 else -1 if d == 2 else 0)
            jy = iy + (1 if d == 1 else -1 if d == 3 else 0)
            if link[c, d] >= 0 or jx < 0 or jy < 0 or jx >= nx or jy >= ny or not empty[jx * ny + jy]:
                continue
            x, y = (ix + 0.5) * size, (iy + 0.5) * size
            u, v = (jx + 0.5) * size, (jy + 0.5) * size
            free = True
            for k in range(4):
                z = height[c] + step + 0.05 + 0.3 * k * (headroom - step - 0.1)
                free = free and not crossed(grid, x, y, z, u, v, z)
            if free:
                found[count], beside[count] = c, jx * ny + jy
                count += 1
    return found[:count], beside[:count]
