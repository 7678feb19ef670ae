"""What is observed of a body, number by number, against MuJoCo."""

import mujoco
import numpy as np
import pytest

from locomotion.body import observed as seen
from locomotion.body.person import CONTROL_DT, STEPS_PER_TICK, PersonIndex, build_person
from locomotion.gaits.run.controller import new_state, observe
from locomotion.gaits.run.layout import FALLEN, OBSERVED


def test_each_number_is_what_mujoco_says():
    model = build_person()
    data, index, state = mujoco.MjData(model), PersonIndex.of(model), new_state()
    data.qpos[1], data.qvel[:3] = 0.3, (0.5, -0.2, 0.0)
    data.qpos[3:7] = np.cos(0.1), np.sin(0.1), 0.0, 0.0  # leaning: the feet carry unequal shares
    force = np.empty(6)
    landed = 0
    before = None
    for _ in range(12):
        mujoco.mj_step(model, data, STEPS_PER_TICK)
        observe(index, model, data, state)
        numbers = state[OBSERVED]
        assert numbers.shape == (seen.OBSERVED_SIZE,)
        com = data.subtree_com[index.root].copy()
        assert np.array_equal(numbers[seen.COM], com)
        if before is not None:
            assert numbers[seen.COM_VELOCITY] == pytest.approx((com - before) / CONTROL_DT)
        before = com
        assert np.array_equal(numbers[seen.FEET], data.xpos[index.feet].ravel())
        wanted = {1: 0.0, -1: 0.0}
        for k in range(data.ncon):
            mujoco.mj_contactForce(model, data, k, force)
            side = int(index.geom_side[data.contact.geom[k]].sum())
            wanted[side] += force[0]
        assert numbers[seen.CONTACT] == pytest.approx([wanted[-1], wanted[1]])
        landed += wanted[-1] != wanted[1]
        for part, first in ((seen.COM, seen.COM_X), (seen.COM_VELOCITY, seen.VELOCITY_X)):
            assert np.array_equal(numbers[part], numbers[first : first + 3])
        assert np.array_equal(numbers[seen.LEFT_FOOT : seen.LEFT_FOOT + 3], data.xpos[index.feet[1]])
        assert numbers[seen.LEFT_CONTACT] == pytest.approx(wanted[1])
    assert landed > 3 and not state[FALLEN]
