"""Trials that jumps are learned on: they repeat, start near the mark, and rank good jumps before bad."""

from dataclasses import replace

import numpy as np
import pytest

from locomotion.errors import LocomotionError
from locomotion.gaits.run.skill import load_run_skill, run_clip
from locomotion.skills.jump import kernel as jump
from locomotion.skills.jump.skill import Jump, load_jump_skill
from locomotion.training.search.loop import Stage
from locomotion.training.skills.jump import JumpProblem, train_jump
from locomotion.training.skills.jump_kind import ENTRY_SPEED, WEIGHTS, cost, first_guess, scales, stair_jump
from locomotion.training.skills.jump_trial import JumpSimulator
from locomotion.training.training import Training


@pytest.fixture(scope="module")
def problem():
    run, skill = load_run_skill(), load_jump_skill()
    rng = np.random.default_rng(1)
    states = JumpSimulator(run).harvest(Jump(skill, run), rng.uniform(8.0, 12.0, 4), rng)
    options = {"states": 3, "error": 0.05, "duration": 2.0, "pull": 0.1}
    stage = Stage("trial", 1, 0.1, scales(True), options, 4)
    height, (x, reference) = 0.4, skill.at(0.4)
    reference = reference.reshape(jump.STEPS, jump.BINS, jump.SENSORS)
    return JumpProblem(stair_jump(), run, height, x, reference, states, [stage])


def test_run_ups_end_near_the_mark(problem):
    assert len(problem.states) >= 3
    assert all(abs(state.error) < 0.35 for state in problem.states)


def test_trials_repeat(problem):
    stage = problem.stages()[0]
    scenarios = problem.scenarios(stage, 0, np.random.default_rng(5))
    assert len(scenarios) == 3
    first = problem.evaluate(stage, problem.start(), scenarios)
    assert first == problem.evaluate(stage, problem.start(), scenarios)
    assert first[1] >= 2 / 3


def test_a_jump_costs_less_than_running_into_the_stair(problem):
    still = first_guess(stair_jump())
    still[jump.parameter_slices()["alpha"]] = 0.0
    state = problem.states[0]
    good = problem.outcome(problem.start(), 0, state.error, 2.0)
    bad = problem.outcome(still, 0, state.error, 2.0)
    assert good.cleared and not bad.cleared
    assert cost(good, ENTRY_SPEED) + 5.0 < cost(bad, ENTRY_SPEED)


def test_a_prediction_is_followed_only_as_far_as_it_helps(problem):
    away = problem.start() + 3.0 * scales(True)
    guess = replace(problem, _simulator=None)
    guess.predict(away)
    np.testing.assert_array_equal(guess.start(), problem.start())
    start = replace(problem, initial=away, _simulator=None)
    start.predict(problem.start())
    np.testing.assert_allclose(start.start(), problem.start())


def test_a_checkpoint_of_another_configuration_is_refused_before_anything_runs(tmp_path, monkeypatch):
    class Begun(Exception):
        pass

    def begin(*arguments):
        raise Begun

    def train(**changes):
        train_jump(Training(checkpoint=tmp_path / "kept", **changes), tmp_path / "jump.npz")

    monkeypatch.setattr(JumpSimulator, "fit_stride", begin)
    for _ in range(2):
        with pytest.raises(Begun):
            train()
    with pytest.raises(LocomotionError, match="differs in seed "):
        train(seed=1)
    kind = replace(stair_jump(), clip=run_clip(), weights={**WEIGHTS, "pose": 5.0})
    monkeypatch.setattr("locomotion.training.skills.jump.stair_jump", lambda: kind)
    with pytest.raises(LocomotionError, match="differs in clip, objective "):
        train()
    assert not (tmp_path / "jump.npz").exists()
