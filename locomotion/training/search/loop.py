"""The training loop of all skills: workers, generations, checkpoints, progress.

A skill defines a `Problem`: first guess, trials of a generation, cost of a candidate. The trials and
candidates of generation g come from a generator seeded with (seed, stage, g), so that an interrupted and
resumed run gives the same result as an uninterrupted one, with any number of workers.

Candidates race: all run a random third of a generation's trials, and only the better half runs the rest,
since the search learns from those only. That saves a third of the simulation.
"""

import hashlib
import math
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, Protocol

import numpy as np
from annotated_types import Ge

from locomotion.body.learned_file import learned_numbers
from locomotion.training.progress import Clock, Progress, show
from locomotion.training.search.checkpoint import anew, read_checkpoint
from locomotion.training.search.cma_es import CmaEs, search_arrays
from surefoot.files.archive import ArchiveError, write_archive
from surefoot.files.schema import Array, Header, Schema
from surefoot.workers.pool import Place, worker_pool

__all__ = ["Problem", "Stage", "learn", "read_search", "simulated", "stages_digest", "write_search"]

_KIND, _VERSION = "training checkpoint", 1


class _SearchHeader(Header):
    identity: str
    stage: Annotated[int, Ge(0)]


@dataclass(frozen=True)
class Stage:
    """One stretch of learning.

    Attributes:
        name: shown while learning. generations: how many. sigma: step size at its start, in units of
        ``scale``.
        scale: (n,) float64, size of a unit of each parameter; 0 keeps a parameter as it is.
        options: what the problem's ``scenarios`` and ``cost`` want to know about the stage.
        population: candidates per generation.
        seconds: what is simulated for a candidate [s], about; the time left is told from it.
        least: trials by which the better half of the candidates is chosen, at least.
    """

    name: str
    generations: int
    sigma: float
    scale: np.ndarray
    options: dict[str, Any] = field(default_factory=dict)
    population: int = 32
    seconds: float = 1.0
    least: int = 1


def simulated(stages: Sequence[Stage]) -> float:
    """What stages simulate [s], about."""
    return sum(stage.generations * stage.population * stage.seconds for stage in stages)


def stages_digest(stages: Sequence[Stage]) -> str:
    """Hex digest of the parts of stages that decide the result."""
    hasher = hashlib.sha256()
    for s in stages:
        hasher.update(
            repr((s.name, s.generations, s.sigma, s.options, s.population, s.least)).encode()
            + s.scale.tobytes()
        )
    return hasher.hexdigest()[:16]


class Problem(Protocol):
    """Defined by each skill. Instances are sent to the workers, so they must be picklable."""

    def stages(self) -> Sequence[Stage]:
        """The curriculum."""
        ...

    def start(self) -> np.ndarray:
        """First guess, (n,) float64."""
        ...

    def scenarios(self, stage: Stage, generation: int, rng: np.random.Generator) -> list[Any]:
        """The trials on which all candidates of a generation are judged."""
        ...

    def evaluate(self, stage: Stage, candidate: np.ndarray, scenarios: list[Any]) -> tuple[float, float]:
        """Mean cost of a candidate over the trials, and a figure for the display (share of the time
        survived)."""
        ...


_problem: Problem | None = None
_stages: Sequence[Stage] = ()


def _start_worker(problem: Problem) -> None:
    global _problem, _stages
    _problem, _stages = problem, problem.stages()


def _work(task: tuple[int, np.ndarray, list[Any]]) -> tuple[float, float]:
    stage, candidate, scenarios = task
    assert _problem is not None
    return _problem.evaluate(_stages[stage], candidate, scenarios)


def learn(
    problem: Problem,
    seed: int,
    checkpoint: str | os.PathLike[str] | None = None,
    workers: Place = 2,
    on_progress: Callable[[Progress], None] = show,
    clock: Clock | None = None,
    stop_after: int | None = None,
) -> np.ndarray | None:
    """Run the problem's stages with CMA-ES; returns the learned parameters, (n,) float64.

    ``checkpoint``: file that the state is saved to after each generation and resumed from; `LocomotionError`
    if it is of another problem or seed. ``clock``: of a skill with several searches. ``stop_after``: stop
    after that many generations as if interrupted (returns None if that is before the end).
    """
    stages = problem.stages()
    parameters = problem.start()
    identity = _identity(seed, stages, parameters)
    at, search = 0, None
    if checkpoint is not None and Path(checkpoint).exists():
        at, parameters, search = read_search(Path(checkpoint), identity, stages, parameters)
    made, clock = 0, clock or Clock(simulated(stages))
    clock.skip(simulated(stages[:at]))
    with worker_pool(workers, _start_worker, (problem,)) as pool:
        for number in range(at, len(stages)):
            stage = stages[number]
            free = np.flatnonzero(stage.scale > 0)
            if search is None:
                search = CmaEs(parameters[free], stage.sigma, stage.scale[free], stage.population)
            once = stage.population * stage.seconds
            clock.skip(search.generation * once)
            while search.generation < stage.generations:
                if stop_after is not None and made >= stop_after:
                    return None
                cost, survival = _generation(pool, problem, seed, number, stage, search, parameters, free)
                made += 1
                if checkpoint is not None:
                    write_search(Path(checkpoint), identity, number, parameters, search)
                times = clock.advance(once)
                on_progress(
                    Progress(stage.name, search.generation, stage.generations, cost, survival, *times)
                )
            parameters = parameters.copy()
            parameters[free] = search.best_guess
            search = None
    return parameters


def _generation(
    pool: Any,
    problem: Problem,
    seed: int,
    number: int,
    stage: Stage,
    search: CmaEs,
    parameters: np.ndarray,
    free: np.ndarray,
) -> tuple[float, float]:
    """One generation: ask, judge, tell; gives the median cost and survival in the first round."""
    rng = np.random.default_rng([seed, number, search.generation])
    asked = search.ask(rng)
    scenarios = problem.scenarios(stage, search.generation, rng)
    candidates = np.tile(parameters, (len(asked), 1))
    candidates[:, free] = asked

    def judge(which: np.ndarray, trials: np.ndarray) -> np.ndarray:
        drawn = [scenarios[k] for k in trials]
        tasks = [(number, x, drawn) for x in candidates[which]]
        return np.array(pool.map(_work, tasks, chunksize=1))

    first, rest = np.split(rng.permutation(len(scenarios)), [max(math.ceil(len(scenarios) / 3), stage.least)])
    results = judge(np.arange(len(asked)), first)
    costs = results[:, 0]
    better = np.argsort(costs, kind="stable")[: search.parents]
    told = costs[better]
    if len(rest) > 0:
        told = (len(first) * told + len(rest) * judge(better, rest)[:, 0]) / len(scenarios)
    search.tell(asked[better], told)
    cost, survival = np.median(results, axis=0)
    return float(cost), float(survival)


def _identity(seed: int, stages: Sequence[Stage], start: np.ndarray) -> str:
    """Digest of the problem that a search's state belongs to."""
    parts = f"{seed} {stages_digest(stages)}".encode() + start.tobytes()
    return hashlib.sha256(parts).hexdigest()[:16]


def write_search(path: Path, identity: str, stage: int, parameters: np.ndarray, search: CmaEs) -> None:
    arrays = {"parameters": parameters, **search.arrays()}
    write_archive(path, _KIND, _VERSION, {"identity": identity, "stage": stage}, arrays)


def read_search(
    path: Path, identity: str, stages: Sequence[Stage], start: np.ndarray
) -> tuple[int, np.ndarray, CmaEs]:
    def arrays_of(header: _SearchHeader) -> dict[str, Array]:
        if header.identity != identity:
            raise ArchiveError(f"{path}: belongs to another training or seed; {anew(path)}")
        if header.stage >= len(stages):
            raise ArchiveError(f"{path}: of stage {header.stage} of {len(stages)}; {anew(path)}")
        searched = int((stages[header.stage].scale > 0).sum())
        return {"parameters": learned_numbers(len(start)), **search_arrays(searched)}

    schema = Schema(_KIND, _VERSION, _SearchHeader, arrays_of, anew(path))
    header, arrays = read_checkpoint(path, schema)
    stage = stages[header.stage]
    free = np.flatnonzero(stage.scale > 0)
    search = CmaEs(start[free], stage.sigma, stage.scale[free], stage.population)
    search.restore(arrays)
    return header.stage, arrays["parameters"], search
