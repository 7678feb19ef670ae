"""Portals and parts carried over from before an update are, to the bit, those of a graph built anew."""

from functools import cache

import numpy as np
import pytest

from benchmarks.large_levels import large_level
from navmesh import NodeGraph, Terrain, join_chunks, split_terrain
from navmesh.graph import portal_changes
from navmesh.graph.open_to_body import parts_of, portals_of

RADII = (0.25, 0.6, 1.4)


@cache
def chunks_of(kind, size, side):
    return split_terrain(large_level(kind, size, 0), side)


def built(chunks, like=None):
    low, high = join_chunks(chunks if like is None else like).bounds
    return NodeGraph.build(join_chunks(chunks), obstacle_rules=None, extent=[low - 1.0, high + 1.0])


def all_of(graph: NodeGraph, radius: float) -> tuple[np.ndarray, ...]:
    part, tiles = parts_of(graph, radius)
    return *portals_of(graph, radius), part, *tiles


@pytest.mark.parametrize(
    ("kind", "size", "side"), [("city", 4, 5.0), ("hills", 120, 6.0), ("clutter", 60, 4.0)]
)
def test_random_changes(kind, size, side, monkeypatch):
    whole, times = portal_changes.open_portals, []
    monkeypatch.setattr(portal_changes, "open_portals", lambda *given: times.append(given) or whole(*given))
    rng, chunks = np.random.default_rng(size), chunks_of(kind, size, side)
    names, there = sorted(chunks), dict(chunks)
    graph, carried = built(chunks), 0
    for turn in range(9):
        for name in map(str, rng.choice(names, rng.integers(1, 3), replace=False)):
            if turn % 3 != 2:  # now and then nobody asks between two updates
                for radius in RADII:
                    parts_of(graph, radius)
            shift = rng.uniform(-0.5, 0.5, 3) * (rng.random() < 0.5)
            moved = Terrain.from_arrays(chunks[name].vertices + shift, chunks[name].faces)
            change = None if name in there and rng.random() < 0.5 else moved
            graph = graph.update({name: change})
            there = {key: each for key, each in (there | {name: change}).items() if each is not None}
        times.clear()
        found = [all_of(graph, radius) for radius in RADII]
        carried += not times
        fresh = built(there, chunks)
        for radius, arrays in zip(RADII, found, strict=True):
            for mine, expected in zip(arrays, all_of(fresh, radius), strict=True):
                np.testing.assert_array_equal(mine, expected, f"radius {radius}, turn {turn}")
    assert carried >= 3


def test_what_is_far_from_a_change_is_not_looked_at_again():
    chunks = chunks_of("city", 4, 5.0)
    before = built(chunks)
    lens = portals_of(before, 0.6)[2]
    right = lens.copy()
    lens[:] = -1.0
    names = sorted(chunks)
    after = before.update({names[0]: None})
    renewed = portals_of(after, 0.6)[2]
    assert (right >= 0.0).all() and (renewed == -1.0).all(axis=1).mean() > 0.5
