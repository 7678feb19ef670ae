"""Where a body can be in the whole world, and in which region: the cells of the fine graph as runs.

A run is a row of cells in +y, each linked to the next, that belong to one region and lie within `FLAT` of a
straight line in height. So a wide floor takes a few bytes for each row of cells, not for each cell.
"""

from dataclasses import dataclass
from math import sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from navmesh.graph.kernel_arrays import net_of
from navmesh.graph.snapping import node_at, place_in
from navmesh.surface.clearance_field import centre_of, floor_at
from surefoot.kernels import allocating_kernel, kernel

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["FLAT", "Footprint", "footprint_of"]

FLAT = 0.1
"""[m] by which the floor of a cell may lie above or below its run."""


@dataclass(frozen=True, slots=True, eq=False)
class Footprint:
    """The runs of one body radius, by rising row and column. Distances are relative to the grid's corner."""

    row_start: np.ndarray
    """(nx + 1,) int32: the runs of row ix are row_start[ix]:row_start[ix + 1]."""
    first: np.ndarray
    """(k,) int32: iy of each run's first cell."""
    last: np.ndarray
    """(k,) int32: iy of its last cell."""
    height: np.ndarray
    """(k,) float32 [m]: of the floor at the centre of the first cell."""
    slope: np.ndarray
    """(k,) float32: dz/dy along the run."""
    region: np.ndarray
    """(k,) int32: the region that a body in these cells is in."""

    def nearest(
        self, cell: float, point: Any, limits: tuple[float, float, float], allowed: np.ndarray
    ) -> tuple[int, np.ndarray, float]:
        """The place nearest to ``point`` (3,) [m, relative to the grid's corner] in the ``allowed`` (R, bool)
        regions: (region or -1, place (3,), distance [m]). Places are looked for on the lines through the
        centres of the runs' cells, ``cell`` [m] apart.

        ``limits``: how far [m] it may be away sideways, and up or down, and how much of the latter does not
        count.
        """
        x, y, z = (float(value) for value in point)
        arrays = self.row_start, self.first, self.last, self.height, self.slope, self.region
        region, *place, off = _nearest(*arrays, allowed, cell, x, y, z, *limits)
        return int(region), np.array(place), float(off)


def footprint_of(graph: "NodeGraph", radius: float, region_of_node: np.ndarray) -> Footprint:
    """The footprint of a body of ``radius`` [m] on ``graph``; ``region_of_node`` (m,) int32, -1 for none."""
    net = net_of(graph)
    regions = _regions_of_cells(net, radius, region_of_node)
    surface = graph.surface
    cells = surface.cell_column, surface.height, np.ascontiguousarray(surface.link[:, 1])
    row, *runs = _runs(*cells, regions, surface.shape[1], surface.resolution)
    row_start = np.searchsorted(row, np.arange(surface.shape[0] + 1)).astype(np.int32)
    return Footprint(row_start, *runs)


@allocating_kernel(error_model="numpy")
def _regions_of_cells(net, radius, region_of_node):
    """The region of a body in each cell, (n,) int32; -1 where it does not fit: at the centre, or else at the
    place of the cell that is nearest to it."""
    count = net.label.size
    regions = np.full(count, -1, np.int32)
    for k in range(count):
        node = -1
        if net.clearance[k] >= radius:
            node = net.label[k]
        elif net.clearance[k] >= radius - 0.7072 * net.cell:
            x, y = centre_of(net, k)
            off, px, py = place_in(net, k, x, y, floor_at(net, k, x, y), radius, 0.0, 1e300)
            if off < 1e300:
                node = node_at(net, k, px, py, radius)
        if node >= 0:
            regions[k] = region_of_node[node]
    return regions


@allocating_kernel(error_model="numpy")
def _runs(column, floor, link, regions, along, cell):
    """(row, first, last, height, slope, region) of the runs that the cells of ``regions`` (n,) make; of each
    cell its column (``along`` of them in a row), height [m] and the cell that it is linked to in +y, (n,)
    each."""
    count = regions.size
    done = np.zeros(count, np.bool_)
    row = np.empty(count, np.int32)
    first, last = np.empty(count, np.int32), np.empty(count, np.int32)
    height, slope = np.empty(count, np.float32), np.empty(count, np.float32)
    region = np.empty(count, np.int32)
    runs = 0
    for k in range(count):
        if regions[k] < 0 or done[k]:
            continue
        low, high = -1e300, 1e300  # the slopes of lines from the first cell that pass near enough to all
        at, steps = k, 0
        done[k] = True
        while True:
            beyond = link[at]
            if beyond < 0 or done[beyond] or regions[beyond] != regions[k]:
                break
            away = (steps + 1) * cell
            rise = floor[beyond] - floor[k]
            if max(low, (rise - FLAT) / away) > min(high, (rise + FLAT) / away):
                break
            low, high = max(low, (rise - FLAT) / away), min(high, (rise + FLAT) / away)
            at, steps = beyond, steps + 1
            done[at] = True
        row[runs] = column[k] // along
        first[runs] = column[k] % along
        last[runs] = first[runs] + steps
        height[runs] = floor[k]
        slope[runs] = 0.5 * (low + high) if steps > 0 else 0.0
        region[runs] = regions[k]
        runs += 1
    return (
        row[:runs].copy(), first[:runs].copy(), last[:runs].copy(), height[:runs].copy(),
        slope[:runs].copy(), region[:runs].copy(),
    )  # fmt: skip


@kernel(error_model="numpy")
def _nearest(
    row_start, first, last, height, slope, region, allowed, cell, x, y, z, reach, rise, step
):  # fmt: skip
    """See `Footprint.nearest`: (region, x, y, z, distance)."""
    rows, half = row_start.size - 1, 0.5 * cell
    best, found, bx, by, bz = 1e300, -1, x, y, z
    middle = min(max(int(x // cell), 0), rows - 1)
    for ring in range(rows):
        near = max((ring - 1) * cell, 0.0)  # rows in this ring and beyond are not nearer
        if near * near >= best or near > reach:
            break
        for side in range(1 if ring == 0 else 2):
            ix = middle + ring if side == 0 else middle - ring
            if ix < 0 or ix >= rows:
                continue
            px = (ix + 0.5) * cell
            across = (px - x) * (px - x)
            if across >= best:
                continue
            for k in range(row_start[ix], row_start[ix + 1]):
                if not allowed[region[k]]:
                    continue
                py = min(max(y, first[k] * cell + half), last[k] * cell + half)
                flat = across + (py - y) * (py - y)
                if flat >= best or flat > reach * reach:
                    continue
                pz = height[k] + slope[k] * (py - first[k] * cell - half)
                if abs(pz - z) > rise:
                    continue
                up = max(abs(pz - z) - step, 0.0)
                if flat + up * up < best:
                    best, found, bx, by, bz = flat + up * up, region[k], px, py, pz
    return found, bx, by, bz, sqrt(best)
