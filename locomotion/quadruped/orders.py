"""An animal's orders and its progress with them, in a form that can be saved."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from locomotion.body_events import Event
from locomotion.quadruped.herd import AnimalState
from locomotion.quadruped.trail import Trail
from locomotion.quadruped.trail_planning import Way

__all__ = ["AnimalMemory", "Errand", "Phase", "Status"]

Status = Literal["standing", "running", "arrived", "lost", "stuck"]
Phase = Literal[
    "resting", "halting", "waiting", "turning", "flexing", "following", "backing", "straightening", "moving"
]


@dataclass(frozen=True)
class Errand:
    """Its orders; how often it has ``waited`` for others to let it turn, ``backed`` up, and made
    ``manoeuvres``."""

    goals: tuple[tuple[float, float, float], ...] = ()
    speed: float = 1.0
    facing: float | None = None
    gait: str | None = None
    waited: int = 0
    backed: int = 0
    manoeuvres: int = 0
    backed_from: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class AnimalMemory:
    """Everything needed to continue from here."""

    herd: AnimalState
    phase: Phase
    status: Status
    errand: Errand
    pending: bool
    trail: Trail | None
    ways: tuple[Way, ...]
    ticks: int
    stood: int
    events: tuple[Event, ...]
