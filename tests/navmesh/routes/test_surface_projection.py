"""Points on the surface along a path: its corners alone say nothing of the ground between them."""

import numpy as np
import pytest

from navmesh import NodeGraph, WalkRules
from navmesh.routes.surface_projection import project_curve_to_surface, project_to_surface
from tests.navmesh.shapes import plane, quad, terrain


@pytest.fixture(scope="module")
def hill():
    """Up by 1 m over 4 m, and down again; a floor below it all."""
    up = quad((0, 0, 0), (4, 0, 1), (4, 4, 1), (0, 4, 0))
    down = quad((4, 0, 1), (8, 0, 0), (8, 4, 0), (4, 4, 1))
    return NodeGraph.build(terrain(up, down, plane(0, 8, 0, 4, -3)), WalkRules(), None)


def height(x):
    return 1.0 - np.abs(x - 4.0) / 4.0


def test_points_lie_on_the_hill_and_no_farther_apart_than_asked_for(hill):
    path = np.array([[1.0, 1.0, 0.25], [7.0, 3.0, 0.25]])
    points = project_to_surface(hill, path, 0.3)
    assert points[[0, -1]] == pytest.approx(path)
    assert points[:, 2] == pytest.approx(height(points[:, 0]), abs=0.03)
    assert np.linalg.norm(np.diff(points[:, :2], axis=0), axis=1).max() <= 0.3 + 1e-9


def test_a_curve_keeps_its_points_and_gets_their_heights(hill):
    """On the storey on which it begins."""
    curve = np.array([[1.0, 1.0, 0.25], [3.0, 2.0, 9.0], [6.0, 2.0, -9.0]])
    found = project_curve_to_surface(hill, curve)
    assert np.array_equal(found[:, :2], curve[:, :2])
    assert found[:, 2] == pytest.approx(height(curve[:, 0]), abs=0.03)
    below = project_curve_to_surface(hill, curve - [0.0, 0.0, 3.25])
    assert below[:, 2] == pytest.approx(-3.0)


def test_what_begins_beside_the_level_keeps_its_heights_until_it_is_on_it(hill):
    """Beside all cells, on all sides, and in a square of the grid without a cell: it ended the process."""
    for beside in ([-9.0, 1.0, 0.7], [99.0, 1.0, 0.7], [4.0, -50.0, 0.7], [4.0, 50.0, 0.7], [8.2, 1.0, 0.7]):
        curve = np.array([beside, [2.0, 2.0, 0.4], [4.0, 2.0, 9.0], [6.0, 2.0, -9.0]])
        found = project_curve_to_surface(hill, curve)
        assert found[:2] == pytest.approx(curve[:2])
        assert found[2:, 2] == pytest.approx(height(curve[2:, 0]), abs=0.03)
        points = project_to_surface(hill, curve[[0, 1, 3]] * [1.0, 1.0, 0.5], 0.5)
        onto = np.flatnonzero((np.abs(points[:, :2] - curve[1, :2]) < 1e-9).all(axis=1))[0]
        assert points[:onto, 2] == pytest.approx(np.interp(np.arange(onto), [0, onto], [0.35, 0.2]))
        assert points[onto + 1 : -1, 2] == pytest.approx(height(points[onto + 1 : -1, 0]), abs=0.03)
