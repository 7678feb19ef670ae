"""What a person has seen of its own future: in a rehearsal, or because its double is ahead of it. While
nothing disturbs it, it takes that over instead of simulating it once more."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Protocol

import mujoco

from locomotion.events import Event
from locomotion.human.state import HumanState, same

__all__ = ["Predicted"]


class _Person(Protocol):
    events: list[Event]
    ticks: int

    @property
    def model(self) -> mujoco.MjModel: ...
    @property
    def data(self) -> mujoco.MjData: ...
    def save_state(self) -> HumanState: ...
    def become(self, state: HumanState) -> None: ...


class Predicted:
    """The states of the next ticks. They come true as long as the person is as it was seen to be: a push,
    another path, pace or ground end it."""

    def __init__(self) -> None:
        self._states: dict[int, HumanState] = {}  # by tick
        self._model: mujoco.MjModel | None = None

    def expect(self, person: _Person, states: Iterable[HumanState]) -> None:
        """From now on ``states`` are to come, one each tick; each holds the events of its tick only. None of
        them know of a force that pushes it now."""
        self.forget()
        if not person.data.xfrc_applied.any():
            self.begin(person)
            for state in states:
                self.add(state)

    def begin(self, person: _Person) -> None:
        """What is added from now on comes after what ``person`` is now."""
        self.forget()
        self._model = person.model
        self.add(person.save_state())

    def add(self, state: HumanState) -> None:
        """``state`` is to come in its tick."""
        self._states[state.ticks] = state

    def knows(self, tick: int) -> bool:
        """Whether it is known what is to come in ``tick``."""
        return tick in self._states

    def forget(self) -> None:
        """Nothing is known."""
        self._states.clear()

    def comes_true(self, person: _Person) -> bool:
        """Whether the next tick is known; ``person`` is then what it will be after it."""
        now, soon = self._states.pop(person.ticks, None), self._states.get(person.ticks + 1)
        if soon is None:
            return False
        if now is None or person.model is not self._model or not same(now, person.save_state()):
            self.forget()
            return False
        events = [*person.events, *soon.events]
        person.become(soon)
        person.events[:] = events
        return True

    def all_come_true(self, person: _Person) -> list[HumanState]:
        """The states of all the next ticks that are known; ``person`` is then what it will be after them."""
        states: list[HumanState] = []
        if self.comes_true(person):
            while self.knows(tick := person.ticks + len(states)):
                states.append(self._states[tick])
            person.become(states[-1])
            self.forget()
        return states
