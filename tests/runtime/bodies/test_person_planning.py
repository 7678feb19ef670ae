"""The planning of an order: what is known at once, and that slices give what planning at once gives."""

from pathlib import Path

import numpy as np
import pytest

import navmesh
from benchmarks.giving_way import floor
from locomotion.gaits.limits import run_limits
from locomotion.gaits.run.skill import load_run_skill
from runtime.bodies.person_orders import Order, Planning
from runtime.planning.planning import Beginning, NoWay, make_plan

SKILLS = {"jump": (0.2, 0.5), "vault": (0.7, 1.0), "drop": (0.5, 2.5), "gap": (0.3, 2.0)}

COURTYARD = Path(__file__).parents[3] / "examples" / "levels" / "courtyard.obj"


@pytest.fixture(scope="module")
def graph():
    return navmesh.NodeGraph.build(navmesh.Terrain.load(COURTYARD, up="z"))


def order(place, *goals, velocity=(0.0, 0.0), walks=True):
    there = np.array(goals, dtype=np.float64)
    return Order(there, 3.0, True, (), np.array(place), np.array(velocity), walks, False, False)


def planning(graph, told):
    return Planning(graph, told, SKILLS, run_limits(load_run_skill()))


def test_slices_give_the_plan_that_planning_at_once_gives(graph):
    start, goal = (3.0, 3.0, 0.0), (46.0, 4.0, 0.3)
    at_once = planning(graph, order(start, goal)).finish()
    in_slices = planning(graph, order(start, goal))
    while in_slices.plan is None:
        in_slices.go_on()
    assert 2 <= in_slices.ticks <= 40
    for name in ("raw", "pulled", "points"):
        assert (getattr(in_slices.plan, name) == getattr(at_once, name)).all()
    assert in_slices.plan.ends == at_once.ends and in_slices.plan.skills == at_once.skills
    made = make_plan(graph, Beginning(np.array(start)), [np.array(goal)], 0.3, SKILLS)
    assert made.points[0] == pytest.approx(at_once.points[0])


def test_what_is_known_at_once_is_the_way_with_sharp_corners(graph):
    found = planning(graph, order((3.0, 3.0, 0.0), (46.0, 4.0, 0.3)))
    assert found.plan is None
    known = found.pulled
    smooth = found.finish()
    assert known.skills == smooth.skills
    assert (known.pulled == smooth.pulled).all() and (known.raw == smooth.raw).all()
    assert known.length <= smooth.length  # which goes back for its run-ups
    assert known.points[0] == pytest.approx(smooth.points[0], abs=0.05)
    assert known.points[-1] == pytest.approx(smooth.points[-1], abs=0.05)
    for rough, exact in zip(known.obstacles, smooth.obstacles, strict=True):
        assert rough.arc_length <= exact.arc_length + 0.1
        assert (rough.affordance, rough.size) == (exact.affordance, exact.size)
        assert rough.position == pytest.approx(exact.position)


def test_where_no_way_leads_it_says_so_at_once(graph):
    with pytest.raises(NoWay):
        planning(graph, order((3.0, 3.0, 0.0), (3.0, 3.0, 50.0)))


def test_a_runner_gets_a_path_that_it_can_begin():
    graph = floor((0.0, 0.0, 40.0, 20.0))
    told = order((20.0, 10.0, 0.0), (5.0, 12.0, 0.0), velocity=(3.0, 0.0), walks=False)
    points = planning(graph, told).finish().points
    first = points[1] - points[0]
    assert first[0] > 0.0 and abs(first[1]) < 0.3 * first[0]  # on, not back
    assert points[-1, :2] == pytest.approx([5.0, 12.0], abs=0.05)


def test_several_goals_are_planned_in_order():
    graph = floor((0.0, 0.0, 40.0, 20.0))
    plan = planning(graph, order((5.0, 5.0, 0.0), (10.0, 5.0, 0.0), (10.0, 12.0, 0.0))).finish()
    assert plan.ends[0] == pytest.approx(5.0, abs=0.2) and plan.ends[1] == pytest.approx(
        12.5, abs=0.5
    )  # round the corner
