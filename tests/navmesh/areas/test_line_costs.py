"""What a line costs by the areas that it crosses."""

import pytest

from benchmarks.area_costs import COSTS, RADIUS, price


def test_the_cost_is_the_price_of_the_line(scene) -> None:
    made, graph, starts, goals = scene
    for route in graph.find_paths(starts, goals, RADIUS, costs=COSTS):
        assert route.cost == pytest.approx(price(made, route.waypoints), rel=0.03, abs=0.3)
        assert route.cost >= route.length - 1e-9
