"""Recorded persons: they walk, take postures, hold things, and never jump from one pose to another."""

import numpy as np
import pytest

from locomotion.body_events import Arrived
from locomotion.recorded.skeletons import FULL, LOW, MEDIUM, skeleton
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.people import RecordedPeople
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


@pytest.mark.parametrize("level", [MEDIUM, LOW])
def test_one_whose_steps_go_on_every_third_tick_looks_the_same_as_one_whose_steps_always_do(level):
    poses, phases, late = {}, {}, set()
    for detail in (FULL, level):
        people, (ada,) = crowd_of(1, detail)
        ada.go_to([(16.0, 5.0, 0.0)], 1.4, None)
        poses[detail], phases[detail] = [], []
        for _ in range(400):
            people.tick()
            people.rows[0, at.LEVEL] = level  # as that is drawn
            poses[detail].append(ada.qpos)
            phases[detail].append(ada.phase)
            people.rows[0, at.LEVEL] = detail
            late.add(round(float(people.rows[0, at.LATE]), 6))
    apart = np.abs(np.subtract(phases[FULL], phases[level]) + 0.5) % 1.0 - 0.5
    assert np.abs(apart).max() < 0.02 and late == {0.0, 0.01, 0.02}
    often, seldom = np.array(poses[FULL]), np.array(poses[level])
    assert np.linalg.norm(often[:, :3] - seldom[:, :3], axis=1).max() < 0.01
    assert steps(seldom)[0] < 1.5 * steps(often)[0] and steps(seldom)[1] < 1.2 * steps(often)[1]


def test_those_side_by_side_are_not_in_step():
    people, persons = crowd_of(10)
    for person in persons:
        person.go_to([(16.0 + 0.1 * person.index, 5.0, 0.0)], 1.3, None)
    played(people, persons[0], 1.0)
    phases = np.exp(2j * np.pi * people.rows[:, at.PHASE])
    assert abs(phases.mean()) < 0.7


def test_one_less_leaves_the_others_as_they_are():
    people, persons = crowd_of(3)
    persons[2].go_to([(9.0, 6.0, 0.0)], 1.4, None)
    played(people, persons[2], 1.0)
    pose = persons[2].qpos
    people.remove(persons[0])
    assert persons[2].index == 1 and len(people) == 2
    np.testing.assert_array_equal(persons[2].qpos, pose)
