"""The runs of a playtest's bots as files, so that one that was interrupted goes on where it was."""

import shutil
from dataclasses import astuple
from pathlib import Path
from typing import Annotated

from annotated_types import Ge

from runtime.playtest.bots import ROLES, BotRun, Passing, Trouble, Visit
from surefoot.files.archive import ArchiveError, read_archive, write_archive
from surefoot.files.choices import OneOf
from surefoot.files.schema import Array, Header, Numbers, Schema

__all__ = ["FOLDER", "KeptRuns"]

FOLDER = "playtest.checkpoint"
_KIND, _VERSION = "bot's run", 1
_Count = Annotated[int, Ge(0)]


class _Trouble(Header):
    kind: str
    time: float
    place: tuple[float, float, float]
    obstacle: int
    poses: bool


class _RunHeader(Header):
    number: _Count
    role: Annotated[str, OneOf(lambda: ROLES)]
    seconds: float
    troubles: tuple[_Trouble, ...]
    visits: tuple[tuple[str, str, float, float, bool], ...]
    passings: tuple[tuple[int, bool], ...]


def _arrays(header: _RunHeader) -> dict[str, Array]:
    arrays: dict[str, Array] = {"track": Numbers("moments", 4)}
    for k, trouble in enumerate(header.troubles):
        arrays[f"track_{k}"] = Numbers(f"moments_{k}", 4)
        if trouble.poses:
            arrays[f"poses_{k}"] = Numbers(f"frames_{k}", "bodies", 7)
    return arrays


_SCHEMA = Schema(_KIND, _VERSION, _RunHeader, _arrays, "the bot runs again")


class KeptRuns:
    """The finished runs of the playtest ``identity``, in a folder of its own inside ``folder``."""

    def __init__(self, folder: Path, identity: str) -> None:
        self._folder = folder
        self._own = folder / identity
        self._own.mkdir(parents=True, exist_ok=True)

    def read(self, number: int) -> BotRun | None:
        """The run of bot ``number``; None if it has not finished, or its file is damaged."""
        try:
            header, arrays = read_archive(self._file(number), _SCHEMA)
        except ArchiveError:
            return None
        troubles = [
            Trouble(each.kind, each.time, each.place, each.obstacle, arrays[f"track_{k}"],
                    arrays[f"poses_{k}"] if each.poses else None)
            for k, each in enumerate(header.troubles)
        ]  # fmt: skip
        track = arrays["track"]
        return BotRun(
            header.number, header.role, header.seconds, [track] if len(track) else [], troubles,
            [Visit(*each) for each in header.visits], [Passing(*each) for each in header.passings],
        )  # fmt: skip

    def keep(self, run: BotRun) -> None:
        """Write a finished run."""
        arrays = {"track": run.track}
        told = []
        for k, each in enumerate(run.troubles):
            arrays[f"track_{k}"] = each.track
            if each.poses is not None:
                arrays[f"poses_{k}"] = each.poses
            told.append(
                {"kind": each.kind, "time": each.time, "place": each.place, "obstacle": each.obstacle,
                 "poses": each.poses is not None}
            )  # fmt: skip
        header = {
            "number": run.number, "role": run.role, "seconds": run.seconds, "troubles": told,
            "visits": [astuple(each) for each in run.visits],
            "passings": [astuple(each) for each in run.passings],
        }  # fmt: skip
        write_archive(self._file(run.number), _KIND, _VERSION, header, arrays)

    def forget(self) -> None:
        """Remove the folder: the report is written."""
        shutil.rmtree(self._folder, ignore_errors=True)

    def _file(self, number: int) -> Path:
        return self._own / f"{number:06d}.npz"
