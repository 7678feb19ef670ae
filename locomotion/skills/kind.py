"""What all packages have to know of the skill for a kind of obstacle: one entry, made in a module beside the
skill and listed in `locomotion.skills.registry`."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from locomotion.body.person import BODY_NAMES
from locomotion.errors import LocomotionError
from navmesh.obstacles.kinds import ObstacleKind

if TYPE_CHECKING:
    from locomotion.gaits.run.skill import RunSkill
    from locomotion.skills.interface import ClearingSkill
    from locomotion.training.training import Training

__all__ = ["SkillKind"]

_SKILL = re.compile(r"[a-z][a-z-]{0,31}")
_COLOUR = re.compile(r"#[0-9a-f]{6}")


@dataclass(frozen=True, kw_only=True)
class SkillKind:
    """How people clear a kind of obstacle.

    Attributes:
        obstacle: the kind of obstacle, as the graph knows it.
        skill: what missions, commands and events call the skill, such as "drop-roll".
        status: what a person does that uses it, such as "dropping"; see `Human.status`.
        verb, does: in sentences, such as "drop" and "drops {:.2f} m and rolls", with one place for the size
            [m].
        colour: "#rrggbb" of such obstacles in pictures.
        sizes: least and greatest size [m] that people are to clear; `surefoot evaluate` draws from them.
        usual: the size [m] that is tried first.
        load: makes the skill on top of a run; gives None where it has not been learned.
        train: learns the skill and writes it to a file; None for a skill that is not learned.
        may_touch: the only parts of the body that may touch the obstacle, as "hand" for both hands; None:
            nothing that touches it counts.
        holds_on: whether a hand has to hold on to it.
    """

    obstacle: ObstacleKind
    skill: str
    status: str
    verb: str
    does: str
    colour: str
    sizes: tuple[float, float]
    usual: float
    load: Callable[[RunSkill], ClearingSkill | None]
    train: Callable[[Training, Path], None] | None = None
    may_touch: tuple[str, ...] | None = None
    holds_on: bool = False

    def __post_init__(self) -> None:
        if not isinstance(self.obstacle, ObstacleKind):
            raise LocomotionError(f"obstacle must be a navmesh.ObstacleKind, not {self.obstacle!r}")
        self._demand(bool(_SKILL.fullmatch(self.skill)), "skill", "up to 32 letters a to z and -")
        self._demand(bool(self.status.strip()), "status", "a word such as 'jumping'")
        self._demand(bool(self.verb.strip()), "verb", "a word such as 'jump'")
        self._demand(self.does.count("{") == 1, "does", "a sentence such as 'jumps onto {:.2f} m'")
        self._demand(bool(_COLOUR.fullmatch(self.colour)), "colour", "'#rrggbb' in small letters")
        low, high = self.sizes
        self._demand(0.0 < low <= high <= 100.0, "sizes", "0 < least <= greatest <= 100 [m]")
        parts = sorted(name.removeprefix("left_") for name in BODY_NAMES if name.startswith("left_"))
        self._demand(set(self.may_touch or ()) <= set(parts), "may_touch", f"some of {', '.join(parts)}")
        self._demand(low <= self.usual <= high, "usual", f"a size from {low:g} to {high:g} m")

    def _demand(self, holds: bool, name: str, expected: str) -> None:
        if not holds:
            value = getattr(self, name)
            raise LocomotionError(f"{self.affordance}: {name} {value!r}: expected {expected}")

    @property
    def affordance(self) -> str:
        """The name of the kind of obstacle."""
        return self.obstacle.affordance
