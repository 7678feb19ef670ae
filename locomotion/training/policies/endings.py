"""How people are where their policy ends, and another one goes on: it learns from there."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from locomotion.training.policies.environment import Environment
from locomotion.training.policies.starts import Starts

__all__ = ["where_it_ended"]


def where_it_ended(
    environment: Environment,
    decide: Callable[[NDArray[np.float64]], NDArray[np.floating]],
    most: int = 300,
) -> Starts | None:
    """States of people at the moment another network takes over, as ``decide`` moves them for ``most``
    decisions: when they come to rest, or, in a stage that ``stands``, when they have to make a step. None if
    that never happens."""
    found: dict[str, list[NDArray[np.float64]]] = {name: [] for name in ("memory", "physics", "sensed")}
    for _ in range(most):
        outcome = environment.step(decide(environment.observe()))
        found["memory"].append(outcome.switched[outcome.changes])
        found["physics"].append(environment.physics[outcome.changes])
        found["sensed"].append(environment.sensed[outcome.changes])
        environment.reset(outcome.fell | outcome.over)
    starts = Starts(**{name: np.concatenate(values) for name, values in found.items()})
    return starts if len(starts.memory) else None
