"""A moment of a world, in memory and as a file."""

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.metadata import version
from typing import Any

import numpy as np

from locomotion.body.person import CONTROL_DT
from runtime.errors import RuntimeInputError
from runtime.events import Event
from runtime.world.agent_state import AgentState
from runtime.world.level_changes import ComingChange
from runtime.world.level_of_detail import Budget, Viewer
from runtime.world.state_file import DTYPES, pack, unpack
from runtime.world.streaming import StreamingState
from surefoot.files.archive import read_archive, write_archive
from surefoot.files.schema import Array, Flags, Header, Schema
from surefoot.words import several

__all__ = ["WorldState"]


@dataclass(frozen=True)
class WorldState:
    """A moment of a world, from `World.save`; `World.restore` goes back to it.

    ``level`` is `World.level_digest` of the level that it belongs to, ``skills`` the digests of what its
    people have learned (`locomotion.skills.library.learned_digest`), empty without any. Neither level nor
    skills are kept.
    """

    level: str
    skills: str
    ticks: int
    owed: float
    events: tuple[Event, ...]
    untold: tuple[Event, ...]
    random: Mapping[str, Any]
    agents: dict[str, AgentState]
    viewers: tuple[Viewer, ...] = ()
    budget: Budget = field(default_factory=Budget)
    blocked: tuple[str, ...] = ()
    """Zones of the level's graph that are blocked, in the order of their names."""
    streaming: StreamingState | None = None
    """What of an open world is loaded; None for another level."""
    coming: tuple[ComingChange, ...] = ()
    """Changes of the level that are being worked out, in the order in which they were asked for."""

    def __repr__(self) -> str:
        return f"<WorldState after {self.ticks} ticks: {several(len(self.agents), 'agent')}>"

    def check(self) -> None:
        """Raises `RuntimeInputError` for what no world can be in, as far as that shows without its bodies."""
        if not (0 <= self.ticks < 2**53 and 0.0 <= self.owed <= CONTROL_DT):
            raise RuntimeInputError(f"it is at tick {self.ticks}, {self.owed} s after it")
        np.random.default_rng().bit_generator.state = dict(self.random)
        for name, agent in self.agents.items():
            agent.check(name)

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write it to ``path`` (.npz), whole or not at all. Raises `ArchiveError` where there
        is no folder."""
        tree, arrays = pack(self)
        header = {"state": tree, "made_with": {name: version(name) for name in ("mujoco", "numpy", "numba")}}
        write_archive(path, STATE_FILE.kind, STATE_FILE.version, header, arrays)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> "WorldState":
        """Read what `write` wrote. A run goes on bit for bit with the same release of Surefoot and MuJoCo.

        Raises `ArchiveError` for a file that is missing, cut off, of another kind or another
        version, and `RuntimeInputError` for one with contents of another release.
        """
        header, arrays = read_archive(path, STATE_FILE)
        try:
            state = unpack(header.state, arrays)
        except RuntimeInputError as error:
            raise RuntimeInputError(f"{path}: {error}; {STATE_FILE.remedy}") from None
        if not isinstance(state, cls):
            raise RuntimeInputError(f"{path}: holds no {STATE_FILE.kind}; {STATE_FILE.remedy}")
        return state


class _StateHeader(Header):
    """``state``: the tree that `runtime.world.state_file.pack` gives."""

    state: Any
    made_with: dict[str, str]


STATE_FILE = Schema(
    kind="surefoot world state",
    version=22,
    header=_StateHeader,
    arrays={dtype: Flags(dtype) if dtype == "bool" else Array(dtype, (dtype,)) for dtype in DTYPES},
    remedy="save the world again",
)
