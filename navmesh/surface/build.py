"""From a terrain to its surface: the stages of the build in their order.

`find_cells` is everything that looks at triangles: what it finds in a column depends on the mesh nearby only
(`reach_of`), so that it can be done for a window of columns. `surface_of` carries clearances over the cells
found, near and far; it is a fiftieth of the work.
"""

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from navmesh.errors import NavmeshError, NoFloorError
from navmesh.level import raster
from navmesh.level.terrain import Terrain
from navmesh.rules import WalkRules
from navmesh.surface import blockers, clearance, floors, walls
from navmesh.surface.columns import columns_of_all, milestones
from navmesh.surface.floor_store import FloorStore, pack_floors
from navmesh.surface.storeys import check_storeys, storeys_of
from navmesh.surface.surface import Surface
from navmesh.threads import in_threads, shares

__all__ = [
    "Cells",
    "FoundCells",
    "Grid",
    "LinkedCells",
    "Window",
    "build_surface",
    "check_floor",
    "find_cells",
    "found_cells",
    "lay_grid",
    "lists_of",
    "patch_around",
    "reach_of",
    "surface_of",
    "surface_with_nearest",
    "whole_patch",
    "without_nearest",
]

_MOST_COLUMNS = 400_000_000
_MOST_KEPT = 4_000_000
"""Cells whose nearest places are kept during a build, which saves a tenth of it: 64 MB."""

Window = tuple[int, int, int, int]
"""Columns from (ix, iy) up to, not including, (ix, iy)."""


@dataclass(frozen=True, slots=True)
class Grid:
    """Where the columns are."""

    origin: np.ndarray
    """(3,) float64 [m]: the corner; x and y are multiples of the resolution."""
    resolution: float
    """[m], side of a column."""
    shape: tuple[int, int]

    @property
    def extent(self) -> np.ndarray:
        """(2, 3) float64 [m]: bounds for which `lay_grid` lays just this grid."""
        low, high = np.full(2, 1.5), np.array(self.shape) - 1.5
        sides = self.origin[:2] + np.stack([low, high]) * self.resolution
        return np.column_stack([sides, np.full(2, self.origin[2])])


@dataclass(frozen=True, slots=True, eq=False)
class LinkedCells:
    """Cells, their links and lists of blockers; arrays as in `Surface`."""

    column_start: np.ndarray
    storey: np.ndarray
    list_cell: np.ndarray
    list_start: np.ndarray
    blocker: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class Cells(LinkedCells):
    """The cells of a surface before clearances are carried over them."""

    floor: FloorStore


class FoundCells(NamedTuple):
    """Cells as they are found; arrays and properties as in `Surface`, links as numbers of cells or -1."""

    column_start: np.ndarray
    cell_column: np.ndarray
    height: np.ndarray
    gradient: np.ndarray
    link: np.ndarray
    list_cell: np.ndarray
    list_start: np.ndarray
    blocker: np.ndarray

    def packed(self) -> Cells:
        """The same with their floors packed."""
        return Cells(
            self.column_start, storeys_of(self.column_start, self.cell_column, self.link),
            self.list_cell, self.list_start, self.blocker,
            pack_floors(self.column_start, self.height, self.gradient),
        )  # fmt: skip


def lists_of(count: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """`list_cell` (l,) and `list_start` (l + 1,) of cells with so many blockers each (n,)."""
    cell = np.flatnonzero(count).astype(np.int32)
    return cell, np.concatenate([[0], np.cumsum(count[cell])]).astype(np.int32)


def lay_grid(bounds: np.ndarray, rules: WalkRules, name: str) -> Grid:
    """The grid over ``bounds`` (2, 3) [m]. Raises `NavmeshError` for more than 4·10⁸ columns."""
    h = rules.resolution
    corner = np.floor(bounds[0, :2] / h) - 1.0
    nx, ny = (np.floor(bounds[1, :2] / h) - corner + 2.0).astype(np.int64).tolist()
    if nx * ny > _MOST_COLUMNS:
        raise NavmeshError(
            f"{name}: {nx} x {ny} columns of {h:g} m are too many; expected at most "
            f"{_MOST_COLUMNS:.0e}: check the unit scale, or take a coarser resolution"
        )
    return Grid(np.array([corner[0] * h, corner[1] * h, math.floor(bounds[0, 2])]), h, (nx, ny))


def reach_of(rules: WalkRules) -> int:
    """Columns beyond a triangle in which there may be other cells with it than without it: a riser reaches
    as far as the least steep face that is too steep takes to rise by a step."""
    along = rules.max_step / max(math.tan(rules.max_slope), 1e-3)
    return math.ceil(along / rules.resolution) + 1


def whole_patch(grid: Grid) -> raster.Patch:
    """All columns of a grid."""
    return raster.Patch(grid.resolution, 0, 0, *grid.shape)


def patch_around(grid: Grid, window: Window) -> raster.Patch:
    """The columns of ``window``, and empty ones around them: cells have columns on all sides."""
    left, near = window[0] - 1, window[1] - 1
    return raster.Patch(grid.resolution, left, near, window[2] + 1 - left, window[3] + 1 - near)


def find_cells(terrain: Terrain, rules: WalkRules, grid: Grid, window: Window | None = None) -> Cells:
    """The cells of ``terrain``, or those of a ``window`` of it; see `found_cells`."""
    return found_cells(terrain, rules, grid, window).packed()


def found_cells(terrain: Terrain, rules: WalkRules, grid: Grid, window: Window | None = None) -> FoundCells:
    """The cells of ``terrain``, or those of a ``window`` of it, in its `patch_around`: right but for the
    window's outermost columns, as many as `reach_of` and three more. Raises `NoFloorError` when there is
    nothing to walk on at all."""
    faces, solid, whole = terrain.faces, terrain.solid, window is None
    if window is None:
        patch, window = whole_patch(grid), (0, 0, *grid.shape)
    else:
        patch = patch_around(grid, window)
        area = grid.origin[:2] + grid.resolution * np.array([window[:2], window[2:]])
        near = raster.near_triangles(terrain.vertices, faces, area[0] - 1e-6, area[1] + 1e-6)
        faces, solid = faces[near], solid[near]
    table = raster.prepare_triangles(
        terrain.vertices, faces, solid, grid.origin, math.cos(rules.max_slope) - 1e-9
    )
    start, triangle = raster.columns_of_triangles(table, patch, window)
    column_start, cell_column, height, gradient = floors.find_floors(
        table, start, triangle, patch, math.tan(rules.max_slope), rules.max_step, rules.headroom
    )
    link = floors.neighbours_within_step(column_start, cell_column, height, gradient, patch, rules.max_step)
    base = walls.find_walls(
        table, start, triangle, cell_column, height, gradient, patch, rules.max_step, rules.headroom
    )
    walls.cut_links_at_walls(
        table, start, triangle, base, cell_column, height, gradient, link, patch, rules.headroom
    )
    lists = blockers.find_blockers(
        table,
        start,
        triangle,
        base,
        cell_column,
        height,
        gradient,
        link,
        patch,
        rules.max_step,
        rules.headroom,
    )
    check_storeys(column_start, terrain.name)
    cells = FoundCells(column_start, cell_column, height, gradient, link, *lists)
    if whole:
        check_floor(cells, terrain, rules)
    return cells


def check_floor(cells: Cells | FoundCells, terrain: Terrain, rules: WalkRules) -> None:
    """Raise `NoFloorError` when there are no ``cells``."""
    if not cells.column_start[-1]:
        raise NoFloorError(
            f"{terrain.name}: nothing to walk on: no face is within {math.degrees(rules.max_slope):g}° "
            f"of level, faces up, has {rules.headroom:g} m free above it and is not inside of solids (closed "
            "parts); check the up axis, the unit scale and the order of the corners of the faces "
            "(counter-clockwise seen from outside, for floor from above)"
        )


def surface_of(cells: Cells, grid: Grid, threads: int = 1) -> Surface:
    """The surface that ``cells`` make up."""
    return without_nearest(surface_with_nearest(cells, grid, threads))


def without_nearest(surface: Surface) -> Surface:
    """``surface`` without its `kept_nearest`, which saves memory; `nearest` is worked out when asked for."""
    return replace(surface, kept_nearest=np.empty((0, 2)))


def surface_with_nearest(cells: Cells, grid: Grid, threads: int = 1) -> Surface:
    """The surface that ``cells`` make up. Up to `_MOST_KEPT` cells it keeps `nearest`, which makes measuring
    all of it quicker."""
    h, (nx, ny) = grid.resolution, grid.shape
    cell_column = columns_of_all(cells.column_start)
    nearest = blockers.nearest_blockers(
        cells.list_cell, cells.list_start, cells.blocker, cell_column, whole_patch(grid)
    )
    source = np.full(len(cell_column), -1, np.int32)
    source[cells.list_cell] = np.arange(len(cells.list_cell), dtype=np.int32)
    free, choice = clearance.spread_clearance(
        cells.column_start, cell_column, cells.storey, nearest, source, h, nx, ny
    )
    surface = Surface(
        origin=grid.origin,
        resolution=grid.resolution,
        shape=grid.shape,
        column_start=cells.column_start,
        milestone=milestones(cells.column_start),
        floor=cells.floor,
        storey=cells.storey,
        clearance=free,
        choice=choice,
        kept_nearest=nearest if len(nearest) <= _MOST_KEPT else np.empty((0, 2)),
        source=source,
        list_cell=cells.list_cell,
        list_start=cells.list_start,
        blocker=cells.blocker,
    )
    del nearest
    parts = pairwise(shares(len(surface), threads))
    in_threads(lambda *part: clearance.settle_clearance(surface.field, *part), list(parts), threads)
    return surface


def build_surface(terrain: Terrain, rules: WalkRules) -> Surface:
    """The walkable surface of ``terrain`` under ``rules``.

    Raises `NavmeshError` when nothing on it is walkable (all ceilings, all too steep), or when the grid
    would have more than 4·10⁸ columns (wrong units or too fine a resolution).
    """
    grid = lay_grid(terrain.bounds, rules, terrain.name)
    return surface_of(find_cells(terrain, rules, grid), grid)
