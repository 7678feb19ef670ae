"""Recorded people clear obstacles of other sizes than those that were recorded, and never go through them."""

from dataclasses import replace

import numpy as np
import pytest

import navmesh
from locomotion import LocomotionError
from locomotion.body_events import Arrived, Cleared, SetOff, TookOff
from locomotion.ground.ground import Ground
from locomotion.recorded.motion_set import load_motions
from locomotion.recorded.skeletons import FULL, LOW, MEDIUM
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.clearing import recorded_skills, skill_ranges
from locomotion.recorded_people.people import RecordedPeople
from locomotion.recorded_people.saved_state_check import check_recorded
from locomotion.skills.course import make_course

EDGE, THICK = 5.0, 0.3
GIVES = 0.12  # [m] that a joint of the body may be under a surface: toes, where one takes off


def over(kind, size, level=FULL, speed=1.4):
    course = make_course([(kind, size, THICK)], [EDGE])
    terrain = navmesh.Terrain.from_arrays(course.vertices, course.faces)
    graph = navmesh.NodeGraph.build(terrain)
    people = RecordedPeople(graph, ground=Ground.from_arrays(course.vertices, course.faces))
    ada = people.add((1.0, 0.0, 0.0), 0.0, level, np.random.default_rng(3))
    ada.go_to([course.path[-1] - [10.0, 0.0, 0.0]], speed, None)
    return people, ada


def height(kind, size, x):
    """Of the course at x (n,) [m]."""
    if kind == "vault":
        return np.where((x > EDGE) & (x < EDGE + THICK), size, 0.0)
    if kind == "gap":
        return np.where((x > EDGE) & (x < EDGE + size), -3.0, 0.0)
    return np.where(x > EDGE, size if kind == "jump" else -size, 0.0)


@pytest.mark.parametrize(
    ("kind", "size", "level"),
    [
        ("jump", 0.25, FULL), ("jump", 0.6, LOW), ("vault", 0.62, MEDIUM), ("vault", 0.95, FULL),
        ("drop", 1.0, LOW), ("drop", 1.9, FULL), ("gap", 0.6, MEDIUM), ("gap", 1.7, LOW),
    ],
)  # fmt: skip
def test_an_obstacle_of_another_size_is_cleared_and_not_gone_through(kind, size, level):
    people, ada = over(kind, size, level)
    deepest, cleared, statuses, tops = 0.0, [], set(), []
    for _ in range(2000):
        people.tick()
        statuses.add(ada.status)
        if people.rows[0, at.CROSSES] == at.CLEARS:
            places = people.transforms(np.array([0]))[0]
            deepest = max(deepest, float((height(kind, size, places[:, 0]) - places[:, 2]).max()))
            cleared.append(places[0, :3])
            tops.append(places[:, 2].min() - height(kind, size, places[:1, 0])[0])
        if ada.status in ("arrived", "stuck"):
            break
    assert (
        ada.status == "arrived" and {"jump": "jumping", "vault": "vaulting"}.get(kind, "walking") in statuses
    )
    assert [type(event) for event in ada.events] == [SetOff, TookOff, Cleared, Arrived]
    assert ada.events[1].affordance == kind and ada.events[1].height == pytest.approx(size, abs=1e-3)
    assert deepest < GIVES, deepest
    assert np.linalg.norm(np.diff(cleared, axis=0), axis=1).max() < 0.1  # 10 m/s


def test_skills_are_found_in_the_recordings():
    motions = load_motions()
    found = recorded_skills(motions)
    assert set(found) == {"jump", "vault", "drop", "gap"} == set(skill_ranges(motions))
    for skill in found.values():
        assert skill.begins < skill.leaves < skill.lands <= skill.ends and 0.0 < skill.lead < 3.0


def test_one_who_changes_its_mind_on_the_way_first_lands():
    people, ada = over("vault", 0.8)
    while people.rows[0, at.CROSSES] != at.CLEARS:
        people.tick()
    ada.go_to([(9.0, 2.0, 0.0)], 1.4, None)
    ada.take("kneel", "", "stowed")
    for _ in range(400):
        people.tick()
    assert ada.posture == "kneel" and ada.position[0] > EDGE + THICK and ada.crossing is None


def test_two_take_turns():
    people, ada = over("vault", 0.8)
    bob = people.add((1.0, 0.7, 0.0), 0.0, LOW, np.random.default_rng(4))
    bob.go_to([(9.0, 0.0, 0.0)], 1.4, None)
    both = 0
    for _ in range(1500):
        people.tick()
        both += int((people.rows[:, at.CROSSES] == at.CLEARS).sum() == 2)
    assert ada.status == bob.status == "arrived" and both == 0


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
