"""The jump: clip, law against the reference, mirror image, interpolation, files, and jumps onto stairs."""

import dataclasses

import mujoco
import numpy as np
import pytest

from locomotion.body.person import CONTROL_DT, JOINT_NAMES
from locomotion.errors import LocomotionError
from locomotion.gaits.run import controller
from locomotion.gaits.run.skill import load_run_skill, run_clip
from locomotion.skills.jump import kernel as jump
from locomotion.skills.jump.reference import wanted_offset
from locomotion.skills.jump.skill import Jump, jump_clip, load_jump_skill, run_digest, tables_of


@pytest.fixture(scope="module")
def run():
    return load_run_skill()


@pytest.fixture(scope="module")
def skill():
    return load_jump_skill()


def random_tables(run, seed):
    rng = np.random.default_rng(seed)
    width = sum(jump.PARAMETERS.values())
    parameters = 0.2 * rng.normal(size=width)
    parameters[jump.parameter_slices()["beta"]] += 1.0
    return tables_of(parameters, rng.normal(size=(jump.STEPS, jump.BINS, jump.SENSORS)), run)


def random_state(rng, step, side):
    state = controller.new_state()
    state[:] = rng.normal(size=len(state))
    state[controller.STANCE], state[controller.PHASE] = side, rng.uniform(0.0, 1.0)
    state[controller.SPEED], state[controller.STEPS] = rng.uniform(2.5, 4.0), 10.0 + step
    state[controller.HEADING] = 0.0
    return state


@pytest.mark.parametrize("step", range(jump.STEPS))
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_kernel_agrees_with_the_reference(run, step, side):
    rng = np.random.default_rng(step)
    tables = random_tables(run, 7)
    state, memory = random_state(rng, step, side), np.zeros(jump.MEMORY_SIZE)
    memory[jump.ACTIVE], memory[jump.FIRST_STEP], memory[jump.LAST_STEP] = 1.0, 10.0, step
    memory[jump.ERROR_DISTANCE], memory[jump.ERROR_SPEED] = 0.1, -0.2
    before, ctrl = state.copy(), np.zeros(len(JOINT_NAMES))
    jump.jump_tick(tables.parameters, *tables.rest, memory, state, ctrl)
    wanted, beta = wanted_offset(tables, memory, before)
    share = 1.0 - np.exp(-CONTROL_DT / 0.02)
    np.testing.assert_allclose(ctrl, share * wanted, atol=1e-9)
    step_time = np.interp(before[controller.SPEED], tables.rest[0], tables.rest[1])
    phase = min(before[controller.PHASE] + (beta - 1.0) * CONTROL_DT / step_time, 1.0)
    assert state[controller.PHASE] == pytest.approx(phase)


@pytest.mark.parametrize("step", range(jump.STEPS))
def test_a_jump_from_the_other_foot_is_the_mirror_image(run, step):
    rng = np.random.default_rng(step)
    tables = random_tables(run, 3)
    left = random_state(rng, step, 1.0)
    right = left.copy()
    right[controller.STANCE] = -1.0
    com, feet = left[controller.COM], left[controller.FEET].reshape(2, 3)
    right[controller.COM] = com * [1, -1, 1]
    right[controller.FEET] = (feet[::-1] * [1, -1, 1]).ravel()
    offsets = []
    for state in (left, right):
        memory, ctrl = np.zeros(jump.MEMORY_SIZE), np.zeros(len(JOINT_NAMES))
        memory[jump.ACTIVE], memory[jump.FIRST_STEP], memory[jump.LAST_STEP] = 1.0, 10.0, step
        jump.jump_tick(tables.parameters, *tables.rest, memory, state, ctrl)
        offsets.append(ctrl)
    np.testing.assert_allclose(jump.mirror(offsets[0]), offsets[1], atol=1e-12)


def test_an_idle_jump_changes_nothing(run):
    tables, state = random_tables(run, 1), controller.new_state()
    before, ctrl = state.copy(), np.zeros(len(JOINT_NAMES))
    jump.jump_tick(tables.parameters, *tables.rest, np.zeros(jump.MEMORY_SIZE), state, ctrl)
    np.testing.assert_array_equal(state, before)
    assert not ctrl.any()


def test_clip_begins_and_ends_like_the_run():
    shares = np.array([0.0, 1.0])
    legs = [i for i, name in enumerate(JOINT_NAMES) if name.endswith(("hip_flexion", "knee_flexion"))]
    difference = jump_clip().sample(shares) - run_clip().sample(shares)
    assert np.abs(difference[:, legs]).max() < np.deg2rad(6)


def test_clip_lifts_both_knees():
    angles = np.rad2deg(jump_clip().sample(np.linspace(0, 1, 41)))
    assert angles[:, JOINT_NAMES.index("left_hip_flexion")].max() > 80
    assert angles[:, JOINT_NAMES.index("right_knee_flexion")].max() > 100


def test_learned_heights_are_met_and_between_them_lines(skill):
    for k, height in enumerate(skill.heights):
        np.testing.assert_allclose(skill.at(height)[0], skill.table[k], atol=1e-9)
    middle, _ = skill.at(0.5 * (skill.heights[0] + skill.heights[1]))
    np.testing.assert_allclose(middle, 0.5 * (skill.table[0] + skill.table[1]), atol=1e-9)


@pytest.mark.parametrize("height", [0.05, 0.8, np.nan])
def test_heights_that_were_not_learned_are_refused(skill, height):
    with pytest.raises(LocomotionError, match="was not learned"):
        skill.at(height)


def test_the_jump_belongs_to_the_run(run, skill):
    assert skill.run == run_digest(run), "the run has changed"


def test_whatever_heading_is_asked_for_it_goes_straight_at_the_obstacle(run):
    rng, ahead = np.random.default_rng(2), 0.4
    tables, memory, ctrl = random_tables(run, 5), np.zeros(jump.MEMORY_SIZE), np.zeros(len(JOINT_NAMES))
    state = random_state(rng, 0, -1.0)
    jump.start_jump(tables.parameters, memory, state, 2.0, 1.0, np.cos(ahead), np.sin(ahead))
    state[controller.HEADING], state[controller.TURN_RATE] = 0.7, 1.5
    jump.jump_tick(tables.parameters, *tables.rest, memory, state, ctrl)
    assert state[controller.HEADING] == pytest.approx(ahead)
    assert state[controller.TURN_RATE] == 0.0


def test_entry_and_mark_are_plausible(run, skill):
    entry, mark = Jump(skill, run).approach(0.4)
    assert run.speeds[0] <= entry <= run.speeds[1]
    assert 1.0 < mark < 3.5


def test_round_trip(tmp_path, skill):
    skill.save(tmp_path / "jump.npz")
    again = load_jump_skill(tmp_path / "jump.npz")
    for field in dataclasses.fields(skill):
        np.testing.assert_array_equal(getattr(again, field.name), getattr(skill, field.name))


def test_missing(tmp_path):
    with pytest.raises(LocomotionError, match="no such file"):
        load_jump_skill(tmp_path / "none.npz")


def test_truncated(tmp_path, skill):
    path = tmp_path / "jump.npz"
    skill.save(path)
    path.write_bytes(path.read_bytes()[:2000])
    with pytest.raises(LocomotionError, match="cut off or damaged"):
        load_jump_skill(path)


@pytest.mark.parametrize(
    "change, message",
    [
        (lambda skill: dict(table=skill.table[:, :5]), "expected 243 on axis 1"),
        (lambda skill: dict(table=np.nan * skill.table), "expected a finite number"),
        (lambda skill: dict(heights=skill.heights[::-1]), "heights does not increase"),
    ],
)
def test_contents_that_do_not_fit(tmp_path, skill, change, message):
    dataclasses.replace(skill, **change(skill)).save(tmp_path / "jump.npz")
    with pytest.raises(LocomotionError, match=message):
        load_jump_skill(tmp_path / "jump.npz")


def test_of_another_person(tmp_path, skill, monkeypatch):
    monkeypatch.setattr("locomotion.skills.skill_file.person_digest", lambda: "another")
    skill.save(tmp_path / "jump.npz")
    monkeypatch.undo()
    with pytest.raises(LocomotionError, match="another person"):
        load_jump_skill(tmp_path / "jump.npz")


def test_the_stair_of_a_trial_is_where_it_was_put():
    from locomotion.training.skills.jump_trial import JumpSimulator

    simulator = JumpSimulator(load_run_skill())
    simulator.place(3.0, 0.4)
    mujoco.mj_forward(simulator.model, simulator.data)
    hit = np.zeros(1, np.int32)
    for x, height in ((2.99, 0.0), (3.01, 0.4)):
        above, down = np.array([x, 2.0, 5.0]), np.array([0.0, 0.0, -1.0])
        distance = mujoco.mj_ray(simulator.model, simulator.data, above, down, None, 1, -1, hit)
        assert 5.0 - distance == pytest.approx(height, abs=1e-9)
