"""Common parts of all trainings: the user's options, and files of intermediate results."""

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from locomotion.body.person import person_digest
from locomotion.errors import LocomotionError
from locomotion.skills.library import skill_digest
from locomotion.training.progress import Clock, Progress, show
from locomotion.training.search.checkpoint import anew, claim, read_checkpoint
from locomotion.training.search.loop import Problem, Stage, learn, stages_digest
from surefoot.files.archive import check_target, write_archive
from surefoot.files.schema import Array, Header, Schema
from surefoot.workers.pool import Place

__all__ = ["NotLearnedError", "Training"]

_VERSION = 1
_TRIALS = 24
"""Trials in which the result has to succeed once."""
_SUCCESS = 0.991
"""A trial's figure above this is a success. On a path that is not completed it is at most 0.99."""


class NotLearnedError(LocomotionError):
    """Training finished, but its result never works."""


@dataclass(frozen=True)
class Training:
    """How to train a skill.

    Attributes:
      seed: the same seed gives the same skill, with any number of workers.
      checkpoint: folder for intermediate results; an interrupted training continues from there with the same
      result.
        None: they are not kept.
      workers: number of processes, or address of a cluster (`surefoot.workers.pool`). The learned walk is
        learned in this process in any case; so are the corrections of braking and landing if it is a cluster.
      effort: scales the number of generations, and below 1 some numbers of start states.
      on_progress: called after each generation.
    """

    seed: int = 0
    checkpoint: Path | None = None
    workers: Place = 2
    effort: float = 1.0
    on_progress: Callable[[Progress], None] = show

    def prepare(
        self,
        skill: str,
        out: str | os.PathLike[str],
        stages: Sequence[Stage],
        builds_on: Sequence[str] = (),
        **more: Any,
    ) -> None:
        """Check before a training that it can finish, and claim its folder.

        skill: its name. out: its file. builds_on: names of the built-in skills that training needs. more:
        JSON values that also decide the result. Raises `ArchiveError` if ``out`` cannot be written;
        `LocomotionError` if the folder belongs to another configuration.
        """
        check_target(out)
        if self.checkpoint is None:
            return
        asked = {"skill": skill, "seed": self.seed, "effort": self.effort, "person": person_digest()}
        skills = {f"{name} skill": skill_digest(name) for name in builds_on}
        claim(self.checkpoint, {**asked, **more, **skills, "stages": stages_digest(stages)})

    def learn(
        self, problem: Problem, number: int = 0, name: str = "search", clock: Clock | None = None
    ) -> np.ndarray:
        """Result of search ``number`` of a skill, see `locomotion.training.search.loop.learn`. ``name``: of
        its checkpoint file; ``clock``: of all searches."""
        learned = learn(problem, self.seed + number, self.file(name), self.workers, self.on_progress, clock)
        assert learned is not None
        return learned

    def demand_success(self, skill: str, problem: Problem, learned: np.ndarray) -> None:
        """Raises `NotLearnedError` if ``learned`` (n,) fails in all `_TRIALS` trials of the problem's last
        stage."""
        stage, rng = problem.stages()[-1], np.random.default_rng(self.seed)
        trials: list[Any] = []
        while len(trials) < _TRIALS:
            trials += problem.scenarios(stage, stage.generations, rng)
        if not any(problem.evaluate(stage, learned, [trial])[1] > _SUCCESS for trial in trials):
            raise NotLearnedError(
                f"{skill} does not work: after {stage.name!r} none of {len(trials)} trials succeeds; train "
                "with another --seed or more --effort, or from a better beginning"
            )

    def generations(self, count: int) -> int:
        """``number`` scaled by effort, at least one."""
        return max(round(count * self.effort), 1)

    def file(self, name: str) -> Path | None:
        """A file in the checkpoint's folder."""
        return None if self.checkpoint is None else self.checkpoint / f"{name}.npz"

    def recall(self, kind: str, number: int, arrays: Mapping[str, Array]) -> dict[str, np.ndarray] | None:
        """The ``arrays`` that `keep` saved for search ``number``; None if it is not finished."""
        path = self.file(f"done-{number}")
        if path is None or not path.exists():
            return None
        return read_checkpoint(path, Schema(kind, _VERSION, Header, arrays, anew(path)))[1]

    def keep(self, kind: str, number: int, arrays: dict[str, np.ndarray]) -> None:
        """Save the result of search ``number``."""
        path = self.file(f"done-{number}")
        if path is not None:
            write_archive(path, kind, _VERSION, {}, arrays)

    def made_by(self, skill: str) -> dict[str, Any]:
        """Entry of a skill's file about how it was made."""
        return {"made by": f"surefoot train {skill}", "seed": self.seed, "effort": self.effort}
