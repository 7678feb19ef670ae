"""Searches on coarse graphs against networkx."""

import networkx
import numpy as np
import pytest

from navmesh.streaming.coarse_search import parts_reached, shortest_chain


def test_parts_are_reached_over_leaps_in_their_direction():
    rng = np.random.default_rng(0)
    for _ in range(30):
        source, target = rng.integers(0, 30, (2, rng.integers(0, 50)))
        found = parts_reached(30, 3, source, target)
        graph = networkx.DiGraph(zip(source.tolist(), target.tolist(), strict=True))
        graph.add_node(3)
        assert set(np.flatnonzero(found).tolist()) == {3} | networkx.descendants(graph, 3)


def csr(count, ends):
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    return np.searchsorted(ends[order, 0], np.arange(count + 1)).astype(np.int32), order


@pytest.mark.parametrize("seed", range(20))
def test_the_shortest_chain_is_that_of_dijkstra(seed):
    rng = np.random.default_rng(seed)
    count = 60
    place = rng.uniform(0.0, 100.0, (count, 3))
    goal = rng.uniform(0.0, 100.0, 3)
    pair = rng.integers(0, count, (90, 2))
    pair = np.unique(np.sort(pair[pair[:, 0] != pair[:, 1]], axis=1), axis=0)
    leap = rng.integers(0, count, (25, 2))
    far = np.linalg.norm(place[pair[:, 0]] - place[pair[:, 1]], axis=1) * rng.uniform(1.0, 2.0, len(pair))
    cost = np.linalg.norm(place[leap[:, 0]] - place[leap[:, 1]], axis=1) * rng.uniform(1.0, 2.0, len(leap))
    shut = rng.random(len(leap)) < 0.4
    ends = np.concatenate([pair, pair[:, ::-1]])
    start, order = csr(count, ends)
    leap_start, leap_order = csr(count, leap)
    begin = np.array([3, 7, 20], np.int32), rng.uniform(0.0, 30.0, 3)
    last = np.array([4, 30], np.int32)
    end = last, np.linalg.norm(place[last] - goal, axis=1)
    length, chain, ways = shortest_chain(
        start, ends[order, 1].astype(np.int32), np.tile(far, 2)[order].astype(np.float32),
        leap_start, leap[leap_order, 1].astype(np.int32), cost[leap_order], shut[leap_order],
        place, begin, end, tuple(goal.tolist()),
    )  # fmt: skip
    graph = networkx.MultiDiGraph()
    graph.add_nodes_from(["start", "goal"])
    for (a, b), d in zip(ends.tolist(), np.tile(far, 2).tolist(), strict=True):
        graph.add_edge(a, b, weight=d)
    for (a, b), d, closed in zip(leap.tolist(), cost.tolist(), shut.tolist(), strict=True):
        if not closed:
            graph.add_edge(a, b, weight=d)
    for a, d in zip(*begin, strict=True):
        graph.add_edge("start", int(a), weight=d)
    for a, d in zip(*end, strict=True):
        graph.add_edge(int(a), "goal", weight=d)
    if not networkx.has_path(graph, "start", "goal"):
        assert np.isinf(length) and not len(chain) and not len(ways)
        return
    assert length == pytest.approx(networkx.dijkstra_path_length(graph, "start", "goal"), rel=1e-6)
    first, final = begin[1][begin[0] == chain[0]], end[1][end[0] == chain[-1]]
    assert first.sum() + ways.sum() + final.sum() == pytest.approx(length, rel=1e-9)
    assert len(ways) == len(chain) - 1
