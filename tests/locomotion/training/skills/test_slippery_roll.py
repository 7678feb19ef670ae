"""Learning to come up on slippery ground."""

import numpy as np
import pytest

from locomotion.gaits.run.skill import load_run_skill
from locomotion.gaits.walk.layout import LEVEL, gain_limits
from locomotion.gaits.walk.skill import load_walk_skill
from locomotion.skills.drop_roll.skill import DropRoll, load_drop_roll_skill
from locomotion.skills.drop_roll.slippery import load_slippery_roll
from locomotion.training.skills import slippery_roll
from locomotion.training.skills.drop_roll import HEIGHTS, harvest
from locomotion.training.skills.slippery_roll import SlipperyProblem, first_guess, slippery_roll_of
from locomotion.training.training import NotLearnedError, Training


@pytest.fixture(scope="module")
def problem():
    run, roll, rng = load_run_skill(), DropRoll(load_drop_roll_skill()), np.random.default_rng(4)
    return SlipperyProblem(run, harvest(run, roll, 4, rng), slippery_roll.curriculum(Training(effort=0.01)))


def learned():
    skill, free = load_slippery_roll(), slippery_roll.learned_places()
    return np.concatenate([skill.roll[free], skill.gains])


def test_learning_begins_with_what_holds_on_usual_ground():
    skill = slippery_roll_of(first_guess())
    assert np.array_equal(skill.roll, load_drop_roll_skill().at(HEIGHTS[0])[0])
    assert np.array_equal(skill.gains, load_walk_skill().tables[LEVEL])
    assert slippery_roll_of(first_guess() + 1e4).gains.tolist() == gain_limits()[1].tolist()


def test_trials_are_of_all_heights_and_mostly_on_the_most_slippery_ground(problem):
    stage = problem.stages()[-1]
    trials = problem.scenarios(stage, 0, np.random.default_rng(2))
    _, _, heights, frictions = np.array(trials).T
    assert heights.min() < 1.0 and heights.max() > 1.9
    assert (frictions == 0.45).mean() == pytest.approx(2.0 / 3.0) and frictions.max() == 0.6


def test_what_comes_with_the_package_comes_up_more_often_than_the_usual_roll(problem):
    stage, rng = problem.stages()[-1], np.random.default_rng(7)
    trials = problem.scenarios(stage, 0, rng)
    usual, rolled_usually = problem.evaluate(stage, first_guess(), trials)
    cost, rolled = problem.evaluate(stage, learned(), trials)
    assert cost < usual and rolled > rolled_usually + 0.2


def test_gains_outside_of_their_limits_cost(problem):
    stage, far = problem.stages()[-1], learned()
    trials = problem.scenarios(stage, 0, np.random.default_rng(3))[:1]
    low, high = gain_limits()
    far[-1] = high[-1] + 10.0 * (high[-1] - low[-1])
    inside = far.copy()
    inside[-1] = high[-1]
    assert problem.evaluate(stage, far, trials)[0] == pytest.approx(
        problem.evaluate(stage, inside, trials)[0] + 2.0
    )


def test_one_that_never_works_is_not_written(tmp_path, monkeypatch):
    def refuse(training, name, problem, learned):
        raise NotLearnedError(name)

    monkeypatch.setattr(Training, "demand_success", refuse)
    monkeypatch.setattr(Training, "learn", lambda training, problem: problem.start())
    monkeypatch.setattr(slippery_roll, "_STATES", 2)
    with pytest.raises(NotLearnedError, match="slippery-roll"):
        slippery_roll.train_slippery_roll(Training(effort=0.01), tmp_path / "roll.npz")
    assert not (tmp_path / "roll.npz").exists()
