"""Each term of the reward, in cases that can be worked out by hand."""

from dataclasses import replace

import numpy as np
import pytest

from locomotion.gaits.policy.layout import (
    ACTION,
    ACTIONS,
    BODY_WEIGHT,
    FAST,
    HEADING,
    JOINTS,
    LAG_AHEAD,
    POLICY_DT,
    STATE_SIZE,
)
from locomotion.training.policies.rewards import LIKENESS, TERMS, WEIGHTS, Moment, rewards, sway_off, total


@pytest.fixture
def same() -> Moment:
    """One person who is exactly as the reference and bears on nothing."""
    n, soles = len(JOINTS), np.zeros((1, 6, 3))
    soles[0, 3:, 1] = 0.1
    return Moment(
        angles=np.zeros((1, n)), rates=np.zeros((1, n)), feet=np.zeros((1, 4, 3)), up=np.zeros((1, 2)),
        yaw=np.zeros(1), spin=np.zeros((1, 3)), height=np.zeros(1), velocity=np.zeros((1, 3)),
        forces=np.zeros((1, 4, 4)), soles=soles, soles_before=soles.copy(),
        loads=np.zeros((1, 2)), memory=np.zeros((1, STATE_SIZE)), decided_before=np.zeros((1, ACTIONS)),
    )  # fmt: skip


def test_who_is_as_the_reference_gets_all_and_pays_nothing(same):
    terms = rewards(same)
    assert tuple(terms) == TERMS
    costs = {"change", "effort", "pace", "impact", "blow", "slip", "brush"}
    assert all((weight <= 0.0) == (name in costs) for name, weight in WEIGHTS.items() if weight)
    assert {name for name in TERMS if terms[name][0] == 0.0} == costs
    assert {name for name in TERMS if terms[name][0] == 1.0} == set(TERMS) - costs
    assert total(terms, {})[0] == pytest.approx(sum(w for w in WEIGHTS.values() if w > 0))
    assert total(terms, {"pose": 2.0})[0] - total(terms, {})[0] == pytest.approx(2.0 - WEIGHTS["pose"])


def test_a_knee_that_is_off(same):
    angles = same.angles.copy()
    knee = JOINTS.index("right_knee_flexion")
    angles[0, knee] = 0.3
    assert rewards(replace(same, angles=angles))["pose"][0] == pytest.approx(
        np.exp(-2.0 * LIKENESS[knee] * 0.09)
    )
    assert sway_off(angles)[0] == pytest.approx(0.09)


def test_a_hip_aside_counts_more_than_any_other_joint():
    assert LIKENESS.max() == LIKENESS[JOINTS.index("left_hip_abduction")] == 6.0


def test_a_lag_of_the_speed_and_a_height(same):
    memory = same.memory.copy()
    memory[0, LAG_AHEAD] = 0.1
    terms = rewards(replace(same, memory=memory))
    assert terms["speed"][0] == pytest.approx(np.exp(-0.25))
    assert terms["nears"][0] == pytest.approx(np.exp(-0.0375))
    assert terms["catches"][0] == pytest.approx(1.0 / 1.025)
    assert rewards(replace(same, height=np.array([0.05])))["root"][0] == pytest.approx(np.exp(-0.3))


def test_an_impact_above_one_and_a_half_body_weights(same):
    forces = same.forces.copy()
    forces[0, 2, :2] = 1.2 * BODY_WEIGHT  # 2.4 under the right foot, in one step
    forces[0, 3, 2] = 1.4 * BODY_WEIGHT
    assert rewards(replace(same, forces=forces))["impact"][0] == pytest.approx(0.9**2)


def test_both_feet_together_above_one_and_two_fifths_of_the_weight(same):
    forces = same.forces.copy()
    forces[0, 2, [0, 2]] = 1.0 * BODY_WEIGHT  # a body weight under each foot, in one step
    terms = rewards(replace(same, forces=forces))
    assert terms["blow"][0] == pytest.approx(0.6**2)
    assert terms["impact"][0] == 0.0


def test_who_runs_may_land_harder(same):
    forces, memory = same.forces.copy(), same.memory.copy()
    forces[0, 2, :2], memory[0, FAST] = 1.6 * BODY_WEIGHT, 1.0
    assert rewards(replace(same, forces=forces, memory=memory))["impact"][0] == pytest.approx(0.9**2)


def test_a_foot_that_slips_over_its_lowest_point(same):
    soles, forces = same.soles.copy(), same.forces.copy()
    soles[0, :, 2] = 0.03, 0.01, 0.002, 0.0, 0.0, 0.0
    soles[0, 2, 0] = 0.2 * POLICY_DT  # the right tip, while the heel and the ball come off
    soles[0, 0, 0] = 0.9 * POLICY_DT
    forces[0, :, 1] = 0.25 * BODY_WEIGHT
    assert rewards(replace(same, soles=soles, forces=forces))["slip"][0] == pytest.approx(0.2 * np.tanh(3.0))


def test_what_each_foot_should_bear(same):
    forces = same.forces.copy()
    forces[0, :, 0] = forces[0, :, 1] = 0.4 * BODY_WEIGHT  # the right foot, with its toes
    loads = np.array([[1.0, 0.3]])
    found = rewards(replace(same, forces=forces, loads=loads))["load"][0]
    assert found == pytest.approx(np.exp(-2.0 * (0.2**2 + 0.3**2)))


def test_decisions_and_another_pace(same):
    memory = same.memory.copy()
    memory[0, ACTION] = 0.5
    terms = rewards(replace(same, memory=memory))
    assert terms["change"][0] == terms["effort"][0] == pytest.approx(0.25)
    assert terms["pace"][0] == pytest.approx(0.2**2)


@pytest.mark.parametrize(
    ("ahead", "aside", "brushes"), [(0.1, 0.034, 0.6), (0.1, -0.05, 1.0), (0.3, 0.0, 0.0)]
)
def test_a_foot_that_passes_too_near_to_the_other_leg(same, ahead, aside, brushes):
    heading, soles, memory = 0.7, np.zeros((1, 6, 3)), same.memory.copy()
    c, s = np.cos(heading), np.sin(heading)
    soles[0, 3:, :2] = c * ahead - s * aside, s * ahead + c * aside
    memory[0, HEADING] = heading
    found = rewards(replace(same, soles=soles, memory=memory))["brush"][0]
    assert found == pytest.approx(brushes)
