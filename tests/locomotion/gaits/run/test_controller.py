"""The running controller: the kernel against its reference, determinism, saving, running."""

import dataclasses
import hashlib

import mujoco
import numpy as np
import pytest

from locomotion.body.person import CONTROL_DT, MASS, STEPS_PER_TICK, PersonIndex, build_person
from locomotion.gaits.run import controller as c
from locomotion.gaits.run import reference as slow
from locomotion.gaits.run.layout import (
    BLEND,
    LAST_TARGET,
    PARAMETERS,
    STATE_SIZE,
    new_state,
    parameter_slices,
)
from locomotion.gaits.run.skill import RunSkill, load_run_skill, reset_running


class Runner:
    """A person on a plane under the committed skill."""

    def __init__(self, speed: float = 3.5, yaw: float = 0.0) -> None:
        self.skill: RunSkill = load_run_skill()
        self.model = build_person()
        self.data = mujoco.MjData(self.model)
        self.index = PersonIndex.of(self.model)
        self.state = c.new_state()
        self.command = np.array([yaw, speed, 0.0])
        reset_running(self.skill, self.model, self.data, self.index, self.state, np.zeros(3), yaw, speed)

    def control(self) -> None:
        c.run_tick(
            *self.skill.tables, self.state, self.command, self.data.qpos, self.data.qvel, self.data.ctrl
        )

    def tick(self, count: int = 1) -> None:
        for _ in range(count):
            self.control()
            mujoco.mj_step(self.model, self.data, STEPS_PER_TICK)
            c.observe(self.index, self.model, self.data, self.state)

    def hash(self) -> str:
        return hashlib.sha256(
            self.data.qpos.tobytes() + self.data.qvel.tobytes() + self.state.tobytes()
        ).hexdigest()


@pytest.fixture
def runner() -> Runner:
    return Runner()


def test_the_parts_of_a_memory_and_of_the_parameters_lie_side_by_side() -> None:
    parts = [c.OBSERVED, c.PLANTED, c.COM_AT_SWITCH, c.SENSOR_VALUES, BLEND, LAST_TARGET]
    ends = [c.STEP_SPEED + 2, *(part.stop for part in parts)]  # one number is free
    assert [part.start for part in parts] == ends[:-1] and ends[-1] == STATE_SIZE == len(new_state())
    slices = parameter_slices()
    assert [part.start for part in slices.values()] == [0, *(part.stop for part in slices.values())][:-1]
    assert list(slices.values())[-1].stop == sum(PARAMETERS.values()) == load_run_skill().table.shape[1]


def test_kernel_equals_reference() -> None:
    rng = np.random.default_rng(3)
    runner = Runner()
    table = runner.skill.table + rng.normal(size=runner.skill.table.shape) * 0.01
    runner.skill = dataclasses.replace(runner.skill, table=table)
    compared = 0
    for tick in range(300):
        runner.command[:] = [0.4 * np.sin(tick / 60), 3.5 + 0.8 * np.sin(tick / 90), 0.2 * np.sin(tick / 40)]
        runner.state[c.SLOPE] = rng.uniform(-0.2, 0.2)
        qpos, qvel = runner.data.qpos.copy(), runner.data.qvel.copy()
        slope = runner.state[c.SLOPE]
        runner.control()
        if runner.state[c.SLOPE] == slope:
            sensed = slow.sensors(runner.state, runner.command[2], qpos, qvel)
            wanted = slow.pd_targets(runner.skill, runner.state, sensed, qpos)
            blend = runner.state[BLEND]  # what is left of the jump at the last switch
            np.testing.assert_allclose(runner.data.ctrl, wanted + blend, atol=1e-9)
            compared += 1
        mujoco.mj_step(runner.model, runner.data, STEPS_PER_TICK)
        c.observe(runner.index, runner.model, runner.data, runner.state)
    assert compared > 200


def test_left_stance_mirrors_right_stance(runner: Runner) -> None:
    """A mirrored situation gives mirrored targets."""
    from locomotion.body.person import JOINT_NAMES

    runner.tick(70)
    other = Runner()
    swap = [
        JOINT_NAMES.index(n.replace("right_", "L_").replace("left_", "right_").replace("L_", "left_"))
        for n in JOINT_NAMES
    ]
    odd = np.array(
        [
            -1.0
            if n in ("waist_roll", "waist_yaw", "chest_roll", "chest_yaw", "neck_roll", "neck_yaw")
            else 1.0
            for n in JOINT_NAMES
        ]
    )
    other.data.qpos[:] = runner.data.qpos * np.concatenate([[1, -1, 1, 1, -1, 1, -1], np.ones(39)])
    other.data.qpos[7:] = runner.data.qpos[7:][swap] * odd
    other.data.qvel[:6] = runner.data.qvel[:6] * [1, -1, 1, -1, 1, -1]
    other.data.qvel[6:] = runner.data.qvel[6:][swap] * odd
    state = runner.state.copy()
    for name in ("COM", "COM_VELOCITY"):
        state[getattr(c, name)] *= [1, -1, 1]
    for name in ("FEET", "PLANTED"):
        state[getattr(c, name)] = (runner.state[getattr(c, name)].reshape(2, 3)[::-1] * [1, -1, 1]).ravel()
    state[c.CONTACT] = runner.state[c.CONTACT][::-1]
    for field in (c.STANCE, c.HEADING, c.TURN_RATE):
        state[field] *= -1
    for part in (BLEND, LAST_TARGET):
        state[part] = runner.state[part][swap] * odd
    other.state[:] = state
    runner.control()
    other.control()
    np.testing.assert_allclose(other.data.ctrl, runner.data.ctrl[swap] * odd, atol=1e-9)


def test_same_start_same_hash() -> None:
    hashes = []
    for _ in range(2):
        runner = Runner(3.2, 0.7)
        runner.tick(150)
        hashes.append(runner.hash())
    assert hashes[0] == hashes[1]


def test_saved_and_restored_runs_on_bit_for_bit(runner: Runner) -> None:
    kind = mujoco.mjtState.mjSTATE_INTEGRATION
    runner.tick(83)
    saved = np.empty(mujoco.mj_stateSize(runner.model, kind))
    mujoco.mj_getState(runner.model, runner.data, saved, kind)
    state = runner.state.copy()
    runner.tick(60)
    expected = runner.hash()
    runner.tick(17)
    mujoco.mj_setState(runner.model, runner.data, saved, kind)
    runner.state[:] = state
    runner.tick(60)
    assert runner.hash() == expected


@pytest.mark.parametrize("speed", [2.6, 3.5, 4.2, 4.6, 5.0])
def test_runs_at_the_speed_that_is_asked_for(speed: float) -> None:
    runner = Runner(speed)
    runner.tick(200)
    start = runner.state[c.COM].copy()
    runner.tick(600)
    assert runner.state[c.FALLEN] == 0.0
    moved = runner.state[c.COM] - start
    assert moved[0] / 6.0 == pytest.approx(speed, abs=0.35)
    assert abs(moved[1]) < 1.5


@pytest.mark.parametrize("speed", [2.75, 3.0, 3.25, 3.5, 3.75, 4.0])
def test_lands_softly(speed: float) -> None:
    runner = Runner(speed)
    runner.tick(200)
    highest = 0.0
    for _ in range(800):
        runner.tick()
        highest = max(highest, float(runner.state[c.CONTACT].sum()) / (MASS * 9.81))
    assert 2.0 < highest <= 3.5  # body weights


def test_turns_left_and_right(runner: Runner) -> None:
    for direction in (1.0, -1.0):
        runner = Runner()
        runner.tick(100)
        for _ in range(300):
            runner.command[0] += direction * 0.3 * CONTROL_DT
            runner.tick()
        velocity = runner.state[c.COM_VELOCITY]
        assert runner.state[c.FALLEN] == 0.0
        assert np.arctan2(velocity[1], velocity[0]) == pytest.approx(direction * 0.9, abs=0.25)


def test_survives_a_push_from_the_side(runner: Runner) -> None:
    runner.tick(150)
    runner.data.xfrc_applied[runner.index.chest, 1] = 200.0
    runner.tick(10)
    runner.data.xfrc_applied[:] = 0.0
    runner.tick(500)
    assert runner.state[c.FALLEN] == 0.0


def test_a_dropped_person_counts_as_fallen(runner: Runner) -> None:
    runner.data.qpos[3:7] = [np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0]
    for _ in range(100):
        mujoco.mj_step(runner.model, runner.data, STEPS_PER_TICK)
        c.observe(runner.index, runner.model, runner.data, runner.state)
    assert runner.state[c.FALLEN] == 1.0
