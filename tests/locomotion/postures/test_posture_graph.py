"""Posture graphs: the least time between postures, and poses on arcs."""

import numpy as np
import pytest

from benchmarks.posture_graphs import brute_force, random_graph
from locomotion.postures.places import placed
from locomotion.postures.posture_graph import frame_at, least_times


@pytest.mark.parametrize("seed", range(200))
def test_the_least_time_is_that_of_the_quickest_of_all_paths(seed):
    rng = np.random.default_rng(seed)
    graph = random_graph(rng, postures=int(rng.integers(2, 7)), arcs=int(rng.integers(1, 12)))
    least = brute_force(graph)
    np.testing.assert_allclose(graph.least, least)
    for here in range(len(graph.postures)):
        for there in range(len(graph.postures)):
            at, spent = here, 0.0
            while at != there and graph.next_arc[at, there] >= 0:
                spent += graph.seconds[graph.next_arc[at, there]]
                at = graph.end[graph.next_arc[at, there]]
            assert (at == there) == np.isfinite(least[here, there])
            assert at != there or spent == pytest.approx(least[here, there])


def test_of_equally_quick_ways_the_first_in_the_file_is_taken():
    start, end = np.array([0, 1, 0, 0]), np.array([1, 2, 2, 2])
    least, next_arc = least_times(3, start, end, np.array([1.0, 1.0, 2.0, 2.0]))
    assert least[0, 2] == 2.0 and next_arc[0, 2] == 0
    assert next_arc[2, 0] == -1 and least[2, 0] == np.inf


@pytest.mark.parametrize("seed", range(5))
def test_an_arc_backwards_goes_through_the_same_poses_the_other_way(seed):
    graph = random_graph(np.random.default_rng(seed))
    arc = int(np.flatnonzero(graph.opposite >= 0)[0])
    back = int(graph.opposite[arc])
    assert graph.opposite[back] == arc
    for share in (0.0, 0.3, 0.77, 1.0):
        there = frame_at(graph, arc, share * graph.seconds[arc])
        again = placed(frame_at(graph, back, (1.0 - share) * graph.seconds[arc]), graph.moves[arc])
        again[3:7] *= np.sign(again[3:7] @ there[3:7])
        np.testing.assert_allclose(again, there, atol=1e-12)
