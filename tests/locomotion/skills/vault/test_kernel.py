"""The vault: clip, law against the reference, mirror image, hand, and vaults over walls."""

import numpy as np
import pytest

from locomotion.body.arm_reach import ARM_START, hand_place
from locomotion.body.hand_hold import holding
from locomotion.body.person import CONTROL_DT, JOINT_NAMES, STANDING_HEIGHT
from locomotion.errors import LocomotionError
from locomotion.gaits.run import controller
from locomotion.gaits.run.skill import load_run_skill, run_clip
from locomotion.human.human import Human
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.skills.jump.skill import run_digest
from locomotion.skills.kernel import AHEAD_X, AHEAD_Y, EDGE_X, EDGE_Y, MIRROR, MIRROR_SIGN, mirror
from locomotion.skills.vault import kernel as vault
from locomotion.skills.vault.reference import wanted_offset
from locomotion.skills.vault.skill import Vault, load_vault_skill, tables_of, vault_clip

PART = vault.parameter_slices()


@pytest.fixture(scope="module")
def run():
    return load_run_skill()


def random_tables(run, seed, reaches=False):
    rng = np.random.default_rng(seed)
    parameters = 0.2 * rng.normal(size=sum(vault.PARAMETERS.values()))
    parameters[PART["beta"]] += 1.0
    parameters[PART["arm"]] = [0.1 if reaches else 2.0, 0.5, 0.05, 0.2, 0.3, 0.1, 0.1, 0.05]
    return tables_of(parameters, rng.normal(size=(vault.STEPS, vault.BINS, vault.SENSORS)), run)


def random_state(rng, step, side):
    state = controller.new_state()
    state[:] = rng.normal(size=len(state))
    state[controller.STANCE], state[controller.PHASE] = side, rng.uniform(0.2, 1.0)
    state[controller.SPEED], state[controller.STEPS] = rng.uniform(2.5, 4.0), 10.0 + step
    state[controller.HEADING] = 0.0
    return state


def fresh_memory(step, side):
    """Of a vault in its step ``step`` with the stance foot on ``side``."""
    memory = np.zeros(vault.MEMORY_SIZE)
    memory[vault.ACTIVE], memory[vault.FIRST_STEP], memory[vault.LAST_STEP] = 1.0, 10.0, step
    memory[vault.ERROR_DISTANCE], memory[vault.ERROR_SPEED] = 0.1, -0.2
    memory[vault.SIDE] = side if step == 1 else -side
    memory[[EDGE_X, EDGE_Y, AHEAD_X, AHEAD_Y]] = 0.0, 0.0, 1.0, 0.0
    memory[vault.TOP], memory[vault.DEPTH] = 0.8, 0.3
    return memory


def standing(side):
    """A person with its arm of ``side`` stretched forward and down, (46,)."""
    qpos = np.zeros(46)
    qpos[2], qpos[3] = STANDING_HEIGHT, 1.0
    arm = 7 + ARM_START[int(side > 0)]
    qpos[arm], qpos[arm + 3] = 0.6, 0.4
    return qpos


@pytest.mark.parametrize("step", range(vault.STEPS))
@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("phase", range(vault.PHASES))
def test_kernel_agrees_with_the_reference(run, step, side, phase):
    rng = np.random.default_rng(step)
    tables, state, memory = random_tables(run, 7), random_state(rng, step, side), fresh_memory(step, side)
    memory[vault.PHASE] = max(phase, 2.0 * (step > 1))
    before, ctrl = state.copy(), np.zeros(len(JOINT_NAMES))
    vault.vault_tick(tables.parameters, *tables.rest, memory, state, standing(side), ctrl)
    wanted, beta = wanted_offset(tables, memory, before)
    share = 1.0 - np.exp(-CONTROL_DT / 0.02)
    np.testing.assert_allclose(ctrl, share * wanted, atol=1e-9)
    step_time = np.interp(before[controller.SPEED], tables.rest[0], tables.rest[1])
    moved = min(before[controller.PHASE] + (beta - 1.0) * CONTROL_DT / step_time, 1.0)
    assert state[controller.PHASE] == pytest.approx(moved)


@pytest.mark.parametrize("step", range(vault.STEPS))
def test_a_vault_from_the_other_foot_is_the_mirror_image(run, step):
    rng = np.random.default_rng(step)
    tables = random_tables(run, 3, reaches=True)
    left = random_state(rng, step, 1.0)
    right = left.copy()
    right[controller.STANCE] = -1.0
    com, feet = left[controller.COM], left[controller.FEET].reshape(2, 3)
    right[controller.COM] = com * [1, -1, 1]
    right[controller.FEET] = (feet[::-1] * [1, -1, 1]).ravel()
    targets = []
    for state, side in ((left, 1.0), (right, -1.0)):
        memory, ctrl = fresh_memory(step, side), np.zeros(len(JOINT_NAMES))
        for _ in range(3):
            state[controller.PHASE] = 0.5
            qpos = standing(memory[vault.SIDE])
            vault.vault_tick(tables.parameters, *tables.rest, memory, state, qpos, ctrl)
        targets.append(ctrl)
    np.testing.assert_allclose(mirror(targets[0]), targets[1], atol=1e-12)


def test_an_idle_vault_changes_nothing(run):
    tables, state, memory = random_tables(run, 1), controller.new_state(), np.zeros(vault.MEMORY_SIZE)
    before, ctrl = state.copy(), np.zeros(len(JOINT_NAMES))
    vault.vault_tick(tables.parameters, *tables.rest, memory, state, standing(1.0), ctrl)
    np.testing.assert_array_equal(state, before)
    assert not ctrl.any()


def tick_hand(tables, memory, qpos, com_x, phase=0.5):
    """A tick in the flight, with the centre of mass at ``com_x``; returns the targets."""
    state = controller.new_state()
    state[controller.STANCE], state[controller.STEPS] = memory[vault.SIDE], 11.0
    state[controller.PHASE], state[controller.SPEED] = phase, 3.3
    state[controller.COM] = com_x, 0.0, 1.0
    ctrl = np.zeros(len(JOINT_NAMES))
    vault.vault_tick(tables.parameters, *tables.rest, memory, state, qpos, ctrl)
    return ctrl


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_the_hand_holds_where_it_touches_the_top_until_the_body_has_passed(run, side):
    tables, memory = random_tables(run, 5, reaches=True), fresh_memory(1, side)
    qpos = standing(side)
    qpos[0] = -0.3
    hand = hand_place(qpos, side)
    assert 0.0 < hand[0] < 0.3
    memory[vault.TOP] = hand[2] - 0.05  # not yet
    for _ in range(3):
        tick_hand(tables, memory, qpos, -0.3)
    assert memory[vault.HOLD] == 0.0
    memory[vault.TOP] = hand[2] - 0.03
    tick_hand(tables, memory, qpos, -0.3)
    assert memory[vault.HOLD] == 1.0
    np.testing.assert_allclose(memory[vault.ANCHOR], hand)
    tick_hand(tables, memory, qpos, hand[0] - 0.01)
    assert memory[vault.HOLD] == 1.0 and memory[vault.PHASE] == 0.0
    tick_hand(tables, memory, qpos, hand[0] + 0.01)
    assert memory[vault.HOLD] == 2.0 and memory[vault.PHASE] == 1.0


@pytest.mark.parametrize("into", [-0.02, 0.32])
def test_beside_the_top_the_hand_does_not_hold(run, into):
    tables, memory = random_tables(run, 5, reaches=True), fresh_memory(1, 1.0)
    qpos = standing(1.0)
    hand = hand_place(qpos, 1.0)
    memory[vault.TOP] = hand[2] - 0.03
    qpos[0] = into - hand[0]
    for _ in range(3):
        tick_hand(tables, memory, qpos, -0.3)
    assert memory[vault.HOLD] == 0.0


def test_the_hand_lets_go_of_what_it_can_reach_no_longer(run):
    tables, memory = random_tables(run, 5, reaches=True), fresh_memory(1, 1.0)
    qpos = standing(1.0)
    qpos[0] = -0.3
    memory[vault.TOP] = hand_place(qpos, 1.0)[2] - 0.03
    for _ in range(3):
        tick_hand(tables, memory, qpos, -0.3)
    assert memory[vault.HOLD] == 1.0
    qpos[2] += 0.3
    tick_hand(tables, memory, qpos, -0.3)
    assert memory[vault.HOLD] == 2.0


def test_the_arm_reaches_for_the_top(run):
    tables, memory = random_tables(run, 5, reaches=True), fresh_memory(1, 1.0)
    qpos = standing(1.0)
    qpos[0], memory[vault.TOP] = -0.3, 0.9
    for _ in range(30):
        arm = tick_hand(tables, memory, qpos, -0.4)[ARM_START[1] : ARM_START[1] + 4]
    qpos[7 + ARM_START[1] : 11 + ARM_START[1]] = arm
    hand = hand_place(qpos, 1.0)
    assert hand[2] == pytest.approx(0.9, abs=0.04)
    assert hand[0] == pytest.approx(0.15, abs=0.02)  # the middle of the top


def test_lying_over_the_wall_is_no_fall_but_lying_on_the_floor_is(run):
    memory, state = fresh_memory(1, 1.0), controller.new_state()
    state[controller.FALLEN], state[controller.COM] = 1.0, (0.0, 0.0, 0.9)
    assert not vault.vault_fell(memory, state)
    state[controller.COM] = 0.0, 0.0, 0.4
    assert vault.vault_fell(memory, state)
    memory[vault.LAST_STEP] = 2.0
    state[controller.COM] = 0.0, 0.0, 0.9
    assert vault.vault_fell(memory, state)


def test_clip_begins_and_ends_like_the_run():
    shares = np.array([0.0, 1.0])
    legs = [i for i, name in enumerate(JOINT_NAMES) if name.endswith(("hip_flexion", "knee_flexion"))]
    difference = vault_clip().sample(shares) - run_clip().sample(shares)
    assert np.abs(difference[:, legs]).max() < np.deg2rad(6)


def test_clip_tucks_both_legs_and_stretches_the_arm():
    angles = np.rad2deg(vault_clip().sample(np.linspace(0, 0.5, 41)))
    for side in ("right", "left"):
        assert angles[:, JOINT_NAMES.index(f"{side}_hip_flexion")].max() > 75
        assert angles[:, JOINT_NAMES.index(f"{side}_knee_flexion")].max() > 100
    assert angles[:, JOINT_NAMES.index("right_elbow_flexion")].min() < 20


def test_mirror_tables():
    assert (MIRROR[MIRROR] == np.arange(len(JOINT_NAMES))).all()
    assert (MIRROR_SIGN[MIRROR] == MIRROR_SIGN).all()


def test_the_vault_belongs_to_the_run(run):
    assert load_vault_skill().run == run_digest(run), "the run has changed: surefoot train vault --replace"


def test_it_takes_off_nearer_to_thicker_walls(run):
    assert vault.nearer(0.1) == vault.nearer(0.3) == 0.0
    shift = vault.nearer(0.6)
    assert 0.1 < shift < 0.2  # about half of what the wall is thicker
    skill, state = Vault(load_vault_skill(), run), controller.new_state()
    marks = [skill.approach(0.7, depth)[1] for depth in (0.3, 0.6)]
    assert marks[1] == pytest.approx(marks[0] - shift)
    state[controller.STANCE] = 1.0
    for depth, mark in zip((0.3, 0.6), marks, strict=True):  # the left foot stands 2 cm short of the mark
        edge = np.array([mark + 0.02, 0.0, 0.7])
        memory = skill.start(ObstacleAhead(0.0, "vault", 0.7, edge, np.array([-1.0, 0.0, 0.0]), depth), state)
        assert memory[vault.ERROR_DISTANCE] == pytest.approx(0.02)


@pytest.mark.parametrize("joint", [False, True])
def test_a_joint_holds_the_hand_only_if_it_is_asked_for(run, joint):
    human = Human(None, clearing=())
    skill, memory = Vault(load_vault_skill(), run), fresh_memory(1, 1.0)
    assert not skill.joint
    skill.joint, human.data.qpos[:] = joint, standing(1.0)
    human.data.qpos[0], memory[vault.REACH] = -0.3, 1.0
    memory[vault.TOP] = hand_place(human.data.qpos, 1.0)[2] - 0.03
    state = controller.new_state()
    state[controller.STANCE], state[controller.STEPS] = 1.0, 11.0
    state[controller.PHASE], state[controller.SPEED] = 0.5, 3.3
    state[controller.COM] = -0.3, 0.0, 1.0
    wall = ObstacleAhead(0.0, "vault", 0.7, np.zeros(3), np.array([-1.0, 0.0, 0.0]), 0.3)
    skill.tick(wall, memory, state, human.data)
    assert memory[vault.HOLD] == 1.0 and holding(human.data, 1.0) is joint


def test_entry_and_mark_are_plausible(run):
    skill = Vault(load_vault_skill(), run)
    entry, mark = skill.approach(0.7)
    assert run.speeds[0] <= entry <= run.speeds[1]
    assert 1.0 < mark < 3.5
    assert skill.heights[0] <= 0.6


def test_round_trip(tmp_path):
    skill = load_vault_skill()
    skill.save(tmp_path / "vault.npz")
    again = load_vault_skill(tmp_path / "vault.npz")
    np.testing.assert_array_equal(again.table, skill.table)
    np.testing.assert_array_equal(again.references, skill.references)
    assert again.meta == skill.meta and again.stride == skill.stride


def test_a_truncated_file_is_refused(tmp_path):
    load_vault_skill().save(tmp_path / "vault.npz")
    (tmp_path / "vault.npz").write_bytes((tmp_path / "vault.npz").read_bytes()[:2000])
    with pytest.raises(LocomotionError, match="cut off or damaged"):
        load_vault_skill(tmp_path / "vault.npz")
