"""Turning the head uphill while lying on the front."""

import math

import mujoco
import numpy as np
import pytest

from locomotion import Human
from locomotion.body.person import STEPS_PER_TICK
from locomotion.recovery.getting_up import lies_on_front
from locomotion.recovery.layout import MODE_CLOCK, SEEN_COM
from locomotion.recovery.pivoting import ROUND, SPREAD, begin_round, off_uphill, pivot
from tests.locomotion.recovery.falling import plane


def lie_down(human: Human, slope: float, off: float) -> None:
    """Let it lie on its front on ground that rises by ``slope`` towards x, uphill ``off`` [rad] to its
    left."""
    data, lean = human.data, math.atan(slope)
    mujoco.mj_resetData(human.model, data)
    front, turned, tilted, once = np.empty(4), np.empty(4), np.empty(4), np.empty(4)
    mujoco.mju_axisAngle2Quat(front, np.array([0.0, 1.0, 0.0]), 0.5 * math.pi)
    mujoco.mju_axisAngle2Quat(turned, np.array([0.0, 0.0, 1.0]), -off)
    mujoco.mju_axisAngle2Quat(tilted, np.array([0.0, 1.0, 0.0]), -lean)
    mujoco.mju_mulQuat(once, turned, front)
    mujoco.mju_mulQuat(data.qpos[3:7], tilted, once)
    data.qpos[:3] = 0.2 * np.array([-math.sin(lean), 0.0, math.cos(lean)])
    data.qpos[7:] = data.ctrl[:] = SPREAD
    human.fours.fall(data)
    advance(human, 100)


def advance(human: Human, ticks: int) -> None:
    for _ in range(ticks):
        mujoco.mj_step(human.fours.model, human.data, STEPS_PER_TICK)
        human.fours.observe(human.simulation.lookup, human.data, human.observed)


@pytest.mark.parametrize("slope", [0.5, 0.7, 0.9])
@pytest.mark.parametrize("degrees", [-150, -90, -50, 50, 90, 150])
def test_comes_to_lie_head_uphill_on_its_front(slope, degrees):
    human = Human(plane(slope), clearing=(), gets_up=True)
    lookup, memory = human.simulation.lookup, human.fours.memory
    lie_down(human, slope, math.radians(degrees))
    assert off_uphill(lookup, memory) == pytest.approx(math.radians(degrees), abs=0.25)
    begun, rounds = memory[SEEN_COM].copy(), 0
    while abs(off := off_uphill(lookup, memory)) > 0.6 and rounds < 4:
        begin_round(memory, off)
        for tick in range(round(100 * ROUND)):
            memory[MODE_CLOCK] = 0.01 * tick
            pivot(memory, human.data.ctrl)
            advance(human, 1)
        rounds += 1
    assert 1 <= rounds <= 3
    assert lies_on_front(lookup, memory)[0] < -0.9
    assert np.linalg.norm(memory[SEEN_COM] - begun) < 0.7
