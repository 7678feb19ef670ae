"""What a person at rest does."""

import numpy as np
import pytest

from locomotion.body.person import JOINT_NAMES
from locomotion.gaits.policy.skill import load_policy
from locomotion.human.human import Human
from locomotion.human.idle import idle_pose

ANGLES = np.linspace(-0.1, 0.1, len(JOINT_NAMES))
TIMES = np.arange(0.0, 120.0, 0.01)


def poses(habit):
    return np.array([idle_pose(ANGLES, seconds, habit) for seconds in TIMES])


@pytest.mark.parametrize("habit", [0.0, 0.3137, 1.0])
def test_it_moves_smoothly_and_only_above_the_pelvis(habit):
    found = poses(habit)
    np.testing.assert_array_equal(found[TIMES < 1.0], np.tile(ANGLES, ((TIMES < 1.0).sum(), 1)))
    legs = [k for k, name in enumerate(JOINT_NAMES) if name.split("_")[1] in ("hip", "knee", "ankle", "toe")]
    assert len(legs) >= 14
    assert (found[:, legs] == ANGLES[legs]).all()
    steps = np.abs(np.diff(found, axis=0)).max(axis=0)
    assert steps.max() < 0.03, "3 rad/s"
    assert np.abs(found - ANGLES).max() < 0.7


def test_it_breathes_fifteen_times_a_minute_and_looks_about():
    found = poses(0.4) - ANGLES
    breath = found[TIMES > 4.0, JOINT_NAMES.index("right_clavicle_elevation")]
    breaths = (np.diff(np.sign(breath)) > 0).sum() / (TIMES[-1] - 4.0)
    assert 0.2 < breaths < 0.3
    head = found[:, JOINT_NAMES.index("neck_yaw")]
    assert head.max() > 0.1 and head.min() < -0.1


def test_no_two_are_in_step():
    one, other = poses(0.2), poses(0.21)
    neck = JOINT_NAMES.index("neck_yaw")
    assert np.corrcoef(one[TIMES > 3.0, neck], other[TIMES > 3.0, neck])[0, 1] < 0.5


def test_one_that_is_at_rest_is_not_simulated_but_moves_and_sets_off_from_how_it_was_seen():
    human = Human(None, clearing=(), rehearsals=0, policy=load_policy())
    human.reset((0.0, 0.0, 0.0), 0.0)
    human.habit = 0.6
    for _ in range(400):
        human.tick()
    assert human.held
    before, seen = human.qpos, []
    for _ in range(600):
        human.tick()
        seen.append(human.pose())
    np.testing.assert_array_equal(human.qpos, before)
    assert np.ptp(seen, axis=0).max() > 0.05
    human.follow([[0, 0, 0], [6, 0, 0]], 1.2)
    np.testing.assert_array_equal(human.qpos, seen[-1])
    while human.status == "walking":
        seen.append(human.pose())
        human.tick()
    assert np.abs(np.diff(seen, axis=0))[598:610, 7:].max() < 0.04
    assert human.status == "arrived"
