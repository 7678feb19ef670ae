"""What `benchmarks.cluster` has others do: a module of its own, since workers have to import it."""

import time
from typing import Any

import numpy as np

from locomotion.training.search.loop import Problem, Stage

__all__ = ["Valley", "busy", "nothing"]


class Valley(Problem):
    """A search that takes no physics: parameters that should be 1, judged with noise."""

    def start(self) -> np.ndarray:
        return np.zeros(6)

    def stages(self) -> list[Stage]:
        return [Stage("valley", 12, 0.3, np.ones(6), population=12)]

    def scenarios(self, stage: Stage, generation: int, rng: np.random.Generator) -> list[Any]:
        return list(rng.normal(scale=0.1, size=(6, 6)))

    def evaluate(self, stage: Stage, parameters: np.ndarray, scenarios: list[Any]) -> tuple[float, float]:
        busy(0.02)
        return float(np.mean([np.sum((parameters - 1.0 + each) ** 2) for each in scenarios])), 1.0


def busy(seconds: float) -> float:
    """Compute for ``seconds`` of this process's time."""
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass
    return seconds


def nothing() -> None:
    """What a pool that needs nothing begins with."""
