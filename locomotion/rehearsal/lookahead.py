"""Rehearse ahead of time, so that no single tick has to pay for a whole rehearsal.

What a person decides by rehearsal (`locomotion.rehearsal.trials`) depends only on its state at that moment,
and the simulation is exact. So a double runs ahead, a few ticks in each tick of the person, to the next
decision, and rehearses there. The person then replays the double's ticks (`locomotion.rehearsal.predicted`),
decisions included. After a push, or when it gives way, the prediction no longer holds and it rehearses on the
spot, all at once: decisions never depend on how far the double is ahead.
"""

from __future__ import annotations

from collections.abc import Callable, Generator

from locomotion.human.state import HumanState
from locomotion.rehearsal.deciding import Outcome, Question, known_answer, tick_unless_asked
from locomotion.rehearsal.predicted import Predicted
from locomotion.rehearsal.trials import at_once, first_good
from locomotion.rehearsal.understudy import Understudy
from surefoot.pausing import pause

__all__ = ["Lookahead"]

_PER_TICK = 20  # ticks of the double in each of the person's
_FAR = 400  # most ticks that the double is ahead
_LOOKS = 10  # ticks between checks whether there is something to predict
_REST = 50  # ticks before the next attempt after a wrong prediction


class Lookahead:
    """What a person knows in advance."""

    def __init__(self, person: Understudy, double: Callable[[], Understudy], most: int) -> None:
        """``double``: makes a copy of ``person`` on the same ground that does not rehearse. ``most``: most
        choices to rehearse for one decision."""
        self._person, self._make_double, self._most = person, double, most
        self._double: Understudy | None = None
        self._task: Generator[None, None, None] | None = None
        self._asked: Question | None = None  # the double's rehearsal in progress
        self._answers: list[tuple[Question, Outcome]] = []
        self._until = self._last = self._begins = 0
        # the double's tick; the person's last tick; the tick from which to look ahead

    def go_on(self, came_true: bool) -> None:
        """After each tick of the person: advance its double and add the new ticks to the prediction.
        came_true: whether this tick was predicted."""
        person = self._person
        now = person.ticks
        if now != self._last + 1:
            self._forget(now)  # it was restored
        elif now < self._until and not came_true:
            self._forget(now + _REST)
        self._last = now
        self._answers[:] = [answer for answer in self._answers if answer[0].state.ticks >= now]
        if self._task is None:
            if now < max(self._until, self._begins) or now % _LOOKS or not person.decides_soon:
                return
            self._answers.clear()
            person.decider.predicted.begin(person)
            self._task = self._go_ahead(person.save_state(), self._double_now(), person.decider.predicted)
        for _ in range(_PER_TICK):
            if self._task is not None and (self._asked is not None or self._until - now < _FAR):
                next(self._task, None)

    def decide(self, question: Question) -> Outcome:
        """The best choice and how well it does."""
        double = self._double_now()
        while self._task is not None and self._asked is not None and question.is_also(self._asked):
            next(self._task, None)
            pause()
        known = known_answer(question, self._answers)
        if known is not None:
            return known
        self._forget(self._person.ticks)
        return at_once(self._rehearse(double, question))

    def _rehearse(self, double: Understudy, question: Question) -> Generator[None, None, Outcome]:
        state, choices, choose, goes_well = question
        return first_good(state, double, choices[: self._most], choose, goes_well)

    def _go_ahead(
        self, state: HumanState, double: Understudy, future: Predicted
    ) -> Generator[None, None, None]:
        """Advance the double from ``state`` and rehearse each decision on its way."""
        double.restore_state(state)
        self._until = double.ticks
        while (
            double.ticks % _LOOKS or double.decides_soon or double.decider.predicted.knows(double.ticks + 1)
        ):
            double.events.clear()
            states = double.decider.predicted.all_come_true(double)
            question = None if states else tick_unless_asked(double, self._answers)
            while question is not None:
                self._asked = question
                self._answers.append((question, (yield from self._rehearse(double, question))))
                self._asked = None
                double.restore_state(state)
                double.events.clear()
                question = tick_unless_asked(double, self._answers)
            if double.status == "fallen":
                break  # the person may get up
            states = states or [double.save_state()]
            state = states[-1]
            self._until = state.ticks
            for known in states:
                if known.ticks >= self._last:
                    future.add(known)
            yield
        self._task = None

    def _double_now(self) -> Understudy:
        if self._double is None or self._double.model is not self._person.model:
            self._forget(self._person.ticks)
            self._double = self._make_double()
        return self._double

    def _forget(self, begins: int) -> None:
        """Start over at tick ``begins`` or later."""
        if self._task is not None:
            self._task.close()
        self._task = self._asked = None
        self._answers.clear()
        self._until, self._begins = 0, begins
