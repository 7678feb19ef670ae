"""What an animal has been told, how far it has come with that, and all of it to be kept."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from locomotion.events import Event
from locomotion.quadruped.herd import AnimalState
from locomotion.quadruped.trail import Trail
from locomotion.quadruped.ways import Way

__all__ = ["AnimalMemory", "Errand", "Phase", "Status"]

Status = Literal["standing", "running", "arrived", "lost", "stuck"]
Phase = Literal[
    "resting", "halting", "waiting", "turning", "flexing", "following", "backing", "straightening", "moving"
]


@dataclass(frozen=True)
class Errand:
    """What it was told; how often it has ``waited`` for others to let it turn around, ``backed`` out, and
    made ``manoeuvres``."""

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
    """Everything needed to go on from here."""

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
