"""Where the floor ends on the way from cell to cell: not at cracks, but at gaps."""

import numpy as np
import pytest

from navmesh import NodeGraph, Terrain, WalkRules
from navmesh.surface.ledges import GAP
from tests.navmesh.shapes import join, plane


@pytest.mark.parametrize("seam", [5.0, 5.1, 5.125, 5.15])
@pytest.mark.parametrize("crack", [4e-9, 1e-6, 0.01, 0.05, 0.09])
def test_a_crack_is_floor(seam: float, crack: float) -> None:
    level = join(plane(0, seam - crack / 2, 0, 4), plane(seam + crack / 2, 10, 0, 4))
    graph = NodeGraph.build(Terrain.from_arrays(*level), WalkRules(), None)
    assert graph.find_path((1, 2, 0), (9, 2, 0), 0.3).status == "complete"
    assert graph.clearance_at((seam, 2.1, 0)) > 1.7  # nothing ends walking there


def test_a_gap_as_wide_as_a_cell_is_not() -> None:
    for seam in np.linspace(5, 5.25, 6):
        level = join(plane(0, seam - 0.18, 0, 4), plane(seam + 0.18, 10, 0, 4))
        graph = NodeGraph.build(Terrain.from_arrays(*level), WalkRules(), None)
        assert graph.find_path((1, 2, 0), (9, 2, 0), 0.3).status == "partial"


def test_floor_ends_at_a_gap_as_wide_as_is_said():
    for width, ends in ((0.9 * GAP, False), (1.5 * GAP, True)):
        level = join(plane(0, 5, 0, 4), plane(5 + width, 10, 0, 4))
        graph = NodeGraph.build(Terrain.from_arrays(*level), WalkRules(resolution=0.1), None)
        assert (graph.clearance_at((4.5, 2.0, 0)) < 0.6) == ends
