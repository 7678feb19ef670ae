"""What the benchmark of missions calls "in walls", and what it compares ticks with."""

import numpy as np
import pytest

from benchmarks.missions import depth_through, time_ticks
from benchmarks.obstacle_scenes import box, merged, plate
from locomotion import Ground, Human
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


def test_bare_physics_is_that_of_one_on_hands_and_feet_who_finds_gentler_ground(monkeypatch):
    monkeypatch.setattr("benchmarks.missions.REPEATS", 1)
    monkeypatch.setattr("benchmarks.missions.MOST_TICKS", 2400)
    slope = 0.6
    steep = np.array([[-8.0, -4.0, 8.0 * slope], [0.0, -4.0, 0.0], [0.0, 4.0, 0.0], [-8.0, 4.0, 8.0 * slope]])
    level = np.array([[0.0, -4.0, 0.0], [9.0, -4.0, 0.0], [9.0, 4.0, 0.0], [0.0, 4.0, 0.0]])
    square = np.array([[0, 1, 2], [0, 2, 3]])
    ground = Ground.from_arrays(
        np.concatenate([steep, level]), np.concatenate([square, square + 4]), max_slope=0.75
    )
    human = Human(ground, rehearsals=0, gets_up=True)
    down = np.array([[-1.25, 0.0, 1.25 * slope], [0.0, 0.0, 0.0], [6.0, 0.0, 0.0]])
    whole, bare, ticks = time_ticks(human, down, 1.0)  # ends the program where they differ
    assert ticks == 2400 and min(whole, bare) > 0.0
    assert human.fours.active and human.fours.gentle > 0.0
