"""From a terrain to its surface: the stages of the build in their order."""

import math

import numpy as np

from navmesh import clearance, floors, raster, walls
from navmesh.errors import NavmeshError
from navmesh.rules import WalkRules
from navmesh.surface import Surface
from navmesh.terrain import Terrain

__all__ = ["build_surface"]

_MOST_COLUMNS = 400_000_000


def build_surface(terrain: Terrain, rules: WalkRules) -> Surface:
    """The walkable surface of ``terrain`` under ``rules``.

    Raises `NavmeshError` when nothing on it is walkable (all ceilings, all too steep), or when the grid
    would have more than 4·10⁸ columns (wrong units or too fine a resolution).
    """
    h = rules.resolution
    least, greatest = terrain.bounds
    corner = np.floor(least[:2] / h) - 1.0
    nx, ny = (np.floor(greatest[:2] / h) - corner + 2.0).astype(np.int64).tolist()
    if nx * ny > _MOST_COLUMNS:
        raise NavmeshError(
            f"{terrain.name}: {nx} x {ny} columns of {h:g} m are too many; expected at most "
            f"{_MOST_COLUMNS:.0e}: check the unit scale, or take a coarser resolution"
        )
    origin = np.array([corner[0] * h, corner[1] * h, math.floor(least[2])])
    table = raster.prepare_triangles(
        terrain.vertices, terrain.faces, origin, math.cos(rules.max_slope) - 1e-9
    )
    start, triangle = raster.columns_of_triangles(table, h, nx, ny)
    column_start, cell_column, height, gradient = floors.find_floors(
        table, start, triangle, h, nx, ny, math.tan(rules.max_slope), rules.max_step, rules.headroom
    )
    if len(cell_column) == 0:
        raise NavmeshError(
            f"{terrain.name}: nothing to walk on: no face is within {math.degrees(rules.max_slope):g}° "
            f"of level, faces up, and has {rules.headroom:g} m free above it; check the up axis, the unit "
            "scale and the order of the corners of the faces (counter-clockwise seen from above)"
        )
    link = floors.neighbours_within_step(column_start, cell_column, height, gradient, h, ny, rules.max_step)
    base = walls.find_walls(
        table, start, triangle, cell_column, height, gradient, h, ny, rules.max_step, rules.headroom
    )
    walls.cut_links_at_walls(
        table, start, triangle, base, cell_column, height, gradient, link, h, ny, rules.headroom
    )
    nearest = clearance.seed_clearance(
        table,
        start,
        triangle,
        base,
        cell_column,
        height,
        gradient,
        link,
        h,
        ny,
        rules.max_step,
        rules.headroom,
    )
    free = clearance.spread_clearance(column_start, link, nearest, h, nx, ny)
    return Surface(
        origin=origin,
        resolution=h,
        shape=(nx, ny),
        column_start=column_start,
        cell_column=cell_column,
        height=height,
        gradient=gradient,
        link=link,
        clearance=free,
        nearest=nearest,
    )
