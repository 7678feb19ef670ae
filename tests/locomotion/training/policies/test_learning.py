"""Learning goes on from a checkpoint as if it had not been interrupted, and comes from the seed alone."""

from dataclasses import replace
from functools import partial

import mujoco
import numpy as np

from locomotion.gaits.policy import law
from locomotion.gaits.policy.law import LIFT_OFF
from locomotion.gaits.policy.layout import (
    ACTIONS,
    ARM_SWING,
    CHANGE,
    HEADING,
    JOINTS,
    LAG_AHEAD,
    PHASE,
    SOLES,
    SPEED,
    SPREAD,
    STYLE,
    SWINGING,
    TRUNK_LEAN,
    TURN_RATE,
)  # fmt: skip
from locomotion.gaits.policy.layout import RUNNING as GOES_ON
from locomotion.training.policies.curriculum import RUNNING, STANDING, WALKING
from locomotion.training.policies.environment import Environment
from locomotion.training.policies.learning import LENGTH, Learning

PEOPLE = 6


def stages():
    """Two stages of two improvements each, with all that is random in an environment."""
    short = {"samples": 2 * LENGTH * PEOPLE, "longest": 20}
    return replace(WALKING[0], **short), replace(WALKING[2], **short)


def learning(reference, **options):
    people = partial(Environment, reference, stages()[0], PEOPLE)
    return Learning(people, stages(), on_progress=lambda _: None, **options)


def same(one, other):
    return all(
        np.array_equal(a, b) for a, b in zip(one.arrays().values(), other.arrays().values(), strict=True)
    )


def test_an_interrupted_learning_ends_with_the_same_bits(reference, tmp_path):
    whole = learning(reference).run()
    for _ in range(5):
        last = learning(reference, checkpoint=tmp_path / "walk.npz").run(most=1)
    assert same(last, whole)


def test_another_seed_learns_otherwise(reference):
    assert not same(learning(reference).run(most=1), learning(reference, seed=1).run(most=1))


def test_the_reference_alone_walks_a_few_steps(reference):
    """Nobody who follows it without a policy falls at once."""
    environment = Environment(reference, replace(WALKING[0], speeds=(1.25, 1.25)), 32, seed=0)
    fell = np.zeros(32, bool)
    for _ in range(8):
        fell |= environment.step(np.zeros((32, ACTIONS))).fell
    assert fell.mean() < 0.2


def test_pushes_push_and_orders_change(reference):
    stage = replace(WALKING[2], push=300.0)
    environment = Environment(reference, stage, 64, seed=0)
    begun = environment.asked.copy()
    pushed = False
    for _ in range(30):
        outcome = environment.step(np.zeros((64, ACTIONS)))
        pushed |= bool((environment.pushed > 0).any())
        environment.reset(outcome.fell | outcome.over)
    assert pushed
    assert (environment.asked != begun).any()
    assert environment.seen().angles.shape == (64, len(JOINTS))


def test_orders_that_do_not_change_stay(reference):
    environment = Environment(reference, replace(WALKING[2], changes=0.0), 8, seed=0)
    begun = environment.asked.copy()
    for _ in range(30):
        environment.step(np.zeros((8, ACTIONS)))
    assert (environment.asked == begun).all()


def test_a_fall_costs_what_the_stage_says(both):
    stage = replace(RUNNING[0], speeds=(3.0, 3.0), from_starts=0.0)
    free, dear = (Environment(both, replace(stage, fall=fall), 32, seed=0) for fall in (0.0, 40.0))
    fell = 0
    for _ in range(40):
        one, other = (each.step(np.zeros((32, ACTIONS))) for each in (free, dear))
        assert (one.fell == other.fell).all()
        np.testing.assert_allclose(one.reward - other.reward, 40.0 * one.fell)
        fell += one.fell.sum()
        free.reset(one.fell)
        dear.reset(other.fell)
    assert fell


def test_a_runner_is_shown_a_pose_that_leans_as_its_speed_changes(both):
    environment = Environment(both, replace(RUNNING[0], speeds=(3.0, 3.0), from_starts=0.0), 4, seed=0)
    nothing = np.zeros((4, 4)), environment.soles, np.zeros((4, ACTIONS))
    upright = environment.moment(*nothing).up[:, 0]
    environment.memory[:, CHANGE] = 2.0
    leans = environment.moment(*nothing).up[:, 0] - upright
    np.testing.assert_allclose(leans, 0.5 * np.arctan2(2.0, 9.81), rtol=0.05)


def test_a_runners_speed_is_off_that_told_whatever_pose_is_shown(both):
    environment = Environment(both, replace(RUNNING[0], speeds=(3.0, 3.0), from_starts=0.0), 4, seed=0)
    nothing = np.zeros((4, 4)), environment.soles, np.zeros((4, ACTIONS))
    as_told = environment.moment(*nothing).velocity[:, 0]
    environment.memory[:, LAG_AHEAD] = -1.0
    np.testing.assert_allclose(environment.moment(*nothing).velocity[:, 0], as_told, atol=0.3)


def test_who_turns_as_told_spins_as_the_reference(reference):
    environment = Environment(reference, replace(WALKING[2], stand=0.0), 8, 3)
    nothing = np.zeros((8, 1, 4)), environment.soles, np.zeros((8, ACTIONS))
    environment.memory[:, TURN_RATE] = 0.0
    straight = environment.moment(*nothing).spin
    turn = np.linspace(-1.0, 1.0, 8)
    environment.memory[:, TURN_RATE] = turn
    environment.qvel[:, 5] += turn
    np.testing.assert_allclose(environment.moment(*nothing).spin, straight)
    environment.qvel[:, 5] -= turn
    np.testing.assert_allclose(environment.moment(*nothing).spin[:, 2], straight[:, 2] - turn)


def decides_nothing(seen):
    return np.zeros((len(seen), ACTIONS))


def test_a_stand_is_over_for_who_has_to_step(reference):
    environment = Environment(reference, replace(STANDING[0], push=0.0, slope=0.0), 40, seed=0)
    environment.qvel[:20, 0] = 1.0
    environment.qvel[20:] = 0.0
    outcome = environment.step(decides_nothing(environment.observe()))
    assert outcome.fell[:20].all()
    assert not outcome.fell[20:].any()


def test_whom_a_push_throws_off_a_stand_steps_with_the_foot_that_bears_less(reference):
    stage = replace(WALKING[2], speeds=(0.0, 0.0), stand=1.0)
    environment = Environment(reference, stage, 400, seed=1)
    fast = np.linalg.norm(environment.qvel[:, :2], axis=1)
    begins = np.isin(environment.memory[:, PHASE], (LIFT_OFF, LIFT_OFF + 0.5))
    assert 0.05 < begins.mean() < 0.3
    assert fast[begins].mean() > 0.4
    leftward = environment.qvel[:, 1] > 0.3
    assert (environment.memory[begins & leftward, PHASE] == LIFT_OFF + 0.5).all()


def test_some_move_in_a_style_of_their_own(reference):
    stage = replace(WALKING[-1], traits=0.5, from_starts=0.0)
    styles = Environment(reference, stage, 400, seed=2).memory[:, STYLE]
    differ = (styles != 0.0).all(axis=1)
    assert 0.4 < differ.mean() < 0.6
    assert (styles[~differ] == 0.0).all()
    np.testing.assert_allclose(styles[differ].mean(axis=0), 0.0, atol=0.05)
    assert (styles[differ].std(axis=0) > [0.02, 0.2, 0.01, 0.03, 0.05]).all()


def test_who_moves_in_its_own_style_is_as_the_reference(reference):
    """Pose, rates and feet are off by nothing, though the style has moved them."""
    stage = replace(WALKING[1], speeds=(1.25, 1.25), turn=0.0, push=0.0, slope=0.0)
    environment = Environment(reference, stage, 8, seed=0)
    memory, figure = environment.memory, environment.figure
    memory[:, TURN_RATE] = memory[:, HEADING] = 0.0
    usual = environment.motion.at(memory[:, PHASE], memory[:, SPEED], memory[:, GOES_ON])
    memory[:, [ARM_SWING, SPREAD, TRUNK_LEAN]] = 0.3, 0.04, 0.05
    joints = law.styled(memory, usual.read(reference.joints), usual.read_rows(environment.motion.means))
    rates = usual.read(reference.rates)
    rates[:, SWINGING] *= 1.3
    data = mujoco.MjData(environment.model)
    for i in range(8):
        environment.qpos[i, figure.angles], environment.qvel[i, figure.rates] = joints[i], rates[i]
        data.qpos[:] = environment.qpos[i]
        mujoco.mj_kinematics(environment.model, data)
        environment.sensed[i, SOLES] = data.site_xpos[figure.soles].ravel()
    moment = environment.moment(np.zeros((8, 1, 4)), environment.soles, np.zeros((8, ACTIONS)))
    np.testing.assert_allclose(moment.angles, 0.0, atol=1e-9)
    np.testing.assert_allclose(moment.rates, 0.0, atol=1e-9)
    assert np.abs(moment.feet[:, :, 1]).max() < 0.015  # of 0.035 m that each foot is farther aside
