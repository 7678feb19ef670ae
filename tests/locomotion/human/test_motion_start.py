"""Persons set in motion go on as those did that were in that motion."""

import math

import numpy as np
import pytest

from locomotion.human.human import Human
from locomotion.human.motion_start import moment_like, moments, moments_at, set_in_motion

YAW, ROOT = 2.0, np.array([5.0, -3.0])


def gone_on(moment, root, yaw, ticks):
    """Poses (ticks, 46), with the path straight on."""
    human = Human(None, clearing=(), rehearsals=0)
    set_in_motion(human, moment, root, 0.0, yaw)
    ahead = np.array([math.cos(yaw), math.sin(yaw), 0.0])
    human.follow(np.array([human.position, human.position + 30.0 * ahead]), moment.asked)
    poses = []
    for _ in range(ticks):
        human.tick()
        poses.append(human.qpos)
    return np.array(poses), human


@pytest.mark.parametrize("runs", [False, True])
def test_it_does_the_same_elsewhere_and_in_another_direction(runs):
    human = Human(None, clearing=(), rehearsals=0)
    moment = moments_at(human, runs, 3.2 if runs else 0.8)[20]
    here, _ = gone_on(moment, moment.qpos[:2], 0.0, 20)
    there, _ = gone_on(moment, ROOT, YAW, 20)
    np.testing.assert_allclose(there[:6, 7:], here[:6, 7:], atol=1e-6)
    np.testing.assert_allclose(there[:, 7:], here[:, 7:], atol=0.02)  # contacts magnify the last bits
    turn = np.array([[math.cos(YAW), -math.sin(YAW)], [math.sin(YAW), math.cos(YAW)]])
    np.testing.assert_allclose(there[:, :2], ROOT + (here[:, :2] - moment.qpos[:2]) @ turn.T, atol=1e-3)


@pytest.mark.parametrize("runs", [False, True])
def test_it_keeps_going_from_the_moment_that_is_most_like_it(runs):
    alike = [each for each in moments() if each.runs == runs]
    wanted = alike[len(alike) // 2]
    moment = moment_like(runs, wanted.speed, wanted.qpos, wanted.qvel[6:])
    assert moment is wanted and moment_like(runs, 9.0, wanted.qpos, wanted.qvel[6:]) is None
    poses, human = gone_on(moment, ROOT, YAW, 150)
    assert human.status == ("running" if moment.runs else "walking")
    gone = np.linalg.norm(poses[-1, :2] - poses[0, :2]) / 1.49
    assert gone == pytest.approx(moment.speed, abs=0.25)
