"""From where an agent is, through its goals in order, to one path, or why there is none."""

import dataclasses

import numpy as np
import pytest

import navmesh
from benchmarks.giving_way import floor
from locomotion.skills.jump.skill import load_jump_skill
from runtime import Blocked, World
from runtime.evaluation.courses import make_course
from runtime.planning.planning import Beginning, NoWay, make_plan, way_holds
from runtime.planning.rules import person_walk_rules
from tests.runtime.changing_level import START, quad, two_floors


@pytest.mark.parametrize(("body", "offer"), [("human", "jump "), ("walker", "no skills")])
def test_an_obstacle_that_no_skill_clears_is_named(body, offer, monkeypatch):
    whole = load_jump_skill()
    low = {name: getattr(whole, name)[:2] for name in ("heights", "table", "references")}
    monkeypatch.setattr(
        "locomotion.skills.jump.kind.load_jump_skill", lambda: dataclasses.replace(whole, **low)
    )
    course = make_course([("jump", 0.65, 0.0)], [8.0])
    terrain = navmesh.Terrain.from_arrays(course.vertices, course.faces)
    world = World(navmesh.NodeGraph.build(terrain, person_walk_rules()))
    agent = world.spawn(body, (1.0, 0.0, 0.0))
    assert agent.go_to((12.0, 0.0, 0.65)) == "blocked"
    event = world.events[-1]
    assert isinstance(event, Blocked) and f"lead over jump 0.65 m; there are {offer}" in event.reason


@pytest.fixture(scope="module")
def whole():
    return two_floors()


def test_a_way_over_a_platform_holds_as_long_as_the_platform_is_the_same(whole):
    def box(z):
        top, side = (
            quad(10.0, 0.0, 16.0, 8.0, z),
            [(10.0, 8.0, 0), (10.0, 0.0, 0), (10.0, 0.0, z), (10.0, 8.0, z)],
        )
        return navmesh.Terrain.from_arrays(
            np.vstack([top.vertices, side]), [*top.faces.tolist(), (4, 5, 6), (4, 6, 7)]
        )

    graph = whole.update({"east": quad(9.0, 0.0, 10.0, 8.0), "box": box(0.4)})
    plan = make_plan(
        graph, Beginning(np.array(START)), [np.array([13.0, 2.0, 0.4])], 0.3, {"jump": (0.3, 0.5)}
    )
    assert plan.skills == ("jump",)
    behind = plan.obstacles[0].arc_length + 0.5
    for changes, holds_before, holds_behind in (
        ({"apart": None}, True, True),
        ({"detour": None}, True, True),
        ({"bridge": None}, False, True),
        ({"box": box(0.45)}, False, True),
        ({"box": box(0.8)}, False, False),
        ({"box": None}, False, False),
    ):
        after = graph.update(changes)
        assert way_holds(after, plan, 0.3, 0.0) == holds_before, changes
        assert way_holds(after, plan, 0.3, behind) == holds_behind, changes
        on_run_up = plan.obstacles[0].arc_length - 0.2  # which begins on the bridge
        assert way_holds(after, plan, 0.3, on_run_up) == holds_before, changes


@pytest.fixture(scope="module")
def hall():
    return floor((0.0, 0.0, 20.0, 8.0))


def planned(graph, start, *goals, radius=0.3, **how):
    begin = Beginning(np.array([*start, 0.0]), **how)
    return make_plan(graph, begin, [np.array([*goal, 0.0]) for goal in goals], radius, {})


def test_it_leads_through_all_goals_in_order(hall):
    plan = planned(hall, (2.0, 2.0), (10.0, 2.0), (10.0, 6.0))
    assert plan.points[0] == pytest.approx([2.0, 2.0, 0.0])
    assert plan.points[-1] == pytest.approx([10.0, 6.0, 0.0])
    first, last = plan.ends
    assert first == pytest.approx(8.0, abs=0.1) and last == pytest.approx(plan.length)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(plan.points[:, :2], axis=0), axis=1))])
    at = [np.interp(first, along, plan.points[:, axis]) for axis in (0, 1)]
    assert at == pytest.approx([10.0, 2.0], abs=1e-6)
    assert plan.skills == () and repr(plan).startswith(f"<Plan: {plan.length:.2f} m")


def test_a_goal_where_it_is_already_counts_as_reached_at_once(hall):
    plan = planned(hall, (2.0, 2.0), (2.0, 2.0), (6.0, 2.0))
    assert plan.ends == (0.0, pytest.approx(4.0, abs=0.1))
    assert planned(hall, (2.0, 2.0), (2.0, 2.0)).length == 0.0


def test_one_that_moves_goes_on_the_way_it_moves(hall):
    ahead = planned(hall, (4.0, 4.0), (10.0, 4.0), direction=np.array([0.0, 1.0])).points
    step = (ahead[1] - ahead[0])[:2]
    assert step / np.linalg.norm(step) == pytest.approx([0.0, 1.0], abs=0.05)


def test_a_lead_comes_first_and_counts(hall):
    lead = np.array([[2.0, 2.0, 0.0], [4.0, 2.0, 0.0]])
    plan = planned(hall, (2.0, 2.0), (4.0, 6.0), lead=lead)
    assert np.array_equal(plan.points[:2], lead)
    assert plan.ends == (pytest.approx(plan.length),) and plan.length == pytest.approx(6.0, abs=0.1)


def test_which_goal_cannot_be_reached_is_told(hall):
    with pytest.raises(NoWay, match="goal 1: it is not near a place where the body fits") as found:
        planned(hall, (2.0, 2.0), (5.0, 2.0), (90.0, 2.0))
    assert found.value.goal == 1
    with pytest.raises(NoWay, match="begins at a place where the body does not fit"):
        planned(hall, (90.0, 2.0), (5.0, 2.0))


def test_a_way_holds_as_far_as_it_is_not_behind(hall):
    plan = planned(hall, (2.0, 4.0), (18.0, 4.0))
    shorter = floor((8.0, 0.0, 20.0, 8.0))
    assert way_holds(hall, plan, 0.3, 0.0)
    assert not way_holds(shorter, plan, 0.3, 5.0) and way_holds(shorter, plan, 0.3, 7.0)
