"""A tick of the learned walk in a kernel is the same as its plain Python, bit for bit."""

import numpy as np
import pytest

from locomotion.body.person import JOINT_NAMES
from locomotion.gaits.policy import layout as at
from locomotion.gaits.policy.skill import load_policy
from locomotion.gaits.walk.layout import WALK_STEPS, WALK_TICKS
from locomotion.human.human import Human
from locomotion.human.learned_tick import TICKS, decide_and_walk_on, walk_on


def walker(heading=0.4, speed=1.3, seconds=2.0):
    human = Human(None, clearing=(), rehearsals=0, policy=load_policy())
    human.reset((0.0, 0.0, 0.0), 0.0)
    human.follow([[0, 0, 0], [9 * np.cos(heading), 9 * np.sin(heading), 0]], speed)
    while human.time < seconds or human.on_feet.learned_memory[TICKS] % at.TICKS_PER_DECISION:
        human.tick()
    return human


def ticked(human, decide, go_on, command, ticks=2):
    """Memory, what others read, and targets after some ticks without physics, in one array."""
    learned, data = human.on_feet.learned, human.data
    memory, walk, ctrl = learned.memory.copy(), human.on_feet.walk.copy(), data.ctrl.copy()
    for _ in range(ticks):
        if memory[TICKS] % at.TICKS_PER_DECISION == 0.0:
            ground = human.simulation.lookup
            decide(ground, *learned.skill.tables, memory, command, walk, data.qpos, data.qvel, ctrl)
        else:
            go_on(memory, command, walk, data.qpos, ctrl)
    return np.concatenate([memory, walk, ctrl])


@pytest.mark.parametrize("seconds", [0.1, 0.9, 2.0, 3.3])
@pytest.mark.parametrize("asks", [(0.4, 1.3, 0.1), (-2.9, 0.1, 0.0), (0.9, 4.0, -0.2), (0.45, 0.0, 0.0)])
def test_it_is_the_same_as_its_plain_python(seconds, asks):
    human = walker(seconds=seconds)
    command = np.array([*asks, 0.0])
    fast = ticked(human, decide_and_walk_on, walk_on, command, 12)
    slow = ticked(human, decide_and_walk_on.py_func, walk_on.py_func, command, 12)
    assert np.array_equal(fast, slow, equal_nan=True)


def test_between_two_decisions_only_clock_and_head_go_on():
    human = walker()
    memory, walk, ctrl = human.on_feet.learned_memory, human.on_feet.walk, human.data.ctrl
    before = memory.copy(), walk.copy(), ctrl.copy()
    walk_on(memory, np.array([2.0, 1.0, 0.0, 0.0]), walk, human.data.qpos, ctrl)
    assert np.flatnonzero(memory != before[0]).tolist() == [TICKS]
    assert walk[WALK_TICKS] == before[1][WALK_TICKS] + 1.0 and walk[WALK_STEPS] == before[1][WALK_STEPS]
    assert [JOINT_NAMES[k] for k in np.flatnonzero(ctrl != before[2])] == ["neck_yaw"]
