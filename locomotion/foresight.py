"""Rehearsing before the moment comes, so that no single tick has to bear a whole rehearsal.

What a person decides by rehearsal (`locomotion.rehearsal`) depends on its state at that moment alone, and the
simulation is exact. So its double goes ahead, a few ticks in each tick of the person, to the moment at which
something is to be decided, and rehearses there; when the person comes to that moment in the very same state,
it already knows. Otherwise, after a push or when it has to give way, it rehearses then, all at once: what it
decides never depends on how far its double has come.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from locomotion.human_state import HumanState, same
from locomotion.rehearsal import Outcome, Trial, at_once, first_good

if TYPE_CHECKING:
    from locomotion.body import Human
    from locomotion.rehearsing_person import RehearsingPerson

__all__ = ["Foresight", "Question"]

_PER_TICK = 20  # ticks of the double in one of the person
_FAR = 400  # ticks that the double goes ahead at most
_COMPARED = 10  # ticks after which it is seen whether there is something to foresee, and whether it came so
_REST = 50  # ticks after which it tries again where not


class Question(NamedTuple):
    """What is to be decided in ``state``; see `rehearsal.first_good`."""

    state: HumanState
    choices: Sequence[Any]
    choose: Callable[[Human, Any], None]
    goes_well: Callable[[Human], Trial]

    def is_also(self, other: Question) -> bool:
        """Whether the answer is the same."""
        return self.choices == other.choices and same(self.state, other.state)


class _Undecided(Exception):
    """The double has come to a moment at which something is to be decided."""

    def __init__(self, question: Question) -> None:
        super().__init__()
        self.question = question


class Foresight:
    """What a person knows beforehand. ``most``: choices that it rehearses at one time at most."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._double: Human | None = None
        self._task: Generator[None, None, None] | None = None
        self._asked: Question | None = None  # what the double rehearses now
        self._answers: list[tuple[Question, Outcome]] = []
        self._expected: dict[int, HumanState] = {}  # by tick
        self._until = self._last = 0  # tick to which the double has come; the person's last

    def go_on(self, person: RehearsingPerson) -> None:
        """After each tick of ``person``: let its double go on for some ticks of its own."""
        now = person.ticks
        if now != self._last + 1:
            self._forget(now)  # it was restored
        self._last = now
        if now in self._expected and not same(self._expected.pop(now), person.save_state()):
            self._forget(now + _REST)
        if self._task is None:
            if now < self._until or now % _COMPARED or not person.decides_soon:
                return
            self._forget(now)
            self._task = self._go_ahead(person.save_state(), self._double_of(person))
        for _ in range(_PER_TICK):
            if self._task is not None and (self._asked is not None or self._until - now < _FAR):
                next(self._task, None)

    def decide(self, person: RehearsingPerson, question: Question) -> Outcome:
        """The best choice and how well it goes."""
        double = self._double_of(person)
        while self._task is not None and self._asked is not None and question.is_also(self._asked):
            next(self._task, None)
        known = self._known(question)
        if known is not None:
            return known
        self._forget(person.ticks)
        return at_once(self._rehearse(double, question))

    def _rehearse(self, double: Human, question: Question) -> Generator[None, None, Outcome]:
        state, choices, choose, goes_well = question
        return first_good(state, double, choices[: self._most], choose, goes_well)

    def _go_ahead(self, state: HumanState, double: Human) -> Generator[None, None, None]:
        """Let the double go on from ``state``, and rehearse whatever is to be decided on its way."""
        double.restore_state(state)
        while True:
            before = double.save_state()
            while True:
                question = self._tick(double)
                if question is None:
                    break
                self._asked = question
                self._answers.append((question, (yield from self._rehearse(double, question))))
                self._asked = None
                double.restore_state(before)
            self._until = double.ticks
            if self._until % _COMPARED == 0:
                if not double.decides_soon:
                    break
                self._expected[self._until] = double.save_state()
            yield
        self._task = None

    def _tick(self, double: Human) -> Question | None:
        """A tick of the double; what is undecided in it, and then it is not made."""
        double.decides = self._recall
        try:
            double.tick()
        except _Undecided as undecided:
            return undecided.question
        finally:
            double.decides = None
        return None

    def _recall(self, double: RehearsingPerson, question: Question) -> Outcome:
        outcome = self._known(question)
        if outcome is None:
            raise _Undecided(question)
        return outcome

    def _known(self, question: Question) -> Outcome | None:
        return next((outcome for asked, outcome in self._answers if question.is_also(asked)), None)

    def _double_of(self, person: RehearsingPerson) -> Human:
        if self._double is None or self._double.model is not person.model:
            self._forget(person.ticks)
            self._double = person.double()
        return self._double

    def _forget(self, until: int) -> None:
        """Begin anew, at tick ``until`` or later."""
        if self._task is not None:
            self._task.close()
        self._task = self._asked = None
        self._answers.clear()
        self._expected.clear()
        self._until = until
