"""A moment of a world, in memory and as a file."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any

from navmesh.files.archive import read_archive, write_archive
from runtime.agent import AgentState
from runtime.errors import RuntimeInputError
from runtime.events import Event
from runtime.state_file import pack, unpack

__all__ = ["WorldState"]

KIND = "surefoot world state"
VERSION = 3


@dataclass(frozen=True)
class WorldState:
    """A moment of a world, from `World.save`; `World.restore` goes back to it.

    ``level`` is `World.level_digest` of the level that it belongs to, ``skills`` the digest of what its
    people have learned, empty without any. Neither level nor skills are kept.
    """

    level: str
    skills: str
    ticks: int
    owed: float
    events: tuple[Event, ...]
    untold: tuple[Event, ...]
    random: Mapping[str, Any]
    agents: dict[str, AgentState]

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write it to ``path`` (.npz), whole or not at all. Raises `ArchiveError` where there
        is no folder."""
        tree, arrays = pack(self)
        header = {"state": tree, "made_with": {name: version(name) for name in ("mujoco", "numpy", "numba")}}
        write_archive(path, KIND, VERSION, header, arrays)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> "WorldState":
        """Read what `write` wrote. A run goes on bit for bit with the same release of Surefoot and MuJoCo.

        Raises `ArchiveError` for a file that is missing, cut off, of another kind or another
        version, and `RuntimeInputError` for one with contents of another release.
        """
        header, arrays = read_archive(path, KIND, VERSION)
        try:
            state = unpack(header.get("state"), arrays)
        except RuntimeInputError as error:
            raise RuntimeInputError(f"{path}: {error}") from None
        if not isinstance(state, cls):
            raise RuntimeInputError(f"{path}: holds no {KIND}; save the world again")
        return state
