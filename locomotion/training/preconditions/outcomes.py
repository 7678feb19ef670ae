"""Files of what came of many starts, and how they are made: resumable, on any number of processes."""

from __future__ import annotations

import os
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from annotated_types import Ge
from numpy.typing import NDArray

from locomotion.body.person import person_digest
from locomotion.errors import LocomotionError
from locomotion.gaits.run.layout import STATE_SIZE
from locomotion.preconditions.changes import CHANGES, SLOW_DOWN
from locomotion.preconditions.moments import PLAN
from locomotion.skills.jump.kind import JUMP
from locomotion.skills.kind import SkillKind
from locomotion.skills.library import skills_digest
from locomotion.skills.registry import skill_called
from locomotion.training.preconditions.changes import try_change
from locomotion.training.preconditions.sampling import ENDS, Outcome, try_slow_down, try_start
from locomotion.training.preconditions.starts import draw_change, draw_slow_down, draw_start
from surefoot.files.archive import ArchiveError, check_target, read_archive, write_archive
from surefoot.files.schema import Flags, Header, Indices, Numbers, Offsets, Schema
from surefoot.progress import Progress
from surefoot.workers.pool import Place, worker_pool

__all__ = ["STARTS", "Outcomes", "kind_for", "read_outcomes", "sample"]

STARTS = ("size", "depth", "distance", "speed", "friction", "running", "noise", "pushed", "edge height")
"""Columns of `Outcomes.starts`: as of `starts.Start`; whether it was pushed; height [m] of the obstacle's
edge above the start."""
_BLOCK = 50  # starts that a worker takes at once, and that an interrupted run loses at most for each
_KIND, _VERSION = "outcomes", 1
_WIDE = {"state": STATE_SIZE, "plan": len(PLAN), "variation": 2, "beside": 1, "qpos": 46, "qvel": 45}


@dataclass(frozen=True)
class Outcomes:
    """What came of starts.

    Attributes:
        skill: what was tried.
        starts: (n, k) float64, see `STARTS`. ends: (n,) into `sampling.ENDS`. clean: (n,) bool.
        first: (n + 1,) where the moments of each start begin.
        moments: by name, (m, ...) float32 and bool, as of `sampling.Noted` and `moments.Moment`.
        header: what made them.
    """

    skill: str
    starts: NDArray[np.float64]
    ends: NDArray[np.int32]
    clean: NDArray[np.bool_]
    first: NDArray[np.int32]
    moments: dict[str, NDArray[Any]]
    header: dict[str, Any]

    @property
    def start_of(self) -> NDArray[np.int64]:
        """(m,) the start of each moment."""
        return np.repeat(np.arange(len(self.ends)), np.diff(self.first))

    @property
    def learned_from(self) -> NDArray[np.bool_]:
        """(m,) bool: none before a push, and none of people who never took off."""
        return ~self.moments["unforeseen"] & (self.ends[self.start_of] != 1)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the file; it appears whole or not at all."""
        arrays = {"starts": self.starts, "ends": self.ends, "clean": self.clean, "first": self.first}
        moments = {name: self.moments[name] for name in sorted(self.moments)}
        write_archive(path, _KIND, _VERSION, self.header, arrays | moments)


class _OutcomesHeader(Header):
    skill: str
    seed: Annotated[int, Ge(0)]
    person: str
    skills: str


_FILE = Schema(
    kind=_KIND,
    version=_VERSION,
    header=_OutcomesHeader,
    arrays={
        "starts": Numbers("starts", len(STARTS)),
        "ends": Indices("starts", into=len(ENDS)),
        "clean": Flags("starts"),
        "first": Offsets("starts", into="moments"),
        "off": Flags("moments"),
        "unforeseen": Flags("moments"),
        **{name: Numbers("moments", width, dtype="float32") for name, width in _WIDE.items()},
    },
    remedy="sample anew (surefoot sample)",
)


def kind_for(skill: str) -> SkillKind:
    """The obstacles at which ``skill`` is tried, of a change those at which it may be. Raises
    `LocomotionError` for an unknown one."""
    return JUMP if skill in CHANGES else skill_called(skill)


def read_outcomes(path: str | os.PathLike[str]) -> Outcomes:
    """Read a file of outcomes; `LocomotionError` if it is missing, damaged or no such file."""
    try:
        header, arrays = read_archive(path, _FILE)
    except ArchiveError as error:
        raise LocomotionError(str(error)) from error
    starts, ends, clean, first = (arrays.pop(name) for name in ("starts", "ends", "clean", "first"))
    return Outcomes(header.skill, starts, ends, clean, first, arrays, header.model_dump())


def sample(
    skill: str,
    count: int,
    seed: int,
    out: str | os.PathLike[str],
    place: Place = 1,
    progress: Progress | None = None,
) -> Outcomes:
    """Try ``skill`` from ``count`` starts and write what came of them to ``out``. The file is the same
    wherever the starts are tried, at ``place`` (`surefoot.workers.pool.worker_pool`).

    An interrupted call goes on where it was, from the folder OUT.parts. Starts in a file ``out`` of the same
    skill and seed are not tried again. Raises `LocomotionError` for an unknown skill.
    """
    kind_for(skill)
    check_target(out)
    target, parts = Path(out), Path(f"{out}.parts")
    header = {"skill": skill, "seed": seed, "person": person_digest(), "skills": skills_digest()}
    blocks = [range(k, min(k + _BLOCK, count)) for k in range(0, count, _BLOCK)]
    before = _of(header, target)
    done: dict[int, Outcomes] = {}
    for number, block in enumerate(blocks):
        kept = _of(header, _part(parts, block))
        if before is not None and block.stop <= len(before.ends):
            done[number] = _cut(before, block)
        elif kept is not None:
            done[number] = kept
    parts.mkdir(exist_ok=True)
    left = [number for number in range(len(blocks)) if number not in done]
    with (
        (progress or Progress(shown=False)).stage(f"sampling: {skill}") as stage,
        worker_pool(place, _begin, (header,)) as workers,
    ):
        for number, made in zip(left, workers.imap(_try, [blocks[k] for k in left]), strict=True):
            made.save(_part(parts, blocks[number]))
            done[number] = made
            holds = sum(int((each.ends == 0).sum()) for each in done.values())
            tried = sum(len(each.ends) for each in done.values())
            stage.update(len(done) / len(blocks), f"{holds} of {tried} hold")
    outcomes = _joined([done[number] for number in range(len(blocks))], header)
    outcomes.save(target)
    shutil.rmtree(parts)
    return outcomes


def _part(parts: Path, block: range) -> Path:
    return parts / f"{block.start:06d}-{block.stop:06d}.npz"


def _of(header: dict[str, Any], path: Path) -> Outcomes | None:
    """Outcomes in a file if they are of the same skill, seed and person."""
    try:
        found = read_outcomes(path)
    except LocomotionError:
        return None
    return found if found.header == header else None


_header: dict[str, Any] = {}  # of a worker process


def _begin(header: dict[str, Any]) -> None:
    global _header
    _header = header


def _try(block: range) -> Outcomes:
    """A block of starts; each is drawn from its own number. Every other one that slows down does so in a
    run-up."""
    skill, made = _header["skill"], []
    for number in block:
        rng = np.random.default_rng([_header["seed"], number])
        if skill == SLOW_DOWN and number % 2:
            made.append(try_slow_down(draw_slow_down(rng), rng))
        elif skill in CHANGES:
            made.append(try_change(skill, draw_change(skill, rng), rng))
        else:
            kind = skill_called(skill)
            made.append(try_start(kind, draw_start(kind, rng), rng))
    return _table(made, _header)


def _table(made: list[Outcome], header: dict[str, Any]) -> Outcomes:
    starts = [
        [each.start.size, each.start.depth, each.start.distance, each.start.speed, each.start.friction,
         each.start.running, each.start.noise, each.start.push_ticks > 0,
         0.0 if each.obstacle is None else each.obstacle.position[2]]
        for each in made
    ]  # fmt: skip
    noted = [row for each in made for row in each.noted]
    rows = {
        "state": [row.moment.state for row in noted],
        "plan": [row.moment.plan for row in noted],
        "variation": [row.moment.variation for row in noted],
        "beside": [row.moment.beside for row in noted],
        "qpos": [row.qpos for row in noted],
        "qvel": [row.qvel for row in noted],
    }
    moments: dict[str, NDArray[Any]] = {
        name: np.array(rows[name], dtype=np.float32).reshape(len(noted), width)
        for name, width in _WIDE.items()
    }
    for name in ("off", "unforeseen"):
        moments[name] = np.array([getattr(row, name) for row in noted], dtype=bool)
    first = np.cumsum([0, *(len(each.noted) for each in made)]).astype(np.int32)
    ends = np.array([ENDS.index(each.end) for each in made], dtype=np.int32)
    clean = np.array([each.clean for each in made])
    return Outcomes(header["skill"], np.array(starts, dtype=float), ends, clean, first, moments, header)


def _cut(outcomes: Outcomes, block: range) -> Outcomes:
    """Those of some starts."""
    rows = slice(outcomes.first[block.start], outcomes.first[block.stop])
    part = slice(block.start, block.stop)
    first = outcomes.first[block.start : block.stop + 1] - outcomes.first[block.start]
    moments = {name: values[rows] for name, values in outcomes.moments.items()}
    return Outcomes(
        outcomes.skill, outcomes.starts[part], outcomes.ends[part], outcomes.clean[part], first, moments,
        outcomes.header,
    )  # fmt: skip


def _joined(made: list[Outcomes], header: dict[str, Any]) -> Outcomes:
    def all_of(name: str) -> NDArray[Any]:
        return np.concatenate([getattr(each, name) for each in made])

    counts = np.concatenate([np.diff(each.first) for each in made])
    first = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
    moments = {name: np.concatenate([each.moments[name] for each in made]) for name in made[0].moments}
    return Outcomes(
        header["skill"], all_of("starts"), all_of("ends"), all_of("clean"), first, moments, header
    )  # fmt: skip
