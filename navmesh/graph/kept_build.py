"""What is kept of a build, and how it is renewed after a change: `NodeGraph.build` and `NodeGraph.update`.

Cells, clearances, discs, edges and the samples at rims are found again only where a change reaches, each
stage as far as it has to go: to the bit what a build of the whole finds. The results are put in the place of
those of before. Only the joining of rim samples to obstacles goes over the whole level.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from navmesh.errors import NavmeshError
from navmesh.graph.carrying import Changes
from navmesh.graph.edge_changes import Edges, renew_edges
from navmesh.graph.edges import join_nodes
from navmesh.graph.node_changes import Nodes, renew_nodes
from navmesh.graph.nodes import all_nodes
from navmesh.level.mesh_queries import MeshGrid
from navmesh.level.terrain import Terrain
from navmesh.obstacles.rim_samples import RimSamples, renew_rim_samples, take_rim_samples
from navmesh.obstacles.rules import ObstacleRules
from navmesh.rules import WalkRules
from navmesh.surface.build import (
    Grid,
    Window,
    find_cells,
    lay_grid,
    patch_around,
    reach_of,
    surface_with_nearest,
    without_nearest,
)
from navmesh.surface.differences import differing_window
from navmesh.surface.renewal import cells_of_surface, renew_surface
from navmesh.surface.strips import all_cells
from navmesh.surface.surface import Surface

__all__ = ["Built", "KeptBuild", "all_rim_samples", "build_whole", "grid_for", "renewed"]

WHOLE = 0.5
"""Share of a build from which on the whole is built anew."""
MOST = 0.25
"""Share of the grid up to which clearances and discs are renewed in a rectangle."""
_AROUND = 24  # columns around a window that are mostly looked at, too
_COPYING = 0.1  # share of a build that it takes to put what stays in place
_ROOM = 0.25  # of a level's length by which its grid is laid wider on a side that it has outgrown


@dataclass(frozen=True, slots=True, eq=False)
class Built:
    """The surface of a terrain with discs and edges."""

    grid: Grid
    surface: Surface
    nodes: Nodes
    edges: Edges


@dataclass(frozen=True, slots=True, eq=False)
class KeptBuild:
    """What `NodeGraph.update` needs."""

    built: Built
    rim_samples: RimSamples | None
    """None where obstacles are not asked for."""


def grid_for(terrain: Terrain, rules: WalkRules, extent: np.ndarray | None, grown: bool = False) -> Grid:
    """The grid of a terrain that is to fill ``extent`` (2, 3) [m] as well as its own bounds. ``grown``: with
    room to grow on the sides where it has outgrown the extent."""
    bounds = terrain.bounds
    if extent is not None:
        room = np.asarray(extent, dtype=np.float64)
        if room.shape != (2, 3) or not np.isfinite(room).all() or (room[0] > room[1]).any():
            raise NavmeshError(
                f"extent = {np.asarray(extent).tolist()}: expected two corners (2, 3) [m], least and greatest"
            )
        both = np.stack([np.minimum(bounds[0], room[0]), np.maximum(bounds[1], room[1])])
        if grown:
            wider = _ROOM * (both[1] - both[0])[:2]
            over = 0.5 * rules.resolution  # of a grid's extent that the grid covers as well
            both[0, :2] -= wider * (bounds[0] < room[0] - over)[:2]
            both[1, :2] += wider * (bounds[1] > room[1] + over)[:2]
        bounds = both
    return lay_grid(bounds, rules, terrain.name)


def build_whole(terrain: Terrain, rules: WalkRules, grid: Grid, threads: int = 1) -> Built:
    """Surface, discs and edges of ``terrain``. Raises `NavmeshError` where there are none."""
    surface = surface_with_nearest(all_cells(terrain, rules, grid, threads), grid, threads)
    return _checked(_with_discs(rules, grid, surface, threads), terrain, rules)


def _with_discs(rules: WalkRules, grid: Grid, surface: Surface, threads: int = 1) -> Built:
    cell, place, maker, label = all_nodes(surface, rules.min_radius)
    nodes = Nodes(cell, place, maker, label, surface.lifted(place[:, :2], cell))
    edges = join_nodes(nodes.label, surface.field, nodes.place, threads)
    return Built(grid, without_nearest(surface), nodes, edges)


def _checked(built: Built, terrain: Terrain, rules: WalkRules) -> Built:
    if not len(built.surface):
        raise NavmeshError(f"{terrain.name}: after the change there is nothing to walk on")
    if not len(built.nodes.cell):
        raise NavmeshError(
            f"{terrain.name}: no place on it has a clearance of min_radius = {rules.min_radius:g} m"
        )
    return built


def renewed(
    old: Built, changed: list[np.ndarray], terrain: Terrain, rules: WalkRules
) -> tuple[Built, Changes | None]:
    """Surface, discs and edges of ``terrain``, which differs from that of ``old`` within the ``changed``
    bounds (2, 3) [m]: what `build_whole` gives. And what has changed, or None for all of it."""
    built, grid = old, old.grid
    changes: Changes | None = Changes(np.arange(len(old.nodes.cell), dtype=np.int32), ())
    beside = reach_of(rules) + 3  # and the links and distances of cells beside one that changes
    windows = _apart([_window(bounds, grid, beside) for bounds in changed])
    if sum(_share(window, grid) for window in windows) > WHOLE:
        return build_whole(terrain, rules, grid), None
    for window in windows:
        spare = reach_of(rules) + 4
        wide = (window[0] - spare, window[1] - spare, window[2] + spare, window[3] + spare)
        wide = _clipped(wide, *grid.shape)
        fresh, around = find_cells(terrain, rules, grid, wide), patch_around(grid, wide)
        within = differing_window(cells_of_surface(built.surface), fresh, window, around, grid.shape[1])
        if within is None:
            continue
        surface, reach = renew_surface(built.surface, fresh, within, around, grid, MOST)
        nodes = reach and renew_nodes(built.nodes, built.surface, surface, reach, rules.min_radius, MOST)
        if nodes is None:
            built, changes = _with_discs(rules, grid, surface), None
            continue
        edges = renew_edges(built.edges, built.nodes, built.surface, nodes, surface)
        built = Built(grid, surface, nodes.nodes, edges)
        changes = changes and changes.and_then(Changes(nodes.number, (nodes.window,)))
    return _checked(built, terrain, rules), changes


def _share(window: Window, grid: Grid) -> float:
    """About what share of a build it is to renew a window."""
    across, along = window[2] - window[0] + 2 * _AROUND, window[3] - window[1] + 2 * _AROUND
    return across * along / (grid.shape[0] * grid.shape[1]) + _COPYING


def all_rim_samples(
    before: KeptBuild | None,
    changed: Sequence[np.ndarray],
    terrain: Terrain,
    surface: Surface,
    rules: WalkRules,
    obstacle_rules: ObstacleRules,
    threads: int = 1,
) -> tuple[RimSamples, MeshGrid]:
    """The samples at the rims of ``terrain``, and its triangles for measuring. Only those near ``changed``
    bounds (2, 3) [m] are taken if there were any ``before``."""
    mesh_grid = MeshGrid(terrain.vertices, terrain.faces, surface.origin, rules.max_slope)
    if before is None or before.rim_samples is None:
        return take_rim_samples(terrain, surface, rules, obstacle_rules, mesh_grid, threads), mesh_grid
    areas = np.array([bounds[:, :2] - surface.origin[:2] for bounds in changed])
    renewed = renew_rim_samples(before.rim_samples, areas, terrain, surface, rules, obstacle_rules, mesh_grid)
    return renewed, mesh_grid


def _window(bounds: np.ndarray, grid: Grid, reach: int) -> Window:
    """The columns that ``bounds`` touch, and ``reach`` more on each side."""
    low = np.floor((bounds[0, :2] - grid.origin[:2]) / grid.resolution - 1e-6).astype(int) - reach
    high = np.floor((bounds[1, :2] - grid.origin[:2]) / grid.resolution + 1e-6).astype(int) + 1 + reach
    return _clipped((int(low[0]), int(low[1]), int(high[0]), int(high[1])), *grid.shape)


def _clipped(window: Window, nx: int, ny: int) -> Window:
    return max(window[0], 0), max(window[1], 0), min(window[2], nx), min(window[3], ny)


def _apart(windows: list[Window]) -> list[Window]:
    """Windows that cover ``windows`` and do not touch each other."""
    apart: list[Window] = []
    for window in windows:
        merged = window
        again = True
        while again:
            again = False
            for other in apart:
                if all(merged[k] <= other[k + 2] and merged[k + 2] >= other[k] for k in range(2)):
                    merged = (
                        min(merged[0], other[0]), min(merged[1], other[1]),
                        max(merged[2], other[2]), max(merged[3], other[3]),
                    )  # fmt: skip
                    apart.remove(other)
                    again = True
                    break
        apart.append(merged)
    return apart
