"""What a person has seen of its own future in a rehearsal. While nothing disturbs it, it takes that over
instead of simulating it once more."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

import mujoco
import numpy as np

from locomotion.human_state import HumanState, save_physics
from locomotion.moving_person import MovingPerson
from locomotion.path_tracking import TRACK_SIZE

__all__ = ["Foreseen"]


class Foreseen:
    """The states of the next ticks. They come true as long as the person is as it was seen to be: a push,
    another path, pace or ground, or a restored state end it."""

    def __init__(self) -> None:
        self._states: deque[HumanState] = deque()
        self._now: HumanState | None = None
        self._model: mujoco.MjModel | None = None

    def expect(self, person: MovingPerson, states: Iterable[HumanState]) -> None:
        """From now on ``states`` are to come, one each tick; each holds the events of its tick only."""
        self._states, self._now, self._model = deque(states), person.save_state(), person.model

    def comes_true(self, person: MovingPerson) -> bool:
        """Whether the next tick is known; ``person`` is then what it will be after it."""
        if not self._states:
            return False
        if not self._is_now(person):
            self._states.clear()
            return False
        self._now = self._states.popleft()
        events = [*person.events, *self._now.events]
        person.restore_state(self._now)
        person.events[:] = events
        return True

    def _is_now(self, person: MovingPerson) -> bool:
        now, way = self._now, person.way
        if now is None or person.model is not self._model or person.ticks != now.ticks:
            return False
        if person.status != now.status or way.path is not now.path:
            return False
        if not np.array_equal(way.memory, now.tracking[:TRACK_SIZE]):
            return False
        return np.array_equal(save_physics(person.model, person.data), now.physics)
