"""Rehearsing before the moment comes, so that no single tick has to bear a whole rehearsal.

What a person decides by rehearsal (`locomotion.rehearsal.trials`) depends on its state at that moment
alone, and the simulation is exact. So its double goes ahead, a few ticks in each tick of the person's, to the
moment at which something is to be decided, and rehearses there. The person takes over what the double went
through (`locomotion.rehearsal.predicted`), decisions included. After a push, or when it has to give way,
which the double knew nothing of, it rehearses at the moment, all at once: its decisions never depend on how
far its double is.
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

_PER_TICK = 20  # ticks of the double in one of the person
_FAR = 400  # ticks that the double goes ahead at most
_LOOKS = 10  # ticks after which it is seen again whether there is something to foresee
_REST = 50  # ticks after which it tries again where it came otherwise


class Lookahead:
    """What a person knows beforehand."""

    def __init__(self, person: Understudy, double: Callable[[], Understudy], most: int) -> None:
        """``double``: makes one that moves as ``person`` does, on the same ground, and does not rehearse.
        ``most``: choices that are rehearsed at one time at most."""
        self._person, self._make_double, self._most = person, double, most
        self._double: Understudy | None = None
        self._task: Generator[None, None, None] | None = None
        self._asked: Question | None = None  # what the double rehearses now
        self._answers: list[tuple[Question, Outcome]] = []
        self._until = self._last = self._begins = 0
        # tick to which the double has come; the person's last; from which it may begin to look ahead

    def go_on(self, came_true: bool) -> None:
        """After each tick of the person: let its double go on for some ticks of its own, and add them to what
        the person foresees. came_true: whether the tick was taken over from that."""
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
        """The best choice and how well it goes."""
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
        """Let the double go on from ``state``, and rehearse whatever is to be decided on its way."""
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
        """Begin anew, at the tick ``begins`` or later."""
        if self._task is not None:
            self._task.close()
        self._task = self._asked = None
        self._answers.clear()
        self._until, self._begins = 0, begins
