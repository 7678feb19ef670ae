"""A level's cells, and its graph, are the same however it is cut into strips and whoever works on them."""

import numpy as np
import pytest

from navmesh import NavmeshError, NodeGraph
from navmesh.surface import strips
from navmesh.surface.build import find_cells, lay_grid
from navmesh.surface.strips import all_cells
from tests.navmesh.shapes import box, plane, terrain
from tests.navmesh.surface.levels import RULES, random_level

FIELDS = ("column_start", "storey", "list_cell", "list_start", "blocker")


@pytest.fixture
def narrow(monkeypatch):
    """Strips as wide as their margins."""
    monkeypatch.setattr(strips, "_COLUMNS", 100)
    monkeypatch.setattr(strips, "_NARROWEST", 1)


@pytest.mark.parametrize(("seed", "threads"), [(5, 1), (6, 2), (7, 3)])
def test_strips_hold_the_cells_of_the_whole(seed, threads, narrow):
    level = terrain(*random_level(seed))
    grid = lay_grid(level.bounds, RULES, level.name)
    whole, joined = find_cells(level, RULES, grid), all_cells(level, RULES, grid, threads)
    for name in FIELDS:
        expected, found = getattr(whole, name), getattr(joined, name)
        assert found.dtype == expected.dtype
        np.testing.assert_array_equal(found, expected, err_msg=name)
    height, gradient = joined.floor.unpacked(joined.column_start)
    for found, expected in zip((height, gradient), whole.floor.unpacked(whole.column_start), strict=True):
        np.testing.assert_array_equal(found, expected)


def test_a_graph_with_obstacles_is_the_same_for_any_number_of_threads(narrow):
    level = terrain(plane(0, 14, 0, 8), box(6, 9, 0, 8, 0, 0.5), box(11, 11.3, 0, 8, 0, 0.8))
    one, three = (NodeGraph.build(level, RULES, threads=threads) for threads in (1, 3))
    assert len(one.obstacles) > 1
    for name in ("positions", "label", "edge_start", "edge_target", "edge_width", "edge_gate", "edge_cells"):
        np.testing.assert_array_equal(getattr(one, name), getattr(three, name), err_msg=name)
    for name in ("clearance", "nearest", "source"):
        np.testing.assert_array_equal(getattr(one.surface, name), getattr(three.surface, name), err_msg=name)
    for name, values in one.obstacles.arrays().items():
        np.testing.assert_array_equal(values, getattr(three.obstacles, name), err_msg=name)


def test_where_there_is_nothing_to_walk_on_strips_say_so_too(narrow):
    vertices, faces = plane(0, 14, 0, 8)
    with pytest.raises(NavmeshError, match="nothing to walk on"):
        NodeGraph.build(terrain((vertices, faces[:, ::-1])), RULES)
