"""Trials that vaults are learned on: they repeat, begin near the mark, and rank good vaults before bad."""

from dataclasses import replace

import numpy as np
import pytest

from locomotion.errors import LocomotionError
from locomotion.gaits.run.skill import load_run_skill
from locomotion.skills.skill_file import SkillFamily
from locomotion.skills.vault import kernel as vault
from locomotion.skills.vault.skill import KIND, Vault, tables_of
from locomotion.training.search.loop import Stage
from locomotion.training.skills.vault import (
    VaultProblem,
    changed,
    cost,
    curriculum,
    first_guess,
    higher,
    scales,
    train_vault,
)
from locomotion.training.skills.vault_trial import VaultOutcome, VaultSimulator
from locomotion.training.training import Training

GOOD = VaultOutcome(
    cleared=True, time=1.0, shortfall=0.0, scrape=0, missed=0.0, planted=0.5, held=15, impulse=60.0, steps=3,
    speed=3.3, drift=0.0, reaction=0.0, effort=8.0, trunk=0.02, yaw=0.01, headlong=0.0, sunk=0.0, pose=0.05,
    errors=(0.0, 0.0),
)  # fmt: skip


@pytest.fixture(scope="module")
def simulator():
    return VaultSimulator(load_run_skill())


@pytest.fixture(scope="module")
def family():
    reference = np.zeros((1, vault.STEPS * vault.BINS, vault.SENSORS))
    return SkillFamily(KIND, np.array([0.6]), first_guess()[None], reference, (0.17, 0.09, 0.39), "")


@pytest.fixture(scope="module")
def states(simulator, family):
    rng = np.random.default_rng(1)
    return simulator.harvest(Vault(family, simulator.run), rng.uniform(8.0, 12.0, 3), rng)


@pytest.fixture
def tables(simulator):
    reference = np.zeros((vault.STEPS, vault.BINS, vault.SENSORS))
    return tables_of(first_guess(), reference, simulator.run)


def test_states_are_harvested_near_the_mark(states):
    assert states
    assert all(abs(state.error) < 0.3 for state in states)


def test_a_trial_repeats(simulator, states, tables):
    trials = [
        simulator.vault_trial(tables, (0.6, 0.3), states[0], states[0].error, 1.5, record=record)
        for record in (np.zeros((4, 6, 19)), np.zeros((4, 6, 19)))
    ]
    assert repr(trials[0]) == repr(trials[1])


def test_no_wall_is_touched_where_none_is_high_enough(simulator, states, tables):
    outcome = simulator.vault_trial(tables, (-1.0, 0.3), states[0], states[0].error, 1.0)
    assert outcome.scrape == 0 and outcome.held == 0 and outcome.shortfall == 0.0


def test_running_into_a_high_wall_is_seen(simulator, states, tables):
    outcome = simulator.vault_trial(tables, (1.6, 0.3), states[0], states[0].error, 1.5)
    assert outcome.scrape > 0 and not outcome.cleared and outcome.shortfall > 0.5


@pytest.mark.parametrize("solid", [True, False])
def test_a_wall_that_is_not_solid_is_seen_to_be_touched_and_lets_through(simulator, states, tables, solid):
    start, way = states[0], []
    outcome = simulator.vault_trial(
        tables, (1.6, 0.3), start, start.error, 1.5, on_tick=lambda s: way.append(s.data.qpos[0]), solid=solid
    )
    edge = start.planted[0] + tables.mark + start.error
    assert outcome.scrape > 0
    assert (max(way) > edge + 0.3) is not solid


@pytest.mark.parametrize(
    "worse",
    [
        dict(cleared=False), dict(time=0.6), dict(shortfall=0.2), dict(scrape=3), dict(held=2),
        dict(impulse=5.0), dict(planted=0.9), dict(held=0, missed=0.3, planted=np.nan), dict(speed=1.0),
        dict(drift=0.8), dict(pose=0.4), dict(trunk=0.4),
        dict(yaw=0.3), dict(headlong=0.5), dict(sunk=0.2),
    ],
)  # fmt: skip
def test_worse_vaults_cost_more(worse):
    assert cost(replace(GOOD, **worse), 3.3) > cost(GOOD, 3.3) + 0.3


def test_scales_free_more_from_stage_to_stage():
    free = [scales(what) > 0 for what in ("feed-forward", "feedback")]
    assert (free[0] <= free[1]).all()
    counts = [int(each.sum()) for each in free]
    assert counts[0] < counts[1]
    assert not free[1][vault.parameter_slices()["entry"]].any()


def test_curriculum_reaches_every_height_with_feedback():
    stages = curriculum(Training())
    assert [stage.options["solid"] for stage in stages] == [False] * 2 + [True] * (len(stages) - 2)
    assert stages[-1].options["heights"][1] > stages[0].options["heights"][1]
    assert (stages[-1].scale[vault.parameter_slices()["gains"]] > 0).all()


def stage_of(same, **options):
    shared = {"heights": (0.6, 0.8), "states": 2, "error": 0.1, "duration": 1.0, "pull": 0.1, "same": same}
    shared |= {"failed": 0.0, "refines": False, "solid": True, "pose": 3.0, "beginnings": 1}
    return Stage("test", 10, 0.1, scales("feedback"), {**shared, **options}, 4)


def test_scenarios_stay_the_same_or_are_drawn_anew_while_the_wall_rises(simulator, states, family):
    drawn = {}
    for same in (True, False):
        problem = VaultProblem(simulator.run, family, states, stage_of(same), np.zeros_like(family.table[0]))
        drawn[same] = [problem.scenarios(problem.stage, g, np.random.default_rng(g)) for g in (0, 9)]
    assert [s[0] for s in drawn[True][0]] == [s[0] for s in drawn[True][1]]
    assert [s[3] for s in drawn[False][0]] != [s[3] for s in drawn[False][1]]
    assert [s[2] for s in drawn[False][0]] == [0.6, 0.6]
    assert drawn[False][1][0][2] == pytest.approx(0.8)
    assert all(0.2 <= depth <= 0.4 for *_, depth in drawn[False][0])


def test_cost_grows_with_the_change(simulator, states, family):
    stage = stage_of(True, pull=1e6)
    problem = VaultProblem(simulator.run, family, states, stage, np.zeros_like(family.table[0]))
    scenario = problem.scenarios(stage, 0, np.random.default_rng(0))[:1]
    assert (
        problem.evaluate(stage, 0.01 * stage.scale, scenario)[0]
        > problem.evaluate(stage, problem.start(), scenario)[0]
    )


def test_what_is_no_vault_costs_more(simulator, states, family):
    costs = []
    for failed in (0.0, 4.0):
        stage = stage_of(True, failed=failed, heights=(0.6, 0.6), duration=0.3)
        problem = VaultProblem(simulator.run, family, states, stage, np.zeros_like(family.table[0]))
        cost_, vaulted = problem.evaluate(stage, problem.start(), problem.scenarios(stage, 0, None))
        costs.append(cost_)
        assert vaulted == 0.0  # too short for it
    assert costs[1] == pytest.approx(costs[0] + 4.0)


def test_a_stage_adds_a_member_or_replaces_the_one_at_its_height(simulator, family):
    change = 0.01 * np.ones(family.table.shape[1])
    grown = changed(family, change, stage_of(False), simulator.run, [])
    assert grown.heights.tolist() == [0.6, 0.8]
    np.testing.assert_array_equal(grown.table, [family.table[0], family.table[0] + change])
    refined = stage_of(False, heights=(0.6, 0.6), refines=True)
    again = changed(grown, 2 * change, refined, simulator.run, [])
    assert again.heights.tolist() == [0.6, 0.8]
    np.testing.assert_allclose(again.table, [family.table[0] + 2 * change, grown.table[1]])
    np.testing.assert_array_equal(again.references, grown.references)


def test_a_checkpoint_of_another_training_is_refused(tmp_path):
    Training(checkpoint=tmp_path / "kept").prepare("jump", tmp_path / "out.npz", curriculum(Training()))
    with pytest.raises(LocomotionError, match="differs in skill, "):
        train_vault(Training(checkpoint=tmp_path / "kept"), tmp_path / "out.npz")


def test_a_higher_wall_begins_with_what_a_higher_jump_does_as_far_as_it_helps(simulator, states, family):
    stage = stage_of(True, heights=(0.7, 0.7))
    problem = VaultProblem(simulator.run, family, states, stage, np.zeros_like(family.table[0]))
    problem.predict(5.0 * scales("feedback"))  # nothing that serves
    np.testing.assert_array_equal(problem.start(), np.zeros_like(family.table[0]))
    part = vault.parameter_slices()
    change = higher()
    assert change[part["marks"]].any() and change[part["a_hat"]].any()
    assert not change[part["arm"]].any() and not change[part["entry"]].any()
