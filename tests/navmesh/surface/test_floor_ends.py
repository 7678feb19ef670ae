"""Edges behind which the floor does not go on: not those that two tiles nearly share."""

import numpy as np
import pytest

from navmesh import NodeGraph, Terrain, WalkRules
from tests.navmesh.shapes import join, plane
from tests.navmesh.surface.levels import build


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
