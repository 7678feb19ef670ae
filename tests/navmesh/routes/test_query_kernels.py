"""One query, many, or one in slices: the same answers bit by bit."""

import numpy as np
import pytest

from tests.navmesh.routes.path_references import scene


@pytest.mark.parametrize("seed", range(3))
def test_batches_and_slices_give_the_same_bits(seed: int) -> None:
    graph, rng = scene(seed, 12)
    ends = np.column_stack([rng.uniform(-1.0, 15.0, (80, 2)), np.zeros(80)])
    starts, goals = ends[:40], ends[40:]
    batch = graph.find_paths(starts, goals, radius=0.4)
    shared = graph.find_paths(starts, goals, radius=0.4, workers=3)
    assert len(set(batch.status)) >= 2
    for i, (start, goal) in enumerate(zip(starts, goals, strict=True)):
        single = graph.find_path(start, goal, 0.4)
        search = graph.begin_path(start, goal, 0.4)
        slices = 1
        while not search.advance(3):
            slices += 1
        sliced = search.finish()
        assert sliced.expanded <= 6 * slices + 64  # the end may search as much again
        for other in (batch[i], shared[i], sliced):
            assert other.status == single.status and other.length == single.length
            assert np.array_equal(other.waypoints, single.waypoints)
            assert np.array_equal(other.nodes, single.nodes)
            assert other.expanded == single.expanded
