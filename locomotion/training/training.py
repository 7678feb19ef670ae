"""What all trainings have in common: what a user asks for, and the files of what was learned so far."""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from locomotion.errors import LocomotionError
from locomotion.person import person_digest
from locomotion.training.loop import Problem, learn
from locomotion.training.progress import Clock, Progress, show
from navmesh.archive import read_archive, write_archive
from navmesh.whole_file import whole_file

__all__ = ["Training"]

_VERSION = 1
_ANEW = "remove the folder {} to begin anew, or keep checkpoints elsewhere"


@dataclass(frozen=True)
class Training:
    """How a skill is learned.

    Attributes:
        seed: the same gives the same skill, with any number of workers.
        checkpoint: file for the state of learning, or the folder for it where a skill takes several searches;
            what was interrupted goes on from there and gives the same result. None: it is kept nowhere.
        workers: processes.
        effort: scales the number of generations, and below 1 some numbers of start states.
        on_progress: told after each generation.
    """

    seed: int = 0
    checkpoint: Path | None = None
    workers: int = 2
    effort: float = 1.0
    on_progress: Callable[[Progress], None] = show

    def learn(
        self, problem: Problem, number: int = 0, file: Path | None = None, clock: Clock | None = None
    ) -> np.ndarray:
        """What search ``number`` of a skill finds, see `locomotion.training.loop.learn`. ``file``: for its
        state, where there are several; ``clock``: theirs."""
        kept = self.checkpoint if file is None else file
        learned = learn(problem, self.seed + number, kept, self.workers, self.on_progress, clock)
        assert learned is not None
        return learned

    def begin(self, configuration: Mapping[str, Any]) -> None:
        """Note in the checkpoint's folder what is learned there: values that `repr` tells apart, by name.

        Raises `LocomotionError`, naming what differs, if something else is learned there already.
        """
        if self.checkpoint is None:
            return
        own = {"seed": self.seed, "effort": self.effort, "person": person_digest()}
        said = {name: repr(value) for name, value in {**configuration, **own}.items()}
        self.checkpoint.mkdir(parents=True, exist_ok=True)
        noted = self.checkpoint / "configuration.json"
        if not noted.exists():
            with whole_file(noted) as temporary:
                temporary.write_text(json.dumps(said, indent=1) + "\n", encoding="utf-8")
            return
        try:
            before = json.loads(noted.read_text(encoding="utf-8"))
        except ValueError:
            raise LocomotionError(f"{noted}: cannot be read; {_ANEW.format(self.checkpoint)}") from None
        differs = [name for name in {**before, **said} if before.get(name) != said.get(name)]
        if differs:
            raise LocomotionError(
                f"{self.checkpoint}: holds another configuration, which differs in {', '.join(differs)}; "
                + _ANEW.format(self.checkpoint)
            )

    def generations(self, count: int) -> int:
        """So many with this effort, at least one."""
        return max(round(count * self.effort), 1)

    def file(self, name: str) -> Path | None:
        """A file in the checkpoint's folder."""
        if self.checkpoint is None:
            return None
        self.checkpoint.mkdir(parents=True, exist_ok=True)
        return self.checkpoint / f"{name}.npz"

    def recall(self, kind: str, number: int, run: str) -> dict[str, np.ndarray] | None:
        """What `keep` has kept of search ``number``; None where it is not done. ``run``: digest of the run.

        Raises `LocomotionError` if it was kept by a training with another seed, effort or run.
        """
        path = self.file(f"done-{number}")
        if path is None or not path.exists():
            return None
        header, arrays = read_archive(path, kind, _VERSION)
        if any(header.get(key) != value for key, value in self._identity(run).items()):
            raise LocomotionError(
                f"{path}: checkpoint of another training or seed; {_ANEW.format(self.checkpoint)}"
            )
        return arrays

    def keep(self, kind: str, number: int, run: str, arrays: dict[str, np.ndarray]) -> None:
        """Remember what search ``number`` has found."""
        path = self.file(f"done-{number}")
        if path is not None:
            write_archive(path, kind, _VERSION, self._identity(run), arrays)

    def _identity(self, run: str) -> dict[str, Any]:
        return {"seed": self.seed, "run": run, "effort": self.effort}

    def made_by(self, skill: str) -> dict[str, Any]:
        """What a skill's file says about how it was made."""
        return {"made by": f"surefoot train {skill}", "seed": self.seed, "effort": self.effort}
