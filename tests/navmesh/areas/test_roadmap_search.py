"""The search over a roadmap: in slices or at once, the same."""

import pytest

from benchmarks.area_costs import COSTS, RADIUS
from tests.navmesh.areas.painted import same


@pytest.mark.parametrize("slice_of", [1, 7, 100_000])
def test_a_search_in_slices_is_what_a_single_question_gives(scene, slice_of: int) -> None:
    _, graph, starts, goals = scene
    for start, goal in zip(starts[:4], goals, strict=False):
        search = graph.begin_path(start, goal, RADIUS, costs=COSTS)
        while not search.advance(slice_of):
            pass
        whole = graph.find_path(start, goal, RADIUS, costs=COSTS)
        assert same(search.finish(), whole)
        early = graph.begin_path(start, goal, RADIUS, costs=COSTS)
        early.advance(1)
        assert early.finish().status in ("partial", "no_path", "complete")
