"""Recorded persons: they walk, take postures, hold things, and never jump from one pose to another."""

from dataclasses import replace

import numpy as np
import pytest

from locomotion import LocomotionError
from locomotion.body_events import Arrived, PostureReached
from locomotion.recorded.skeletons import FULL, LOW, MEDIUM, skeleton
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.people import RecordedPeople
from locomotion.recorded_people.saved_state_check import check_recorded
from tests.locomotion.crowd.levels import hall

NATURAL = 16.0  # [degrees] by which a knee bends within 20 ms of a walk or run, or while it gets faster


def crowd_of(count, level=FULL):
    people = RecordedPeople(hall())
    return people, [
        people.add((2.0 + k, 5.0, 0.0), 0.0, level, np.random.default_rng(k)) for k in range(count)
    ]


def played(people, person, seconds):
    """Poses (n, 46) every 10 or 20 ms, in turn as frames of 1/60 s."""
    poses = [person.qpos]
    for k in range(round(seconds * 60)):
        for _ in range(2 if k % 3 else 1):
            people.tick()
        poses.append(person.qpos)
    return np.array(poses)


def steps(poses):
    """Greatest change of a joint [degrees] and of the root [m] between frames."""
    return (
        np.degrees(np.abs(np.diff(poses[:, 7:], axis=0)).max()),
        np.linalg.norm(np.diff(poses[:, :3], axis=0), axis=1).max(),
    )


def test_a_recorded_person_walks_to_its_goal_on_its_feet():
    people, (ada,) = crowd_of(1)
    assert ada.status == "standing" and ada.posture == "stand"
    ada.go_to([(9.0, 5.0, 0.0)], 1.4, None)
    poses = played(people, ada, 3.0)
    assert ada.status == "walking" and steps(poses)[0] < NATURAL and steps(poses)[1] < 0.04
    knee = 7 + skeleton("full").channels.index("right_knee_flexion")
    assert np.ptp(poses[90:, knee]) > 0.5
    played(people, ada, 5.0)
    assert ada.status == "arrived" and isinstance(ada.events[-1], Arrived)
    ada.go_to([(18.0, 5.0, 0.0)], 3.5, None)
    played(people, ada, 1.5)
    assert ada.status == "running"


def test_postures_follow_on_each_other_without_a_jump():
    people, (ada,) = crowd_of(1)
    rng = np.random.default_rng(2)
    asked = ["kneel", "prone", "stand", "sit", "crouch", "prone", "stand", "dead"]
    for posture in asked:
        ada.take(posture, *(("rifle", "deployed") if posture in ("kneel", "prone") else ("", "stowed")))
        poses = played(people, ada, float(rng.uniform(0.3, 4.0)))  # some change their mind on the way
        assert steps(poses)[0] < 6.0 and steps(poses)[1] < 0.05
    played(people, ada, 4.0)
    assert ada.posture == "dead" and ada.events[-1].posture == "dead"
    with pytest.raises(LocomotionError, match="no way from 'dead'"):
        ada.go_to([(9.0, 5.0, 0.0)], 1.4, None)


def test_dying_on_the_run_is_no_jump_either():
    people, (ada,) = crowd_of(1)
    ada.go_to([(18.0, 5.0, 0.0)], 3.5, None)
    before = played(people, ada, 2.0)
    ada.take("dead", "", "stowed")
    after = played(people, ada, 2.5)
    np.testing.assert_allclose(after[0], before[-1], atol=1e-9)
    assert steps(after)[0] < NATURAL and steps(after)[1] < 0.08
    assert after[-1, 2] < 0.2 and ada.walker.velocity.max() == 0.0


@pytest.mark.parametrize("speed", [1.3, 3.0])
def test_who_is_told_to_kneel_on_the_way_walks_until_it_stands(speed):
    people, (ada,) = crowd_of(1)
    ada.go_to([(18.0, 5.0, 0.0)], speed, None)
    played(people, ada, 2.0)
    ada.take("kneel", "", "stowed")
    poses = [ada.qpos]
    while np.hypot(*ada.walker.velocity) > 0.1:
        people.tick()
        assert people.rows[0, at.GAIT] >= 0.0 and people.rows[0, at.LAID] > 0.0
        poses.append(ada.qpos)
    knees = [7 + skeleton("full").channels.index(f"{side}_knee_flexion") for side in ("right", "left")]
    assert np.ptp(np.array(poses)[:, knees], axis=0).max() > 0.5
    poses = np.concatenate([poses, played(people, ada, 4.0)[1:]])
    assert steps(poses)[0] < NATURAL and ada.events[-1].posture == "kneel"
    assert people.rows[0, at.GAIT] == -1.0


def test_what_it_holds_it_holds_on_the_way_and_who_kneels_first_gets_up():
    people, (ada,) = crowd_of(1)
    ada.take("kneel", "rifle", "in use")
    played(people, ada, 6.0)
    assert ada.held == ("rifle", "in use")
    ada.go_to([(9.0, 5.0, 0.0)], 1.4, None)
    assert ada.status == "walking" and ada.walker.status == "standing"
    played(people, ada, 3.0)
    assert ada.walker.status == "walking" and ada.held == ("rifle", "in use")
    elbow = 7 + skeleton("full").channels.index("right_elbow_flexion")
    assert np.degrees(ada.qpos[elbow]) == pytest.approx(122, abs=1)
    reached = [event for event in ada.events if isinstance(event, PostureReached)]
    assert [(event.posture, event.held) for event in reached] == [
        ("kneel", "rifle in use"),
        ("stand", "rifle in use"),
    ]


def test_one_alone_and_many_at_once_are_posed_alike():
    people, persons = crowd_of(6)
    for level, person in zip((FULL, MEDIUM, LOW) * 2, persons, strict=True):
        people.rows[person.index, at.LEVEL] = level
        person.go_to([(9.0 + person.index, 6.0, 0.0)], 1.0 + 0.1 * person.index, None)
    persons[4].take("kneel", "", "stowed")
    played(people, persons[0], 1.7)
    whole = people.transforms(np.arange(6))
    for k in range(6):
        np.testing.assert_allclose(people.transforms(np.array([k]))[0], whole[k], atol=1e-12)
    assert np.abs(people.transforms(np.arange(6), -0.01) - whole)[..., :3].max() < 0.08


def test_those_side_by_side_are_not_in_step():
    people, persons = crowd_of(10)
    for person in persons:
        person.go_to([(16.0 + 0.1 * person.index, 5.0, 0.0)], 1.3, None)
    played(people, persons[0], 1.0)
    phases = np.exp(2j * np.pi * people.rows[:, at.PHASE])
    assert abs(phases.mean()) < 0.7


def test_a_saved_person_goes_on_the_same_way_and_a_damaged_one_is_refused():
    people, (ada, bob) = crowd_of(2)
    ada.go_to([(9.0, 5.0, 0.0)], 1.4, None)
    bob.take("kneel", "rifle", "deployed")
    played(people, ada, 1.3)
    saved = [person.save() for person in (ada, bob)]
    ends = set()
    for _ in range(2):
        played(people, ada, 1.0)
        ends.add((ada.state_hash(), bob.state_hash(), ada.qpos.tobytes(), bob.qpos.tobytes()))
        for person, state in zip((ada, bob), saved, strict=True):
            person.restore(state)
    assert len(ends) == 1
    for state in saved:
        check_recorded(state, people.graph, len(people.gaits), people.skills)
    row = saved[0].row.copy()
    row[at.GAIT] = 7.0
    playing = saved[1].playback
    for wrong in (
        replace(saved[0], row=row),
        replace(saved[0], wanted="fly"),
        replace(saved[1], playback=None, wanted=""),
        replace(saved[1], playback=replace(playing, arc=400)),
        replace(saved[1], playback=replace(playing, begun=float("nan"))),
    ):
        with pytest.raises(LocomotionError):
            check_recorded(wrong, people.graph, len(people.gaits), people.skills)


def test_one_less_leaves_the_others_as_they_are():
    people, persons = crowd_of(3)
    persons[2].go_to([(9.0, 6.0, 0.0)], 1.4, None)
    played(people, persons[2], 1.0)
    pose = persons[2].qpos
    people.remove(persons[0])
    assert persons[2].index == 1 and len(people) == 2
    np.testing.assert_array_equal(persons[2].qpos, pose)
