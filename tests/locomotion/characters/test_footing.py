"""Feet of characters that stand stay where they are, though the person's pivot; in the air they go back."""

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from locomotion import Footing, LocomotionError
from locomotion.body.person import BODY_NAMES
from tests.locomotion.characters.persons import plane, postures
from tests.locomotion.characters.test_posing import sole

STEP = 1.0 / 60.0


def turned(place, about, angle):
    """The bodies (20, 7), turned about the vertical through a point."""
    turn = Rotation.from_euler("z", angle)
    return np.concatenate([
        turn.apply(place[:, :3] - about) + about,
        (turn * Rotation.from_quat(place[:, 3:], scalar_first=True)).as_quat(scalar_first=True),
    ], axis=1)  # fmt: skip


def pivoting():
    """(40, 20, 7): someone turns by 23 degrees on the ball of the right foot, and is then lifted 0.3 m high
    within a third of a second and held there."""
    place = postures()["stand"]
    ball = place[BODY_NAMES.index("right_toes"), :3]
    places = [turned(place, ball, 0.4 * k / 30) for k in range(31)]
    lift = np.concatenate([np.linspace(0.015, 0.3, 20), np.full(40, 0.3)])
    return np.array(places + [places[-1] + np.array([0, 0, up, 0, 0, 0, 0]) for up in lift])


def motion(rig, places, **others):
    return rig.pose_motion(places, STEP * np.arange(len(places)), ground=plane(), **others)


@pytest.mark.parametrize("who", ["stout", "tall", "agent"])
def test_a_foot_on_which_the_person_pivots_stays_where_it_is(rigs, who):
    rig, places = rigs[who], pivoting()
    alone, held = rig.pose_from(places, ground=plane()), motion(rig, places)
    np.testing.assert_array_equal(held[0], alone[0])

    def moved(poses):
        first = sole(rig, poses[0], "right")
        touching = first[:, 2] < 0.002
        return np.abs(sole(rig, poses[30], "right") - first)[touching].max()

    assert moved(alone) > 0.02
    assert moved(held) < 0.002


@pytest.mark.parametrize("who", ["stout", "tall", "agent"])
def test_in_the_air_it_goes_back_without_a_jerk(rigs, who):
    rig, places = rigs[who], pivoting()
    alone, held = rig.pose_from(places, ground=plane()), motion(rig, places)
    np.testing.assert_allclose(held[-1], alone[-1], atol=1e-3)
    foot = rig.names.index(rig.parts["right_foot"])
    turns = Rotation.from_quat(held[:, foot, 3:], scalar_first=True)
    assert np.degrees((turns[1:] * turns[:-1].inv()).magnitude()).max() < 5.0


def test_a_motion_in_parts_is_the_same_to_the_bit(rigs):
    rig, places, footing = rigs["tall"], pivoting(), Footing()
    whole = motion(rig, places)
    times = STEP * np.arange(len(places))
    cuts = [0, 1, 2, 17, 17, 40, len(places)]
    parts = [
        rig.pose_motion(places[a:b], times[a:b], ground=plane(), footing=footing) for a, b in pairwise(cuts)
    ]
    np.testing.assert_array_equal(np.concatenate(parts), whole)


def test_a_foot_that_slides_fast_or_ground_that_is_not_known_holds_nothing(rigs):
    rig = rigs["agent"]
    place = postures()["stand"]
    sliding = np.array([place + np.array([0.05 * k, 0, 0, 0, 0, 0, 0]) for k in range(10)])
    np.testing.assert_allclose(motion(rig, sliding), rig.pose_from(sliding, ground=plane()), atol=1e-9)
    places = pivoting()
    np.testing.assert_array_equal(
        rig.pose_motion(places, STEP * np.arange(len(places))), rig.pose_from(places)
    )


def test_a_rig_remembers_the_feet_of_each_agent_until_time_leaps(rigs):
    rig, places = rigs["stout"], pivoting()

    class Somebody:
        time, ground, held = 0.0, plane(), ("", "stowed")
        pose: SimpleNamespace

        def at(self, k, time):
            self.time, self.pose = time, SimpleNamespace(names=BODY_NAMES, transforms=places[k])
            return self

    one, other, alone = Somebody(), Somebody(), rig.pose_from(places, ground=plane())
    found = [rig.pose(one.at(k, k * STEP)) for k in range(31)]
    np.testing.assert_array_equal(found, motion(rig, places)[:31])
    np.testing.assert_array_equal(rig.pose(one.at(30, 30 * STEP)), found[-1])  # asked for again
    np.testing.assert_array_equal(rig.pose(other.at(30, 30 * STEP)), alone[30])
    np.testing.assert_array_equal(rig.pose(one.at(30, 29 * STEP)), alone[30])  # the world was restored
    np.testing.assert_array_equal(rig.pose(one.at(20, 2.0)), alone[20])


def test_what_is_no_motion_is_refused(rigs):
    rig, places = rigs["stout"], pivoting()[:3]
    with pytest.raises(LocomotionError, match=r"times \(2,\); give \(t, 20, 7\) and \(t,\)"):
        rig.pose_motion(places, [0.0, 1.0])
    with pytest.raises(LocomotionError, match=r"places have the shape \(20, 7\)"):
        rig.pose_motion(places[0], [0.0])
    for times in ([0.0, 2.0, 1.0], [0.0, np.nan, 1.0]):
        with pytest.raises(LocomotionError, match=r"finite numbers \[s\] that do not decrease"):
            rig.pose_motion(places, times)
