"""What an agent was told, and what is saved of it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import chain
from typing import Any

import numpy as np

from locomotion import LocomotionError
from locomotion.body.traits import by_hand
from runtime.errors import RuntimeInputError
from runtime.planning.beyond import Beyond
from runtime.traffic.waiting_and_deadlock import Headway

__all__ = ["AgentState", "Errand", "checked_style"]


@dataclass(frozen=True)
class Errand:
    """What an agent was told: `Agent.go_to`'s arguments. ``doubtful``: the level has changed while it could
    not look for another way. ``attempts``: how often it was stuck or lost on its way. ``balked``: tags of the
    obstacles before which it went back for another run-up, once for each time; ``closed``: of those that it
    has given up. ``beyond``: what of its way is not loaded yet, in an open world; ``length`` [m]: of the
    whole way when it set out, 0 if all was loaded; ``waits``: whether it stands until more is loaded."""

    goals: tuple[tuple[float, float, float], ...] = ()
    speed: float = 0.0
    facing: float | None = None
    doubtful: bool = False
    attempts: int = 0
    balked: tuple[str, ...] = ()
    closed: tuple[str, ...] = ()
    beyond: Beyond | None = None
    length: float = 0.0
    waits: bool = False


@dataclass(frozen=True)
class AgentState:
    """What `World.save` keeps of an agent. ``arrival``: how many bodies in the world came before its own;
    ``style``: its traits."""

    body: str
    born: float
    driver: Any
    blocked: bool
    goal: tuple[float, float, float]
    errand: Errand
    headway: Headway
    detail: str = "physics"
    bravery: float | None = None
    arrival: int = 0
    style: Mapping[str, float] = field(default_factory=dict)

    def check(self, name: str) -> None:
        """Raises `RuntimeInputError` for what no agent can have saved, as far as that shows without its
        body."""
        errand = self.errand
        told = errand.speed, errand.facing or 0.0, *chain(*errand.goals), errand.length
        numbers = [self.born, *self.goal, *told]
        if not np.isfinite(numbers).all():
            raise RuntimeInputError(f"{name} has been told numbers that are not finite")
        headway = self.headway
        if np.isnan([headway.left, headway.since, headway.told, headway.tried]).any():
            raise RuntimeInputError(f"{name} remembers of its way what is no number")
        if not name or errand.attempts < 0 or (errand.goals and errand.speed <= 0.0):
            raise RuntimeInputError(f"{name!r} has been told what nobody can do")
        beyond = errand.beyond
        if beyond is not None:
            beyond.check(name, len(errand.goals))
        elif errand.waits:
            raise RuntimeInputError(f"{name!r} waits for nothing")
        try:
            checked_style(self.style)
        except RuntimeInputError as error:
            raise RuntimeInputError(f"the style of {name!r}: {error}") from None


def checked_style(traits: Mapping[str, float]) -> Mapping[str, float]:
    """``traits``. Raises `RuntimeInputError` as `Agent.set_style`."""
    try:
        by_hand(None, **traits)
    except LocomotionError as error:
        raise RuntimeInputError(str(error)) from None
    return traits
