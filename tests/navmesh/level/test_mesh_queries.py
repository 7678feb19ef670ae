"""Questions to the triangles, against slow references over all of them."""

import math
from itertools import pairwise

import numpy as np
import pytest

from benchmarks.obstacle_scenes import box, merged, plate, turned
from navmesh.level.mesh_queries import (
    MeshGrid,
    brute_crossed,
    brute_surface_below,
    crossed,
    lowest_above,
    surface_below,
)
from navmesh.level.raster import KIND


def _soup(seed: int) -> MeshGrid:
    rng = np.random.default_rng(seed)
    vertices = rng.uniform(0.0, 6.0, (60, 3))
    return MeshGrid(vertices, rng.integers(0, 60, (40, 3)).astype(np.int32), np.zeros(3), math.radians(45))


def test_columns_list_floors_first_and_upright_faces_last() -> None:
    grid = _soup(3)
    kinds = [grid.triangles[grid.member[a:b], KIND] for a, b in pairwise(grid.start)]
    assert max(len(set(each)) for each in kinds) > 1
    assert all((np.diff(each) <= 0.0).all() for each in kinds)


@pytest.mark.parametrize("seed", range(4))
def test_surface_below_finds_what_the_slow_reference_finds(seed: int) -> None:
    grid = _soup(seed)
    rng = np.random.default_rng(seed + 100)
    for x, y, z in rng.uniform(0.0, 6.0, (200, 3)):
        low = z - rng.uniform(0.5, 6.0)
        height, triangle = surface_below(grid.arrays, x, y, low, z)
        expected = brute_surface_below(grid.triangles, x, y, low, z)
        assert (triangle >= 0) == math.isfinite(expected)
        if triangle >= 0:
            assert height == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_crossed_agrees_with_the_slow_reference(seed: int) -> None:
    grid = _soup(seed)
    rng = np.random.default_rng(seed + 200)
    both = set()
    for p, q in rng.uniform(0.0, 6.0, (300, 2, 3)):
        q = p + (q - p) * rng.choice([0.2, 1.0])
        answer = crossed(grid.arrays, *p, *q)
        assert answer == brute_crossed(grid.triangles, p, q)
        both.add(answer)
    assert both == {True, False}


def test_a_wall_without_thickness_is_crossed_from_both_sides_and_along_the_grid() -> None:
    vertices = np.array([(2.0, 0.0, 0.0), (2.0, 4.0, 0.0), (2.0, 4.0, 1.0), (2.0, 0.0, 1.0)])
    grid = MeshGrid(vertices, np.array([(0, 1, 2), (0, 2, 3)], np.int32), np.zeros(3), math.radians(45))
    assert crossed(grid.arrays, 1.9, 1.0, 0.5, 2.1, 1.0, 0.5)
    assert crossed(grid.arrays, 2.1, 1.0, 0.5, 1.9, 1.0, 0.5)
    assert not crossed(grid.arrays, 1.9, 1.0, 1.1, 2.1, 1.0, 1.1)
    assert not crossed(grid.arrays, 1.9, 0.5, 0.5, 1.9, 3.5, 0.5)


def test_lowest_above_leaves_out_its_limits() -> None:
    vertices, faces = merged(plate(4, 4, 0.0), box(4, 4, 2.0, 2.5))
    grid = MeshGrid(
        turned(vertices, 0.3, np.array([4.0, 4.0, 0.0])),
        faces.astype(np.int32),
        np.zeros(3),
        math.radians(45),
    )
    assert lowest_above(grid.arrays, 4.0, 4.0, 0.0, 3.0) == pytest.approx(2.0)
    assert lowest_above(grid.arrays, 4.0, 4.0, 0.0, 2.0) == np.inf
    assert lowest_above(grid.arrays, 4.0, 4.0, 2.2, 3.0) == pytest.approx(2.5)
    assert lowest_above(grid.arrays, -4.0, 4.0, 0.0, 3.0) == np.inf
