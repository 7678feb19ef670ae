"""Recorded people clear obstacles of other sizes than those that were recorded, and never go through them."""

import numpy as np
import pytest

import navmesh
from locomotion.body_events import Arrived, Cleared, SetOff, TookOff
from locomotion.ground.ground import Ground
from locomotion.recorded.motion_set import load_motions
from locomotion.recorded.skeletons import FULL, LOW, MEDIUM
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.people import RecordedPeople
from locomotion.recorded_people.recorded_skills import recorded_skills, skill_ranges
from locomotion.skills.course import make_course

EDGE, THICK = 5.0, 0.3
GIVES = 0.08  # [m] that a joint of the body may be under a surface: toes, where one takes off


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
