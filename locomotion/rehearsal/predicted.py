"""The ticks that a person knows in advance, from a rehearsal or from its double. While undisturbed, it
replays them instead of simulating them again."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Protocol

import mujoco

from locomotion.body_events import Event
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
    """The states of the next ticks. They are valid as long as the person is in the predicted state: a push,
    or another path, pace or ground, invalidates them."""

    def __init__(self) -> None:
        self._states: dict[int, HumanState] = {}  # by tick
        self._model: mujoco.MjModel | None = None

    def expect(self, person: _Person, states: Iterable[HumanState]) -> None:
        """Replace the prediction by ``states``, one for each tick, each with that tick's events only. They do
        not include any force that is pushing the person now."""
        self.forget()
        if not person.data.xfrc_applied.any():
            self.begin(person.model, person.save_state())
            for state in states:
                self.add(state)

    def begin(self, model: mujoco.MjModel, state: HumanState) -> None:
        """Later additions follow ``state`` of a person on ``model``."""
        self.forget()
        self._model = model
        self.add(state)

    def add(self, state: HumanState) -> None:
        """Add ``state`` for its tick."""
        self._states[state.ticks] = state

    def knows(self, tick: int) -> bool:
        """Whether ``tick`` is predicted."""
        return tick in self._states

    def holds(self, state: HumanState) -> bool:
        """Whether ``state`` is the predicted one."""
        predicted = self._states.get(state.ticks)
        return predicted is not None and same(predicted, state)

    def forget(self) -> None:
        """Nothing is known."""
        self._states.clear()

    def comes_true(self, person: _Person, is_as_predicted: bool = False) -> bool:
        """If the next tick is known, advance ``person`` to it; return whether it was. ``is_as_predicted``:
        that `holds` just now need not be looked at again."""
        now, soon = self._states.pop(person.ticks, None), self._states.get(person.ticks + 1)
        if soon is None:
            return False
        if (
            now is None
            or person.model is not self._model
            or not (is_as_predicted or same(now, person.save_state()))
        ):
            self.forget()
            return False
        events = [*person.events, *soon.events]
        person.become(soon)
        person.events[:] = events
        return True

    def all_come_true(self, person: _Person) -> list[HumanState]:
        """Advance ``person`` through all known ticks; return their states."""
        states: list[HumanState] = []
        if self.comes_true(person):
            while self.knows(tick := person.ticks + len(states)):
                states.append(self._states[tick])
            person.become(states[-1])
            self.forget()
        return states
