"""Trials of the roll off a ledge."""

import mujoco
import numpy as np
import pytest

from locomotion.gaits.run.skill import load_run_skill
from locomotion.skills.drop_roll import kernel as drop_roll
from locomotion.skills.drop_roll.skill import DropRoll, load_drop_roll_skill
from locomotion.training.skills.drop_trial import DropSimulator
from locomotion.training.skills.jump_trial import JumpSimulator


@pytest.fixture(scope="module")
def simulator():
    return DropSimulator(load_run_skill())


@pytest.fixture(scope="module")
def skill():
    return DropRoll(load_drop_roll_skill())


@pytest.fixture(scope="module")
def start(skill):
    rng = np.random.default_rng(1)
    return JumpSimulator(load_run_skill()).harvest(skill, np.array([9.0]), rng, False)[0]


def test_the_ledge_ends_where_it_was_put(simulator):
    simulator.place(3.0, 1.2)
    mujoco.mj_resetData(simulator.model, simulator.data)
    simulator.data.qpos[0] = -50.0
    mujoco.mj_forward(simulator.model, simulator.data)
    hit = np.zeros(1, np.int32)
    for x, height in ((2.99, 0.0), (3.01, -1.2)):
        above, down = np.array([x, 2.0, 5.0]), np.array([0.0, 0.0, -1.0])
        distance = mujoco.mj_ray(simulator.model, simulator.data, above, down, None, 1, -1, hit)
        assert 5.0 - distance == pytest.approx(height, abs=1e-9)


def test_a_learned_roll_turns_over_comes_up_and_repeats_bit_for_bit(simulator, skill, start):
    tables = skill.tables(1.2)
    record = np.zeros((drop_roll.BINS, len(drop_roll.SENSORS) + 1))
    first = simulator.trial(tables, 1.2, start, 0.0, 4.0, record=record)
    assert first.rolled and first.rose and first.time == 1.0
    assert first.angle > 5.0 and first.upright > 0.8 and 2.0 < first.entry < 5.0
    assert first.peak > 2.0 and abs(first.low) < 0.3
    assert (record[:-1, -1] > 0.0).all()  # sensors were seen until the roll ended
    again = simulator.trial(tables, 1.2, start, 0.0, 4.0)
    assert again.angle == first.angle and np.array_equal(again.momentum, first.momentum)


def test_a_trial_without_the_rise_ends_where_the_roll_does(simulator, skill, start):
    ended = simulator.trial(skill.tables(1.2), 1.2, start, 0.0, 4.0, rise=False)
    assert ended.time < 0.7 and not ended.rolled and ended.angle > 5.0


def test_a_roll_that_never_comes_up_is_none(simulator, skill, start):
    tables = skill.tables(1.2)
    never = tables.parameters.copy()
    never[drop_roll.parameter_slices()["rise"].start] = 20.0
    outcome = simulator.trial(
        type(tables)(never, tables.entry, tables.mark, tables.rest), 1.2, start, 0.0, 4.0
    )
    assert not outcome.rolled and not outcome.rose
