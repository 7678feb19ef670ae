"""Searches race their candidates, and resume to the same result."""

from pathlib import Path

import numpy as np
import pytest

from locomotion.errors import LocomotionError
from locomotion.training.search.cma_es import CmaEs
from locomotion.training.search.loop import Stage, learn
from tests.locomotion.training.tiny import tiny_problem


class Bowl:
    """The way to 1 in each of two parameters, seen askew in each trial."""

    def __init__(self, trials: int, askew: float, least: int = 1) -> None:
        self.trials, self.askew, self.least, self.judged = trials, askew, least, []

    def stages(self) -> list[Stage]:
        return [Stage("bowl", 60, 0.5, np.ones(2), population=8, least=self.least)]

    def start(self) -> np.ndarray:
        return np.zeros(2)

    def scenarios(self, stage: Stage, generation: int, rng: np.random.Generator) -> list:
        return list(self.askew * rng.normal(size=(self.trials, 2)))

    def evaluate(self, stage: Stage, candidate: np.ndarray, scenarios: list) -> tuple[float, float]:
        self.judged.append(len(scenarios))
        return float(np.mean([np.sum((candidate - 1.0 - askew) ** 2) for askew in scenarios])), 1.0


@pytest.mark.parametrize(
    ("trials", "least", "each"),
    [
        (1, 1, [1] * 8),
        (2, 1, [1] * 12),
        (5, 1, [2] * 8 + [3] * 4),
        (5, 3, [3] * 8 + [2] * 4),
        (2, 3, [2] * 8),
    ],
)
def test_only_the_better_half_of_a_generation_is_judged_on_all_trials(
    trials: int, least: int, each: list[int]
) -> None:
    problem = Bowl(trials, 0.1, least)
    learned = learn(problem, seed=3, workers=1, on_progress=lambda progress: None)
    assert problem.judged == each * 60
    np.testing.assert_allclose(learned, 1.0, atol=0.15)


def test_where_all_trials_are_alike_it_learns_as_if_candidates_did_not_race() -> None:
    learned = learn(Bowl(4, 0.0), seed=3, workers=1, on_progress=lambda progress: None)
    search = CmaEs(np.zeros(2), 0.5, np.ones(2), population=8)
    for generation in range(60):
        asked = search.ask(np.random.default_rng([3, 0, generation]))
        search.tell(asked, np.sum((asked - 1.0) ** 2, axis=1))
    np.testing.assert_array_equal(learned, search.best_guess)


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
