"""Lines among houses are led round their corners."""

import numpy as np
import pytest

from benchmarks.large_levels import large_level
from navmesh import NodeGraph, WalkRules
from navmesh.routes.cell_search import DETOURS


@pytest.mark.parametrize("seed", (0, 3))
def test_all_ways_through_a_city_are_found_and_hardly_any_needs_a_search_over_cells(seed: int) -> None:
    rules = WalkRules(max_step=0.9, headroom=2.0)
    graph = NodeGraph.build(large_level("city", 4, seed), rules, obstacle_rules=None)
    rng = np.random.default_rng(seed)
    street = np.flatnonzero((graph.radii > 0.6) & (graph.positions[:, 2] < 0.1))
    starts, goals = graph.positions[rng.choice(street, (2, 300))]
    there, back = graph.find_paths(starts, goals, radius=0.6), graph.find_paths(goals, starts, radius=0.6)
    assert (there.status == "complete").all() and (back.status == "complete").all()
    assert graph.cache["scratch"][0].numbers[DETOURS] <= 1  # of 600 lines
    lengths = np.stack([there.length, back.length])
    assert (lengths.max(axis=0) < 1.1 * lengths.min(axis=0)).all()
