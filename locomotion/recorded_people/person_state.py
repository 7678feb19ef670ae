"""What is kept of a recorded person when its world is saved."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from locomotion.crowd import WalkerState
from locomotion.postures.playback import Playback
from locomotion.recorded_people.crossing import Crossing

__all__ = ["Errand", "PersonState", "digest"]


@dataclass(frozen=True)
class Errand:
    """A way that begins once it stands: as of `RecordedPerson.go_to`."""

    goals: tuple[tuple[float, float, float], ...]
    speed: float
    facing: float | None


@dataclass(frozen=True)
class PersonState:
    """Everything that is remembered of a recorded person; ``turn`` is not in its hash: it decides only when
    the person is drawn anew."""

    body: WalkerState
    row: NDArray[np.float64]
    playback: Playback | None
    wanted: str
    errand: Errand | None
    crossing: Crossing | None = None
    turn: float = 0.0


def digest(state: PersonState, body: str) -> str:
    """Hex digest of everything that decides a person's future; ``body``: that of its body."""
    hasher = hashlib.sha256(state.row.tobytes())
    playing = state.playback
    if playing is not None:
        hasher.update(repr((playing.posture, playing.target, playing.arc, playing.begun)).encode())
        hasher.update(playing.place.tobytes())
    rest = f"{state.wanted}{state.errand}{state.crossing or ''}"
    return f"{body}{hasher.hexdigest()[:16]}{rest}"
