"""Whether a person has lost its balance."""

import math

import mujoco
import numpy as np

from locomotion import Human
from locomotion.body.observed import COM_Z, LEFT_FOOT, RIGHT_FOOT
from locomotion.body_events import Fell
from locomotion.gaits.policy.skill import load_policy
from locomotion.human.balance import loses_balance
from tests.locomotion.recovery.falling import push_over


def _lost(tilt: float, rate: float, height: float, towards: float) -> bool:
    """Whether a stiff person whose centre of mass is ``height`` [m] above its feet has lost its balance, that
    leans by ``tilt`` [deg] and tips at ``rate`` [rad/s]."""
    human = Human(None, clearing=())
    human.reset((0, 0, 0), 0.0)
    data, axis, half = (
        human.data,
        np.array([-math.sin(towards), math.cos(towards), 0.0]),
        math.radians(tilt / 2),
    )
    data.qpos[3:7] = [math.cos(half), *(math.sin(half) * axis)]
    data.qvel[3:6] = rate * axis  # in its own frame, too: it turns about this axis
    mujoco.mj_forward(human.model, data)
    human.observed[COM_Z] = human.observed[[RIGHT_FOOT + 2, LEFT_FOOT + 2]].min() + height
    return loses_balance(human.index, data, human.observed)


def test_it_has_when_it_tips_over_and_is_low_already():
    for towards in np.linspace(0.0, 2.0 * math.pi, 7):
        assert _lost(50.0, 4.0, 0.55, towards)
        assert not _lost(50.0, 4.0, 0.8, towards), "it lands behind an obstacle"
        assert not _lost(50.0, -4.0, 0.55, towards), "it comes up"
        assert not _lost(20.0, 1.0, 0.55, towards), "it crouches"
        assert _lost(75.0, 0.0, 0.55, towards)


def test_it_has_when_it_sinks():
    human = Human(None, clearing=())
    human.reset((0, 0, 0), 0.0)
    observed = human.observed.copy()
    assert not loses_balance(human.index, human.data, observed)
    observed[5] = -2.0
    assert not loses_balance(human.index, human.data, observed)
    observed[5] = -6.0
    assert loses_balance(human.index, human.data, observed)


def test_a_fall_is_noticed_before_one_of_which_nobody_gets_up():
    """Training and rehearsals wait until it has happened."""
    noticed = []
    for gets_up in (True, False):
        human = Human(None, clearing=(), gets_up=gets_up)
        push_over(human, 2.0, 1.2)
        while not any(isinstance(event, Fell) for event in human.events):
            human.tick()
        noticed.append(human.time)
    assert noticed[0] < noticed[1]


def test_who_catches_itself_has_not_lost_its_balance():
    human = Human(None, clearing=(), policy=load_policy())
    for side in np.linspace(0.0, 2.0 * math.pi, 6, endpoint=False):
        human.reset((0, 0, 0), 0.0)
        human.events.clear()
        human.follow([[x, 0.0, 0.0] for x in range(40)], 1.25)
        for _ in range(400):
            human.tick()
        human.push((200.0 * math.cos(side), 200.0 * math.sin(side), 0.0), 0.1)
        for _ in range(300):
            human.tick()
        assert not any(isinstance(event, Fell) for event in human.events)
