"""Training by least squares on trial outcomes that change smoothly with the parameters.

Gauss-Newton with damping: each round draws trials, measures by central differences how every parameter
changes their residuals, and takes the damped step that does best on other trials. CMA-ES sees only a cost;
this sees the direction of each error, so a few hundred parameters need only a few trials each. Each finished
round is saved; an interrupted run continues after the last one with the same result.
"""

import hashlib
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, Any, NamedTuple, Protocol

import numpy as np
from annotated_types import Ge

from locomotion.body.learned_file import learned_numbers
from locomotion.errors import LocomotionError
from locomotion.training.progress import Clock, Progress, show
from locomotion.training.search.checkpoint import anew, read_checkpoint
from surefoot.files.archive import write_archive
from surefoot.files.schema import Header, Schema
from surefoot.workers.pool import Place, worker_pool

__all__ = ["Outcomes", "Work", "fit"]

_KIND, _VERSION = "least-squares checkpoint", 1


class _FitHeader(Header):
    identity: str
    round: Annotated[int, Ge(0)]


_STEP = 0.5  # of a parameter's scale: the central differences
_DAMPING = (30.0, 100.0, 300.0)
_MOST = 8.0  # of a residual that counts
_STEEPEST = 8.0  # change of a residual per scale that counts: contacts jump
_FAILED = 20.0  # squares of a trial that shows no residuals


class Outcomes(Protocol):
    """Defined by each skill. Instances are sent to the workers, so they must be picklable."""

    def trials(self, rng: np.random.Generator) -> list[Any]:
        """The trials of a round."""
        ...

    def residuals(self, candidate: np.ndarray, trial: Any) -> np.ndarray:
        """(r,) float64, 0 for the wanted outcome; NaN if the trial failed before it could be measured."""
        ...


_problem: Outcomes | None = None


def _start_worker(problem: Outcomes) -> None:
    global _problem
    _problem = problem


def _row(task: tuple[np.ndarray, list[Any]]) -> np.ndarray:
    """Residuals (trials, r) of a candidate."""
    candidate, trials = task
    assert _problem is not None
    return np.array([np.clip(_problem.residuals(candidate, trial), -_MOST, _MOST) for trial in trials])


def _loss(rows: np.ndarray) -> float:
    squares = (rows**2).sum(axis=1)
    return float(np.where(np.isfinite(squares), np.minimum(squares, _FAILED), _FAILED).mean())


class Work(NamedTuple):
    """How a search goes about it.

    ``checkpoint``: file that each round is written to. ``on_progress``: told after each round; ``survival``
    is the share of trials that showed residuals. ``clock``: of a skill that is learned in several searches;
    ``seconds``: what a round simulates [s], about.
    """

    checkpoint: str | os.PathLike[str] | None = None
    workers: Place = 2
    on_progress: Callable[[Progress], None] = show
    clock: Clock | None = None
    seconds: float = 1.0


def fit(
    problem: Outcomes,
    start: np.ndarray,
    scale: np.ndarray,
    rounds: int,
    seed: int,
    work: Work | None = None,
) -> np.ndarray:
    """Parameters (p,) float64 whose trials' residuals are small, from ``start`` (p,).

    ``scale`` (p,): how far a parameter may reasonably move; 0 keeps it. A checkpoint of another start or seed
    is refused with `LocomotionError`.
    """
    checkpoint, workers, on_progress, clock, seconds = work or Work()
    free = np.flatnonzero(scale > 0)
    parts = f"{seed} {rounds}".encode() + start.tobytes() + scale.tobytes()
    identity = hashlib.sha256(parts).hexdigest()[:16]
    x, first = start.copy(), 0
    if checkpoint is not None and Path(checkpoint).exists():
        arrays = {"x": learned_numbers(len(start))}
        schema = Schema(_KIND, _VERSION, _FitHeader, arrays, anew(checkpoint))
        found, read = read_checkpoint(Path(checkpoint), schema)
        if found.identity != identity:
            raise LocomotionError(f"{checkpoint}: belongs to another training or seed; {anew(checkpoint)}")
        x, first = read["x"], found.round
    clock = clock or Clock(rounds * seconds)
    clock.skip(first * seconds)
    with worker_pool(workers, _start_worker, (problem,)) as pool:
        for number in range(first, rounds):
            rng = np.random.default_rng([seed, number])
            trials, others = problem.trials(rng), problem.trials(rng)
            x, loss, shown = _round(pool.map, x, scale, free, trials, others)
            if checkpoint is not None:
                header = {"identity": identity, "round": number + 1}
                write_archive(checkpoint, _KIND, _VERSION, header, {"x": x})
            times = clock.advance(seconds)
            on_progress(Progress("least squares", number + 1, rounds, loss, shown, *times))
    return x


def _round(
    run: Callable[..., Sequence[np.ndarray]],
    x: np.ndarray,
    scale: np.ndarray,
    free: np.ndarray,
    trials: list[Any],
    others: list[Any],
) -> tuple[np.ndarray, float, float]:
    """The better parameters, their loss on ``others`` and the share of these that showed residuals."""
    tasks = [(x, trials)]
    for column, parameter in enumerate(free):
        for sign in (1.0, -1.0):
            moved = x.copy()
            moved[parameter] += sign * _STEP * scale[parameter]
            tasks.append((moved, trials[column % 2 :: 2]))  # every parameter on half of the trials
    rows = list(run(_row, tasks, chunksize=1))
    here = rows[0]
    jacobian = np.zeros((*here.shape, len(free)))
    for column in range(len(free)):
        slopes = (rows[1 + 2 * column] - rows[2 + 2 * column]) / (2.0 * _STEP)
        slopes = np.clip(np.nan_to_num(slopes), -_STEEPEST, _STEEPEST)
        jacobian[column % 2 :: 2, :, column] = np.sqrt(2.0) * slopes
    jacobian = jacobian.reshape(-1, len(free))
    normal, gradient = jacobian.T @ jacobian, jacobian.T @ np.nan_to_num(here).ravel()
    candidates = [x]
    for damping in _DAMPING:
        step = np.linalg.solve(normal + damping * np.eye(len(free)), -gradient)
        moved = x.copy()
        moved[free] += step * scale[free]
        candidates.append(moved)
    rows = list(run(_row, [(candidate, others) for candidate in candidates], chunksize=1))
    losses = [_loss(each) for each in rows]
    best = int(np.argmin(losses))
    return candidates[best], losses[best], float(np.isfinite(rows[best]).all(axis=1).mean())
