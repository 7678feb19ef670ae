"""Areas: the materials of a level as places on which some bodies would rather not walk.

A cell of the surface has the material of the triangle that its centre lies on. Cells that triangles of
several materials touch are divided into `PARTS` x `PARTS` parts, each with the material at its middle. All
of this is worked out when costs are first asked for, so other graphs pay nothing for it.
"""

import math
from collections.abc import Mapping
from numbers import Real
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from navmesh.errors import NavmeshError
from navmesh.level.raster import (
    KIND,
    UPRIGHT,
    Patch,
    columns_of_triangles,
    height_at,
    is_over,
    prepare_triangles,
)
from surefoot.kernels import allocating_kernel, kernel

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["MOST", "PARTS", "Areas", "areas_of", "checked_costs", "dearest"]

MOST = 1e6
"""Greatest finite cost that an area may have."""
PARTS = 8
"""Parts along each side of a cell for which the material is known where it changes."""


class Areas(NamedTuple):
    """Which of `NodeGraph.areas` each place belongs to."""

    area: np.ndarray
    """(n,) int16: of each cell, at its centre."""
    row: np.ndarray
    """(n,) int32: the row in `part` that a cell has, or -1 where it and those beside it are one area."""
    part: np.ndarray
    """(m, PARTS²) int16: of the parts of a cell, x-major."""


@kernel
def _face_at(table, triangle, first, last, x, y, floor, most):
    """Of the triangles listed in triangle[first:last] the one over (x, y) nearest in height to ``floor``,
    less than ``most`` [m] away; -1 where there is none."""
    found = -1
    for i in range(first, last):
        t = triangle[i]
        if table[t, KIND] == UPRIGHT:
            continue
        off = abs(height_at(table, t, x, y) - floor)
        if off < most and is_over(table, t, x, y):
            most, found = off, t
    return found


@kernel
def _is_mixed(table, triangle, first, last, material, x, y, floor, most):
    """Whether the listed triangles whose planes are less than ``most`` [m] from ``floor`` at (x, y) have
    several materials."""
    own = -1
    for i in range(first, last):
        t = triangle[i]
        if table[t, KIND] == UPRIGHT:
            continue
        if abs(height_at(table, t, x, y) - floor) >= most:
            continue
        if own >= 0 and material[t] != own:
            return True
        own = material[t]
    return False


@allocating_kernel
def _rows_at_borders(area, row, part, link):
    """Rows for all cells with parts of another area in it or beside it: ``row`` (n,) and ``part`` anew."""
    cells = area.shape[0]
    fresh = np.full(cells, -1, np.int32)
    count = 0
    for k in range(cells):
        near = row[k] >= 0
        for way in range(4):
            other = link[k, way]
            near = near or (other >= 0 and (row[other] >= 0 or area[other] != area[k]))
        if near:
            fresh[k] = count
            count += 1
    parts = np.empty((count, PARTS * PARTS), np.int16)
    for k in range(cells):
        if fresh[k] >= 0:
            for i in range(PARTS * PARTS):
                parts[fresh[k], i] = part[row[k], i] if row[k] >= 0 else area[k]
    return fresh, parts


@allocating_kernel
def dearest(areas, factor, link):
    """`Areas.part` with the dearest of each part and those beside it, (m, PARTS²) int16.

    So a line that is cheap by it is cheap on the mesh, also where it runs along a border.
    """
    found = areas.part.copy()
    for k in range(areas.row.shape[0]):
        row = areas.row[k]
        if row < 0:
            continue
        for i in range(PARTS):
            for j in range(PARTS):
                for way in range(4):
                    ni = i + (way == 0) - (way == 2)
                    nj = j + (way == 1) - (way == 3)
                    other = np.int64(k)
                    if ni < 0 or nj < 0 or ni == PARTS or nj == PARTS:
                        other = np.int64(link[k, way])
                        ni, nj = ni % PARTS, nj % PARTS
                    if other < 0:
                        continue
                    beside = areas.area[other]
                    if areas.row[other] >= 0:
                        beside = areas.part[areas.row[other], ni * PARTS + nj]
                    if factor[beside] > factor[found[row, i * PARTS + j]]:
                        found[row, i * PARTS + j] = beside
    return found


@allocating_kernel
def _areas_of_cells(table, start, triangle, material, column, height, gradient, link, h, ny, step):
    """`Areas`, with a row for every cell that may have several.

    ``table`` (t, COLUMNS), ``start`` and ``triangle`` as of `navmesh.level.raster`, ``material`` (t,) int16;
    a triangle counts within ``step`` [m] of a cell's floor.
    """
    cells = column.shape[0]
    area, row = np.full(cells, -1, np.int16), np.full(cells, -1, np.int32)
    count = 0
    for k in range(cells):
        first, last = start[column[k]], start[column[k] + 1]
        x, y = (column[k] // ny + 0.5) * h, (column[k] % ny + 0.5) * h
        own = _face_at(table, triangle, first, last, x, y, height[k], step)
        if own >= 0:
            area[k] = material[own]
        if _is_mixed(table, triangle, first, last, material, x, y, height[k], step + h):
            row[k] = count
            count += 1
    # what lies over no triangle, on the crest of a step, has the area of a cell beside it
    queue, size = np.empty(cells, np.int32), 0
    for k in range(cells):
        if area[k] >= 0:
            queue[size] = k
            size += 1
    head = 0
    while head < size:
        k = queue[head]
        head += 1
        for way in range(4):
            other = link[k, way]
            if other >= 0 and area[other] < 0:
                area[other] = area[k]
                queue[size] = other
                size += 1
    part = np.empty((count, PARTS * PARTS), np.int16)
    side = h / PARTS
    for k in range(cells):
        area[k] = max(area[k], 0)
        if row[k] < 0:
            continue
        first, last = start[column[k]], start[column[k] + 1]
        for i in range(PARTS * PARTS):
            dx = (i // PARTS + 0.5) * side - 0.5 * h
            dy = (i % PARTS + 0.5) * side - 0.5 * h
            x, y = (column[k] // ny + 0.5) * h + dx, (column[k] % ny + 0.5) * h + dy
            floor = height[k] + gradient[k, 0] * dx + gradient[k, 1] * dy
            own = _face_at(table, triangle, first, last, x, y, floor, step)
            part[row[k], i] = material[own] if own >= 0 else area[k]
    return area, row, part


def areas_of(graph: "NodeGraph") -> Areas:
    """The graph's `Areas`, worked out once."""
    kept = graph.cache.get("areas")
    if kept is None:
        terrain, surface, rules = graph.terrain, graph.surface, graph.rules
        cells = len(surface)
        if len(graph.areas) == 1:
            none = np.empty((0, PARTS * PARTS), np.int16)
            kept = Areas(np.zeros(cells, np.int16), np.full(cells, -1, np.int32), none)
        else:
            at = terrain.vertices[terrain.faces]
            normal = np.cross(at[:, 1] - at[:, 0], at[:, 2] - at[:, 0])
            size = np.sqrt((normal * normal).sum(axis=1))
            level = np.flatnonzero((np.abs(normal[:, 2]) > 2e-3 * size) & (size > 1e-11))
            table = prepare_triangles(
                terrain.vertices,
                terrain.faces[level],
                np.full(len(level), -1, np.int32),
                surface.origin,
                math.cos(rules.max_slope),
            )
            h, (nx, ny), link = surface.resolution, surface.shape, surface.link
            area, row, part = _areas_of_cells(
                table,
                *columns_of_triangles(table, Patch(h, 0, 0, nx, ny), (0, 0, nx, ny)),
                terrain.face_material[level].astype(np.int16),
                surface.cell_column,
                *surface.floor.unpacked(surface.column_start),
                link,
                h,
                ny,
                rules.max_step,
            )
            several = np.flatnonzero(row >= 0)
            uniform = (part == part[:, :1]).all(axis=1)
            area[several[uniform]] = part[uniform, 0]
            row[several] = np.where(uniform, -1, np.cumsum(~uniform) - 1)
            kept = Areas(area, *_rows_at_borders(area, row, part[~uniform], link))
        graph.cache["areas"] = kept
    return kept


def checked_costs(graph: "NodeGraph", costs: Any) -> np.ndarray:
    """(k,) float64: what a metre costs in each of `NodeGraph.areas`. Raises `NavmeshError`."""
    names = graph.areas
    if not isinstance(costs, Mapping):
        raise NavmeshError(f"costs: expected costs by area, as in {{'mud': 3.0}}, not {costs!r}")
    factor = np.ones(len(names))
    for name, value in costs.items():
        if name not in names:
            raise NavmeshError(f"costs: there is no area {name!r}; there are {', '.join(names)}")
        number = isinstance(value, Real) and not isinstance(value, bool)
        given = float(value) if number else math.nan
        if not given >= 1.0:
            raise NavmeshError(f"costs: area {name!r}: expected a cost of at least 1, not {value!r}")
        if MOST < given < math.inf:
            raise NavmeshError(
                f"costs: area {name!r}: expected at most {MOST:g}, or math.inf, which forbids it, "
                f"not {value!r}"
            )
        factor[names.index(name)] = given
    return factor
