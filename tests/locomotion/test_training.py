"""Learning: the optimiser, resuming, the same result for the same seed. Nothing is really learned here."""

from pathlib import Path

import numpy as np
import pytest

from locomotion.errors import LocomotionError
from locomotion.run_layout import parameter_slices
from locomotion.training.cma_es import CmaEs
from locomotion.training.loop import Stage, learn
from locomotion.training.rollout import Simulator
from locomotion.training.run import (
    BLOCKS,
    SIZE,
    RunProblem,
    first_guess,
    first_state_reference,
    genes_scale,
    rows_scale,
    skill_of,
)
from locomotion.training.run_trials import draw_scenario


def minimise(function, start: np.ndarray, generations: int, sigma: float = 0.5) -> CmaEs:
    search = CmaEs(start, sigma, np.ones(len(start)), population=16)
    for generation in range(generations):
        asked = search.ask(np.random.default_rng(generation))
        search.tell(asked, np.array([function(x) for x in asked]))
    return search


def test_cma_finds_the_bottom_of_a_turned_valley() -> None:
    rng = np.random.default_rng(0)
    turn, _ = np.linalg.qr(rng.normal(size=(8, 8)))
    weights = np.logspace(0, 4, 8)

    def valley(x: np.ndarray) -> float:
        return float(np.sum(weights * (turn @ (x - 1.0)) ** 2))

    assert valley(minimise(valley, np.zeros(8), 300).best_guess) < 1e-8


def test_cma_keeps_up_with_the_cma_package() -> None:
    cma = pytest.importorskip("cma")

    def rosenbrock(x: np.ndarray) -> float:
        return float(np.sum(100 * (x[1:] - x[:-1] ** 2) ** 2 + (1 - x[:-1]) ** 2))

    mine = rosenbrock(minimise(rosenbrock, np.zeros(5), 250, 0.3).best_guess)
    options = {
        "popsize": 16,
        "seed": 1,
        "verbose": -9,
        "maxiter": 250,
        "tolfun": 0,
        "tolx": 0,
        "tolfunhist": 0,
    }
    theirs = cma.fmin2(rosenbrock, np.zeros(5), 0.3, options)[1].result.fbest
    assert mine < max(1e-6, 1e3 * theirs)


def tiny_problem() -> RunProblem:
    trial = {"duration": 0.2, "noise": 0.2}
    options = {"trials": 1, "style": 0.3, "fall": 0.0, "kinds": ({},), "trial": trial}
    stages = tuple(Stage(name, 2, 0.1, genes_scale(1, 0, 0, 0), options, population=4) for name in ("a", "b"))
    return RunProblem(
        stages, np.concatenate([first_guess(), np.zeros((len(BLOCKS) - 1) * SIZE)]), first_state_reference()
    )


def test_interrupted_and_resumed_equals_uninterrupted(tmp_path: Path) -> None:
    def silent(progress) -> None:
        assert progress.remaining >= 0.0

    whole = learn(tiny_problem(), seed=5, workers=1, on_progress=silent)
    checkpoint = tmp_path / "run.ckpt"
    assert learn(tiny_problem(), 5, checkpoint, workers=2, on_progress=silent, stop_after=3) is None
    resumed = learn(tiny_problem(), 5, checkpoint, workers=1, on_progress=silent)
    assert whole is not None and resumed is not None
    np.testing.assert_array_equal(whole, resumed)
    with pytest.raises(LocomotionError, match="another training or seed"):
        learn(tiny_problem(), 6, checkpoint, workers=1)
    checkpoint.write_bytes(checkpoint.read_bytes()[:200])
    with pytest.raises(LocomotionError, match="cut off or damaged"):
        learn(tiny_problem(), 5, checkpoint, workers=1)


def test_rows_of_their_own_begin_as_their_neighbours_and_are_learned_alone() -> None:
    genes = np.random.default_rng(0).normal(size=len(BLOCKS) * SIZE)
    genes[4 * SIZE :] = 0.0
    before = skill_of(genes, first_state_reference())
    part = parameter_slices()
    between = np.interp(2.0, before.knots[[0, 2]], before.table[[0, 2], part["m_ap"].start])
    assert before.knots[1] == 2.0 and before.table[1, part["m_ap"].start] == pytest.approx(between)
    np.testing.assert_array_equal(before.table[-1], before.table[-3])
    for row, scale in ((1, rows_scale(slow=1.0)), (-1, rows_scale(fastest=1.0))):
        after = skill_of(genes + scale, first_state_reference()).table
        assert (after[row, part["m_ap"]] != before.table[row, part["m_ap"]]).all()
        np.testing.assert_array_equal(np.delete(after, row, axis=0), np.delete(before.table, row, axis=0))
        np.testing.assert_array_equal(after[:, part["climb"]], before.table[:, part["climb"]])


def test_a_fall_costs_what_its_stage_says_and_a_trial_that_lasts_nothing() -> None:
    problem, rng = tiny_problem(), np.random.default_rng(2)
    lasts, falls = draw_scenario(rng, 0.2), draw_scenario(rng, 3.0, push=3000.0)
    for trials, more in (([lasts], 0.0), ([falls], 6.0), ([lasts, falls], 3.0)):
        free, dear = (Stage("a", 1, 0.1, np.ones(1), {"style": 0.3, "fall": fall}) for fall in (0.0, 6.0))
        free, dear = (problem.evaluate(stage, problem.genes, trials)[0] for stage in (free, dear))
        assert dear - free == pytest.approx(more)


def test_same_trial_same_outcome() -> None:
    skill = skill_of(tiny_problem().start(), first_state_reference())
    scenario = draw_scenario(np.random.default_rng(1), 1.0, noise=0.5, push=50.0, tilt=0.05, lateral=1.0)
    first, second = (Simulator().run(skill, scenario) for _ in range(2))
    assert first.figures == second.figures
    np.testing.assert_array_equal(first.state, second.state)
