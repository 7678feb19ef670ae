"""Roads lead over areas that are allowed, and over no others."""

import math

import numpy as np
import pytest

from benchmarks.area_costs import COSTS, RADIUS, patchwork
from tests.navmesh.areas.painted import FIELD_ERROR, built, same, strips


@pytest.mark.parametrize("seed", range(40, 43))
def test_no_leg_touches_what_is_forbidden(seed: int) -> None:
    made = patchwork(seed)
    graph, rng = built(made.terrain), np.random.default_rng(seed)
    places = rng.uniform(-9.6, 9.6, (400, 2))
    forbidden = list(COSTS).index("swamp")
    dry = made.costs_at(places) != list(COSTS.values())[forbidden]
    places = places[dry & (made.gap_at(places) > RADIUS)][:40]
    places = np.column_stack([places, np.zeros(len(places))])
    cell = graph.surface.resolution
    found = 0
    for start, goal in zip(places[:20], places[20:], strict=True):
        route = graph.find_path(start, goal, RADIUS, costs=COSTS | {"swamp": math.inf})
        if not len(route.waypoints):
            assert route.status in ("no_path", "off_graph")
            continue
        points = route.on_surface(0.01)[:, :2]
        wet = made.costs_at(points) == COSTS["swamp"]
        ends = np.minimum(*(np.hypot(*(points - p[:2]).T) for p in (start, goal)))
        assert not (wet & (ends > 1.5 * cell)).any()
        assert made.gap_at(points).min() >= RADIUS - FIELD_ERROR
        found += route.status == "complete"
        if route.status == "partial":
            assert math.dist(points[-1], goal[:2]) < math.dist(start[:2], goal[:2])
    assert found > 3


def test_what_is_forbidden_closes_the_way() -> None:
    graph = built(strips("grass", "water", "grass"))
    forbids = {"water": math.inf}
    start, goal = (1.0, 6.0, 0.0), (11.0, 6.0, 0.0)
    route = graph.find_path(start, goal, costs=forbids)
    assert route.status == "partial"
    assert 3.5 < route.waypoints[-1, 0] < 4.0 and abs(route.waypoints[-1, 1] - 6.0) < 0.3
    assert graph.find_path(goal, start, costs=forbids).waypoints[-1, 0] > 8.0
    assert graph.find_path((6.0, 6.0, 0.0), goal, costs=forbids).status == "off_graph"
    assert graph.find_path(start, (6.0, 6.0, 0.0), costs=forbids).status == "partial"
    assert graph.find_path((3.9, 6.0, 0.0), goal, costs=forbids).status == "no_path"
    assert graph.find_path((3.97, 2.0, 0.0), (3.97, 9.0, 0.0), costs=forbids).status == "complete"
    assert graph.find_path(start, goal, costs={name: math.inf for name in graph.areas}).status == "off_graph"
    search = graph.begin_path(start, goal, costs=forbids)
    while not search.advance(9):
        pass
    assert same(search.finish(), route) and same(search.finish(), route)
    batch = graph.find_paths([start, goal], [goal, start], costs=forbids, workers=2)
    assert same(batch[0], route) and same(batch[1], graph.find_path(goal, start, costs=forbids))
