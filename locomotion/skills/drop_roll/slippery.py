"""Rolling off a drop on slippery ground: what changes in the roll, and in the walk's first steps after it.

A body that comes up out of a roll has its feet ahead of it. On usual ground they hold, and it is carried over
them. On slippery ground they slide away, and it falls onto its back. There the roll ends in another pose, at
another moment, and the walk has gains of its own until its steps count.
"""

import os
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Annotated, Any

import numpy as np
from annotated_types import Gt, Lt
from numpy.typing import NDArray

from locomotion.body.learned_file import RELEARN, learned_numbers, read_skill
from locomotion.body.person import person_digest
from locomotion.data import SKILLS
from locomotion.gaits.slow_down import ChangesHeader
from locomotion.gaits.walk.layout import GAINS
from locomotion.gaits.walk.skill import WalkSkill
from locomotion.ground.ground import FRICTION
from locomotion.skills.drop_roll.kernel import PARAMETERS
from surefoot.files.archive import write_archive
from surefoot.files.schema import Schema

__all__ = ["SLIPPERY_ROLL", "SlipperyRoll", "load_slippery_roll"]

SLIPPERY_ROLL = SKILLS / "slippery_roll.npz"


@dataclass(frozen=True, eq=False)
class SlipperyRoll:
    """How the drop-roll and the walk after it change on slippery ground.

    Attributes:
        roll: (p,) float64, parameters of the roll (`kernel.PARAMETERS`).
        gains: (len(GAINS),) float64 of the walk while it comes up.
        friction: coefficient of friction at which it was learned.
        meta: what made it.
    """

    roll: NDArray[np.float64]
    gains: NDArray[np.float64]
    friction: float
    meta: dict[str, Any] = field(default_factory=dict)

    def share(self, friction: float) -> float:
        """How much the body rolls like this on ground of this ``friction``, from 0 on usual ground to 1."""
        return min(max((FRICTION - friction) / (FRICTION - self.friction), 0.0), 1.0)

    def parameters(self, usual: NDArray[np.float64], share: float) -> NDArray[np.float64]:
        """(p,) parameters of the roll, ``usual`` (p,) on usual ground."""
        return usual + share * (self.roll - usual)

    def walk_tables(self, walk: WalkSkill, share: float) -> NDArray[np.float64]:
        """``walk.tables`` while it comes up."""
        return walk.tables + share * (self.gains - walk.tables)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the skill for the present person; the file appears whole or not at all."""
        header = {
            "person": person_digest(),
            "gains": list(GAINS),
            "friction": self.friction,
            "meta": self.meta,
        }
        arrays = {"roll": self.roll, "rising": self.gains}
        write_archive(path, _FILE.kind, _FILE.version, header, arrays)


class _Header(ChangesHeader):
    friction: Annotated[float, Gt(0.0), Lt(FRICTION)]


_FILE = Schema(
    "slippery roll",
    1,
    _Header,
    {"roll": learned_numbers(sum(PARAMETERS.values())), "rising": learned_numbers(len(GAINS))},
    RELEARN,
)


@lru_cache(maxsize=2)
def load_slippery_roll(path: str | os.PathLike[str] = SLIPPERY_ROLL) -> SlipperyRoll:
    """Read a slippery roll; `LocomotionError` if it is missing, cut off, of another version or another
    person."""
    header, arrays = read_skill(path, _FILE)
    return SlipperyRoll(arrays["roll"], arrays["rising"], header.friction, header.meta)
