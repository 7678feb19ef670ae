"""What the benchmark of missions calls "in walls"."""

import numpy as np
import pytest

from benchmarks.missions import depth_through
from benchmarks.obstacle_scenes import box, merged, plate
from navmesh.level.mesh_queries import MeshGrid

ORIGIN = np.array([-5.0, -5.0, -1.0])


@pytest.fixture(scope="module")
def triangles() -> np.ndarray:
    """A floor with a wall 10 cm thick and 2 m high across it, at x = 0."""
    mesh = merged(plate(8.0, 8.0), box(0.1, 3.0, 0.0, 2.0))
    return MeshGrid(*mesh, ORIGIN, 0.8).triangles


@pytest.mark.parametrize(
    ("a", "b", "depth"),
    [
        ((-0.5, 0.0, 0.3), (-0.1, 0.0, 0.1), 0.0),  # beside the wall and over the floor
        ((1.0, 0.3, 0.1), (1.1, 0.3, -0.02), 0.02),  # pressed 2 cm into the floor, however it slants
        ((-0.3, 0.0, 1.0), (0.3, 0.2, 1.0), 0.25),  # through the wall: as far as beyond the nearer face
        ((-0.04, 0.0, 1.0), (0.04, 0.0, 1.1), 0.0),  # inside it, where nothing is crossed
        ((-0.3, 1.6, 1.0), (0.3, 1.6, 1.0), 0.0),  # past its end
        ((0.25, 1.28, 1.0), (-0.15, 1.68, 1.1), 0.01 * 2.0**0.5),  # round the upright edge there, too near it
        ((0.15, 0.0, 1.85), (-0.05, 0.0, 2.05), 0.025 * 2.0**0.5),  # over its top
    ],
)
def test_depth_through(triangles: np.ndarray, a: tuple, b: tuple, depth: float) -> None:
    a, b = np.array(a) - ORIGIN, np.array(b) - ORIGIN
    assert depth_through(triangles, a, b) == pytest.approx(depth, abs=1e-9)
    assert depth_through(triangles, b, a) == pytest.approx(depth, abs=1e-9)
