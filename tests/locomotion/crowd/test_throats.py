"""Throats on a graph after updates are those of all cells looked at anew."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.large_levels import large_level
from locomotion.crowd.throats import all_throats, throats_of
from navmesh import NodeGraph, join_chunks
from navmesh.graph.kernel_arrays import net_of
from navmesh.streaming.cutting import cut_level

LIMITS = 0.975, 0.5


@pytest.mark.parametrize(
    ("kind", "size", "side"), [("city", 2, 15.0), ("clutter", 20, 10.0), ("hills", 50, 15.0)]
)
def test_after_any_changes_throats_are_those_of_all_cells(kind, size, side):
    random = np.random.default_rng(5)
    chunks = cut_level(large_level(kind, size, 7), side)
    names = sorted(chunks)
    graph, loaded = NodeGraph.build(join_chunks(chunks), obstacle_rules=None), set(names)
    least = len(throats_of(graph, LIMITS[0]))
    for step in range(12):
        chosen = {names[k] for k in random.integers(len(names), size=2)}
        if len(loaded - chosen) < 2:
            continue
        graph = graph.update({name: None if name in loaded else chunks[name] for name in chosen})
        loaded ^= chosen
        for limit in LIMITS[: 1 + step % 2]:  # the other one is asked for after several changes
            found = throats_of(graph, limit)
            assert np.array_equal(found, all_throats(net_of(graph), limit))
            least = min(least, len(found))
    assert least > 0


def test_only_cells_near_a_change_are_looked_at_again():
    chunks = cut_level(large_level("city", 4, 7), 15.0)
    graph = NodeGraph.build(join_chunks(chunks), obstacle_rules=None)
    before = throats_of(graph, LIMITS[0])
    updated = graph.update({"1,1": None})
    earlier = updated.cache["earlier throats"][LIMITS[0]]
    updated.cache["earlier throats"][LIMITS[0]] = replace(earlier, known=(np.empty(0, np.int64),))
    found = throats_of(updated, LIMITS[0])
    assert 0 < len(found) < len(before) // 2
    column = updated.surface.columns(found)
    ((left, near, right, far),) = earlier.changes.windows
    ix, iy = np.divmod(column, updated.surface.shape[1])
    assert (ix >= left - 2).all() and (ix <= right + 2).all()
    assert (iy >= near - 2).all() and (iy <= far + 2).all()
