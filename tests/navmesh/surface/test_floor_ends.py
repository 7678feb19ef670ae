"""Edges behind which the floor does not go on: not those that two tiles nearly share."""

import math

import numpy as np
import pytest

from navmesh import NodeGraph, Terrain, WalkRules
from navmesh.level import raster
from navmesh.surface.build import lay_grid, whole_patch
from navmesh.surface.floor_ends import find_floor_ends
from tests.navmesh.shapes import box, join, plane, terrain
from tests.navmesh.surface.levels import RULES, build


def tiles(side: float, count: int, half: float):
    at = [(side * i - half, side * i + half) for i in range(count)]
    return join(*(plane(*x, *y) for x in at for y in at))


@pytest.mark.parametrize("resolution", [0.25, 0.1])
@pytest.mark.parametrize("side", [1.25, 2.5])
def test_tiles_scaled_in_single_precision_are_one_floor(side: float, resolution: float) -> None:
    half = 50 * side * float(np.float32(0.01))
    graph = NodeGraph.build(
        Terrain.from_arrays(*tiles(side, 4, half)), WalkRules(resolution=resolution), None
    )
    far = 3.8 * side - half
    assert graph.find_path((0.1, 0.1, 0), (far, far, 0), 0.3).status == "complete"


def test_the_rim_of_a_hole_ends_the_floor_on_all_sides():
    floors = [plane(0, 2, 0, 6), plane(4, 6, 0, 6), plane(2, 4, 0, 2), plane(2, 4, 4, 6)]
    graph = build(*floors)
    for x, y in ((1.0, 3.0), (5.0, 3.0), (3.0, 1.0), (3.0, 5.0)):
        assert graph.clearance_at((x, y, 0.0)) == pytest.approx(1.0, abs=1e-6)
    assert graph.clearance_at((1.0, 1.0, 0.0)) == pytest.approx(1.0, abs=1e-6)  # not to the seams


def test_what_one_column_knows_of_an_edge_is_what_the_other_finds():
    level = terrain(
        plane(0, 6, 0, 6), box(2, 3.1, 1, 4, 0, 2), plane(6, 8, 1, 3), box(4, 4.5, 4.5, 5, 0, 1.5)
    )
    grid = lay_grid(level.bounds, RULES, level.name)
    patch = whole_patch(grid)
    steepest = math.cos(RULES.max_slope)
    table = raster.prepare_triangles(level.vertices, level.faces, level.solid, grid.origin, steepest)
    start, triangle = raster.columns_of_triangles(table, patch, (0, 0, *grid.shape))
    columns = patch.nx * patch.ny

    def ends_of(row: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        asked = np.array([[-10.0, 10.0]])
        return find_floor_ends(
            table, start, triangle, row.astype(np.int32), asked, patch, RULES.max_step, RULES.headroom
        )

    first, ends = ends_of(np.zeros(columns))
    edges = ends[: first[-1], 4:8]
    assert len(np.unique(edges, axis=0)) < len(edges)  # some are on the border of two columns
    for column in np.flatnonzero(np.diff(first)):
        _, alone = ends_of(np.where(np.arange(columns) == column, 0, -1))
        count = first[column + 1] - first[column]
        np.testing.assert_array_equal(ends[first[column] : first[column + 1]], alone[:count])
