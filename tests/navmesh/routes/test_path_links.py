"""Routes over typed links: taken when the skill is offered, straight from run-up to landing."""

from pathlib import Path

import numpy as np
import pytest

from navmesh import NavmeshError, NodeGraph, Terrain

COURTYARD = Path(__file__).resolve().parents[3] / "examples" / "levels" / "courtyard.obj"
SKILLS = {"jump": (0.1, 0.7), "vault": (0.6, 1.0), "drop": (0.9, 2.0), "gap": (0.3, 3.0)}


@pytest.fixture(scope="module")
def graph() -> NodeGraph:
    return NodeGraph.build(Terrain.load(COURTYARD))


@pytest.fixture(scope="module")
def pairs(graph: NodeGraph) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(2)
    wide = np.flatnonzero(graph.radii > 0.4)
    return graph.positions[rng.choice(wide, 150)], graph.positions[rng.choice(wide, 150)]


def test_skills_reach_further(graph: NodeGraph, pairs: tuple[np.ndarray, np.ndarray]) -> None:
    without = graph.find_paths(*pairs)
    with_skills = graph.find_paths(*pairs, skills=SKILLS)
    assert not len(without.leaps)
    gained = (without.status != "complete") & (with_skills.status == "complete")
    lost = (without.status == "complete") & (with_skills.status != "complete")
    assert gained.sum() > 5 and not lost.any()


def test_a_link_is_a_straight_line_on_the_route(
    graph: NodeGraph, pairs: tuple[np.ndarray, np.ndarray]
) -> None:
    used = 0
    for route in graph.find_paths(*pairs, skills=SKILLS):
        for use in route.links:
            used += 1
            assert use.last == use.first + 1
            assert use.obstacle == graph.links.obstacle[use.link]
            assert np.allclose(route.waypoints[use.first], graph.links.start[use.link], atol=1e-9)
            assert np.allclose(route.waypoints[use.last], graph.links.end[use.link], atol=1e-9)
        if route.status == "complete":
            legs = route.legs()
            assert len(legs) == len(route.links) + 1
            ends = [leg.waypoints[-1] for leg in legs[:-1]] + [leg.waypoints[0] for leg in legs[1:]]
            at = [use.first for use in route.links] + [use.last for use in route.links]
            assert np.array_equal(np.array(ends).reshape(-1, 3), route.waypoints[at])
            assert sum(len(leg.radii) for leg in legs) == len(route.corridor.radii)
    assert used > 10


def test_only_what_is_offered_is_used(graph: NodeGraph, pairs: tuple[np.ndarray, np.ndarray]) -> None:
    for route in graph.find_paths(*pairs, skills={"jump": (0.1, 0.45)}, radius=0.35):
        for use in route.links:
            assert graph.links.affordance[use.link] == "jump"
            assert 0.1 <= graph.links.height[use.link] <= 0.45
            assert graph.links.radius[use.link] >= 0.35


def test_links_are_as_much_dearer_as_they_are_told(
    graph: NodeGraph, pairs: tuple[np.ndarray, np.ndarray]
) -> None:
    """A route over a link becomes at most as much dearer, and leads elsewhere if that is cheaper."""
    rng, kept, avoided = np.random.default_rng(3), 0, 0
    for start, goal in zip(*pairs, strict=True):
        route = graph.find_path(start, goal, skills=SKILLS)
        if route.status != "complete" or not route.links:
            continue
        those = graph.links.obstacle == route.links[0].obstacle
        closed = graph.find_path(start, goal, skills=SKILLS, link_costs=np.where(those, np.inf, 0.0))
        assert not any(those[use.link] for use in closed.links)
        dearer = graph.find_path(start, goal, skills=SKILLS, link_costs=those * rng.uniform(0.0, 30.0))
        over = np.array_equal(dearer.waypoints, route.waypoints)
        assert over or np.array_equal(dearer.waypoints, closed.waypoints)
        kept, avoided = kept + over, avoided + (not over)
        if closed.status == "complete":
            dear = graph.find_path(start, goal, skills=SKILLS, link_costs=those * 1e3)
            assert np.array_equal(dear.waypoints, closed.waypoints)
    assert kept > 3 and avoided > 3


@pytest.mark.parametrize("costs", [-1.0, np.nan, "dear", None])
def test_costs_of_links_are_checked(graph: NodeGraph, costs: object) -> None:
    wrong = [costs] * len(graph.links) if costs is not None else [0.0]
    with pytest.raises(NavmeshError, match=r"link_costs: expected \d+ costs \[m\] of at least 0"):
        graph.find_path((3.0, 3.0, 0.0), (46.0, 4.0, 0.3), link_costs=wrong)
