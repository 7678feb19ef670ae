"""Feet of recorded people: they stand still on the real ground while they bear, and come to rest."""

from functools import cache

import numpy as np
import pytest

import navmesh
from benchmarks.giving_way import floor
from benchmarks.recorded_starts import WAYS, foot_steps
from locomotion.body.traits import SIZE, by_hand
from locomotion.ground.ground import Ground, extruded
from locomotion.recorded.footfalls import BALL, FEET, HEEL
from locomotion.recorded.posing import posed
from locomotion.recorded.skeletons import FULL, LOW, MEDIUM, skeleton
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.people import RecordedPeople
from locomotion.recorded_people.stepping import LAST
from tests.locomotion.recorded_people.test_people import crowd_of, played

STAIRS = [
    (-2.0, 0.0),
    (2.0, 0.0),
    (2.0, 0.17),
    (2.3, 0.17),
    (2.3, 0.34),
    (2.6, 0.34),
    (2.6, 0.51),
    (4.0, 0.51),
]
SLOPE = [*STAIRS, (9.0, -0.49)]


@cache
def level():
    vertices, faces = extruded(SLOPE, 2.0)
    terrain = navmesh.Terrain.from_arrays(vertices, faces)
    return navmesh.NodeGraph.build(terrain), Ground.from_arrays(vertices, faces)


def soles(person):
    """Ends (foot, heel and ball, 3) of the soles of one, of any size."""
    own, pose = skeleton("full"), person.qpos
    bodies = posed(own, pose[None, 7 + own.joints], pose[None, :7])[0]
    out = []
    for name in FEET:
        place = bodies[own.bodies.index(name)]
        w, v = place[3], place[4:]
        out.append(
            [
                place[:3] + np.add(end, 2.0 * np.cross(v, np.cross(v, end) + w * np.array(end)))
                for end in (HEEL, BALL)
            ]
        )
    return pose[:3] + person.row[at.TRAITS][SIZE] * (np.array(out) - pose[:3])


@pytest.mark.parametrize(("detail", "size"), [(FULL, 1.0), (MEDIUM, 1.0), (FULL, 0.88), (MEDIUM, 1.08)])
def test_a_foot_that_bears_stands_still_on_stairs_and_on_a_slope(detail, size):
    graph, ground = level()
    people = RecordedPeople(graph, ground=ground)
    ada = people.add((-1.0, 0.0, 0.0), 0.0, detail, np.random.default_rng(1))
    ada.set_traits(by_hand(ada.row[at.TRAITS], size=size))
    people.lay_feet(ada.index)
    ada.go_to([(8.0, 0.5, -0.29)], 1.2, None)
    ends, stood = [], []
    while ada.status == "walking":
        people.tick()
        if ada.position[0] > 0.5 and ada.walker.left > 1.0:
            ends.append(soles(ada))
            since = (people.rows[0, at.PHASE] - np.array([0.0, 0.5])) % 1.0
            stood.append(np.where(since < 0.5, people.rows[0, at.STEPS].reshape(2, 3, 6)[:, LAST, 0], np.nan))
    ends, stood = np.array(ends), np.array(stood)
    for foot in range(2):
        places = np.unique(stood[np.isfinite(stood[:, foot]), foot])
        assert len(places) > 4
        for x in places:
            path = ends[stood[:, foot] == x, foot]
            on = path[..., 2] < path[..., 2].min(axis=1, keepdims=True) + 0.003
            slides = [np.ptp(path[on[:, end], end, :2], axis=0).max() for end in range(2) if on[:, end].any()]
            assert max(slides) < 0.01
            middle = path[len(path) // 2]
            over = middle[:, 2] - ground.surface_below(middle + np.array([0.0, 0.0, 0.1]))[0]
            assert abs(over.min()) < 0.02


@pytest.mark.parametrize("seed", [1, 2])
def test_feet_of_low_figures_hardly_turn_while_they_bear_on_stairs(seed):
    """Their hips do not turn: a bent leg whose foot stood far inside turned it by up to 30 degrees."""
    graph, ground = level()
    people = RecordedPeople(graph, ground=ground)
    ada = people.add((-1.0, 0.1 * seed, 0.0), 0.0, LOW, np.random.default_rng(seed))
    ada.go_to([(3.8, 0.0, 0.51)], 1.1 + 0.1 * seed, None)
    headings, stood = [], []
    while ada.status == "walking":
        people.tick()
        heel, ball = np.moveaxis(soles(ada), 1, 0)
        headings.append(np.degrees(np.arctan2(*(ball - heel)[:, 1::-1].T)))
        since = (ada.phase - np.array([0.0, 0.5])) % 1.0
        last = people.rows[0, at.STEPS].reshape(2, 3, 6)[:, LAST]
        stood.append(np.where((0.05 < since) & (since < 0.5) & (last[:, 2] > 0.1), last[:, 0], np.nan))
    headings, stood = np.array(headings), np.array(stood)
    for foot in range(2):
        for x in np.unique(stood[np.isfinite(stood[:, foot]), foot]):
            assert np.ptp(headings[stood[:, foot] == x, foot]) < 8.0


def test_low_figures_come_up_stairs_as_full_ones_do():
    graph, ground = level()
    heights = {FULL: [], LOW: []}
    for detail, found in heights.items():
        people = RecordedPeople(graph, ground=ground)
        ada = people.add((0.5, 0.0, 0.0), 0.0, detail, np.random.default_rng(1))
        ada.go_to([(3.5, 0.0, 0.51)], 1.2, None)
        while ada.status == "walking":
            people.tick()
            found.append(ada.qpos[2])
    assert np.abs(np.subtract(heights[FULL], heights[LOW])).max() < 0.02
    assert np.abs(np.diff(heights[LOW])).max() < 0.028  # two stairs at a time
    assert heights[LOW][-1] - heights[LOW][0] == pytest.approx(0.51, abs=0.01)


def test_who_comes_to_rest_puts_the_feet_together_and_stands_still():
    people, (ada,) = crowd_of(1)
    ada.go_to([(5.0, 5.0, 0.0)], 1.4, None)
    played(people, ada, 5.0)
    row = people.rows[0]
    assert ada.status == "arrived" and row[at.GAIT] == -1.0 and row[at.STILL] == 1.0
    feet = row[at.STEPS].reshape(2, 3, 6)[:, LAST]
    assert np.linalg.norm(feet[:, :2] - ada.position[:2], axis=1).max() < 0.25
    poses = played(people, ada, 0.5)
    np.testing.assert_allclose(poses[-1], poses[0], atol=1e-6)


def test_the_pose_is_the_same_however_often_somebody_looks():
    found = []
    for looks in (1, 3, 7):
        people, (ada,) = crowd_of(1)
        ada.go_to([(9.0, 6.0, 0.0)], 1.3, None)
        for tick in range(210):
            people.tick()
            if tick % looks == 0:
                people.transforms(np.array([0]), -0.004)
        found.append(ada.qpos.tobytes())
    assert len(set(found)) == 1


def test_one_who_turns_on_the_spot_takes_steps():
    people, (ada,) = crowd_of(1)
    ada.go_to([(3.0, 5.0, 0.0)], 1.2, 2.5)
    played(people, ada, 4.0)
    assert ada.yaw == pytest.approx(2.5, abs=0.05)
    headings = people.rows[0, at.STEPS].reshape(2, 3, 6)[:, LAST, 3]
    assert np.abs((headings - ada.yaw + np.pi) % (2 * np.pi) - np.pi).max() < 0.4


@pytest.mark.parametrize("detail", [FULL, MEDIUM])
def test_legs_do_not_flip_over_when_people_turn_far_as_they_run_off(detail):
    """Whose foot still points elsewhere in the swing: its leg whirled round within a tick, by a metre."""
    people = RecordedPeople(floor((0.0, 0.0, 60.0, 60.0)))
    everybody = [
        people.add((4.0 + 8 * (k % 7), 4.0 + 8 * (k // 7), 0.0), 0.13 * k, detail, np.random.default_rng(k))
        for k in range(48)
    ]
    each, worst = np.arange(len(everybody)), 0.0
    for order in range(4):
        for k, person in enumerate(everybody):
            way = 2.4 * order + k
            goal = (person.position[:2] + 8.0 * np.array([np.cos(way), np.sin(way)])).clip(1.0, 59.0)
            person.go_to([(*goal, 0.0)], 3.5 if (k + order) % 3 else 1.4, None)
        before = people.transforms(each)
        for _ in range(100):
            people.tick()
            now = people.transforms(each)
            worst = max(worst, np.linalg.norm((now - before)[:, :, :3], axis=2).max())
            before = now
    assert worst < 0.4


@pytest.mark.parametrize("detail", [FULL, MEDIUM, LOW])
@pytest.mark.parametrize("way", WAYS)
def test_who_sets_out_from_a_stand_does_not_jerk_a_foot(detail, way):
    """Feet that began in the middle of a swing jumped by 0.3 m between two frames."""
    assert 0.02 < foot_steps(detail, way, 1.3, 41).max() < 0.13


def test_who_sets_out_has_both_feet_on_the_ground_and_not_all_take_up_the_same():
    people, everybody = crowd_of(16)
    first = np.full(16, np.nan)
    for k, person in enumerate(everybody):
        person.go_to([(2.0 + k, 5.0 + (-1.0) ** k, 0.0)], 1.3, None)
    for _ in range(60):
        people.tick()
        begin = np.isnan(first) & (people.rows[:, at.GAIT] >= 0.0)
        first[begin] = people.rows[begin, at.PHASE]
    assert (first % 0.5 < 0.05).all()
    assert {0, 1} == set((2.0 * first).astype(int).tolist()) and len(np.unique(first)) == 16
