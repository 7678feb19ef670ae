"""Recorded people on their way over obstacles: interrupted, in turn, saved."""

from dataclasses import replace

import numpy as np
import pytest

from locomotion import LocomotionError
from locomotion.body_events import Arrived, Cleared, LostGround, SetOff, TookOff
from locomotion.recorded.skeletons import LOW
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.saved_state_check import check_recorded
from navmesh import NodeGraph, Terrain
from tests.locomotion.recorded_people.test_clearing import EDGE, THICK, over
from tests.runtime.playtest.levels import box


def test_one_who_changes_its_mind_on_the_way_first_lands():
    people, ada = over("vault", 0.8)
    while people.rows[0, at.CROSSES] != at.CLEARS:
        people.tick()
    ada.go_to([(9.0, 2.0, 0.0)], 1.4, None)
    ada.take("kneel", "", "stowed")
    for _ in range(400):
        people.tick()
    assert ada.posture == "kneel" and ada.position[0] > EDGE + THICK and ada.crossing is None


@pytest.mark.parametrize("speed", [1.0, 1.8, 2.6, 3.4])
@pytest.mark.parametrize("kind", ["jump", "vault", "gap"])
def test_a_run_up_ends_in_step_with_the_recording(kind, speed):
    people, _ = over(kind, 0.7, speed=speed)
    row, phase = people.rows[0], 0.0
    while row[at.CROSSES] != at.CLEARS:
        phase = row[at.PHASE]
        people.tick()
    assert abs((phase - people.skills[kind].phase + 0.5) % 1.0 - 0.5) < 0.1


def test_two_take_turns_and_neither_arrives_at_its_run_up():
    people, ada = over("vault", 0.8)
    bob = people.add((1.0, 0.7, 0.0), 0.0, LOW, np.random.default_rng(4))
    bob.go_to([(9.0, 0.0, 0.0)], 1.4, None)
    both, told = 0, {ada: [], bob: []}
    for _ in range(1500):
        people.tick()
        both += int((people.rows[:, at.CROSSES] == at.CLEARS).sum() == 2)
        for one, events in told.items():
            events += [type(event) for event in one.events]
            one.events.clear()  # as a world does
    assert ada.status == bob.status == "arrived" and both == 0
    assert all(events == [SetOff, TookOff, Cleared, Arrived] for events in told.values())


def test_who_stands_where_one_would_land_is_waited_for():
    people, ada = over("vault", 0.8)
    while people.rows[0, at.CROSSES] != at.APPROACHES:
        people.tick()
    somebody = [[*ada.crossing.end, 0.0, 0.0, 0.3]]
    for _ in range(1000):
        people.crowd.lead(np.array(somebody))
        people.tick()
    assert people.rows[0, at.CROSSES] == at.APPROACHES
    for _ in range(1500):
        people.crowd.lead(np.empty((0, 6)))
        people.tick()
    assert ada.status == "arrived"


def test_an_obstacle_that_goes_during_the_run_up_is_not_cleared():
    people, ada = over("vault", 0.8)
    while people.rows[0, at.CROSSES] != at.RUNS_UP:
        people.tick()
    level = box(-5, 30, -10, 10, -1, 0)
    people.change_level(NodeGraph.build(Terrain(level.vertices, level.faces)))
    for _ in range(1500):
        people.tick()
    assert ada.status == "arrived" and not any(isinstance(event, TookOff) for event in ada.events)


def test_who_stands_is_on_the_floor_when_that_has_moved():
    people, ada = over("vault", 0.8)
    ada.stop()
    for _ in range(200):
        people.tick()
    before = ada.qpos[2]
    level = box(-5, 30, -10, 10, -1, 0.2)
    people.change_level(NodeGraph.build(Terrain(level.vertices, level.faces)))
    for _ in range(200):
        people.tick()
    assert ada.qpos[2] - before == pytest.approx(0.2, abs=0.01)


def test_a_person_saved_over_an_obstacle_goes_on_the_same_way():
    people, ada = over("jump", 0.5)
    for crosses in (at.APPROACHES, at.RUNS_UP, at.CLEARS):
        while people.rows[0, at.CROSSES] != crosses:
            people.tick()
        for _ in range(7):
            people.tick()
        saved = ada.save()
        check_recorded(saved, people.graph, len(people.gaits), people.skills)
        ends = set()
        for _ in range(2):
            for _ in range(40):
                people.tick()
            ends.add((ada.state_hash(), ada.qpos.tobytes()))
            ada.restore(saved)
        assert len(ends) == 1
    for wrong in (
        replace(saved, crossing=None),
        replace(saved, crossing=replace(saved.crossing, size=float("nan"))),
        replace(saved, crossing=replace(saved.crossing, affordance="fly")),
        replace(saved, crossing=replace(saved.crossing, begun=float("nan"))),
    ):
        with pytest.raises(LocomotionError):
            check_recorded(wrong, people.graph, len(people.gaits), people.skills)


def test_one_who_is_killed_on_the_run_up_falls_there():
    people, ada = over("vault", 0.8)
    while people.rows[0, at.CROSSES] != at.RUNS_UP:
        people.tick()
    for _ in range(20):
        people.tick()
    x = ada.position[0]
    before = ada.qpos
    ada.take("dead", "", "stowed")
    np.testing.assert_allclose(ada.qpos, before, atol=1e-9)
    check_recorded(ada.save(), people.graph, len(people.gaits), people.skills)
    for _ in range(300):
        people.tick()
    assert ada.posture == "dead" and ada.crossing is None and not people.rows[0, at.CROSSES]
    assert abs(ada.position[0] - x) < 0.3 and ada.qpos[2] < 0.25
    assert not [event for event in ada.events if isinstance(event, TookOff | Cleared)]


def test_one_who_is_killed_on_the_run_up_without_a_floor_below_stays_there():
    people, ada = over("vault", 0.8)
    while people.rows[0, at.CROSSES] != at.RUNS_UP:
        people.tick()
    ada.walker.carry(ada.walker.position + np.array([0.0, 0.0, 50.0]), ada.walker.velocity, ada.walker.yaw)
    ada.take("dead", "", "stowed")
    assert isinstance(ada.events[-1], LostGround) and ada.walker.status == "stuck"
    for _ in range(400):
        people.tick()
    assert not ada.walker.velocity.any() and people.rows[0, at.SPEED] == 0.0 and ada.posture == "dead"
    check_recorded(ada.save(), people.graph, len(people.gaits), people.skills)
