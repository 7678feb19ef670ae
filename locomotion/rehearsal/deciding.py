"""Decisions of a person, who answers them, and ticks of its double up to the next decision."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from typing import Any, Generic, NamedTuple, TypeVar

from locomotion.human.state import HumanState, same
from locomotion.rehearsal.predicted import Predicted
from locomotion.rehearsal.understudy import Chooser, Understudy

__all__ = ["RECONSIDERS", "Decider", "Outcome", "Question", "Trial", "known_answer", "tick_unless_asked"]

_T = TypeVar("_T")

RECONSIDERS = 15
"""Ticks between attempts to decide the same, of one that does not wait."""
Trial = Generator[None, None, tuple[float, list[HumanState]]]
"""Advances a body tick by tick; returns how well it did and what was recorded (`Outcome`)."""


class Outcome(NamedTuple, Generic[_T]):
    """The choice made, how well it did, and the states recorded after each tick, each with that tick's events
    only; empty if nothing was recorded. ``known``: whether it was rehearsed, or is only assumed to hold."""

    choice: _T
    went: float
    seen: list[HumanState]
    known: bool = True


class Question(NamedTuple):
    """A decision to be made in ``state``; see `trials.Rehearsal`. ``takes``: ticks of a trial that holds."""

    state: HumanState
    choices: Sequence[Any]
    choose: Callable[[Chooser, Any], None]
    goes_well: Callable[[Understudy], Trial]
    takes: int

    def is_also(self, other: Question) -> bool:
        """Whether the answer is the same."""
        return self.choices == other.choices and same(self.state, other.state)


class Decider:
    """Chooses a variation of the next action. ``answer``: function that knows the answers; None: take the
    first choice. ``undecided``: whether a question had no answer since this was set to False.
    ``predicted``: known next ticks. ``waits``: see `locomotion.human.human.Human.waits`.
    """

    def __init__(self) -> None:
        self.answer: Callable[[Question], Outcome] | None = None
        self.undecided = False
        self.predicted = Predicted()
        self.waits = True

    @property
    def again(self) -> int:
        """Ticks between attempts to decide the same: one that does not wait rehearses some variations in
        them."""
        return 5 if self.waits else RECONSIDERS

    def best(
        self,
        body: Chooser,
        choices: Sequence[_T],
        choose: Callable[[Chooser, _T], None],
        goes_well: Callable[[Understudy], Trial],
        takes: int,
    ) -> Outcome[_T]:
        """The best of ``choices``, see `Question`; without rehearsals the first one, assumed to succeed.
        Recorded ticks are kept, so that they need not be simulated again."""
        if self.answer is None:
            self.undecided = True
            return Outcome(choices[0], 1.0, [], known=False)
        return self.answer(Question(body.save_state(), choices, choose, goes_well, takes))


class _Undecided(Exception):
    """The double has reached a decision."""

    def __init__(self, question: Question) -> None:
        super().__init__()
        self.question = question


def tick_unless_asked(double: Understudy, answers: Sequence[tuple[Question, Outcome]]) -> Question | None:
    """Advance the double, which knows ``answers``, by one tick. If it meets an unanswered decision, return
    that instead; the double must then be restored to its state before."""

    def recall(question: Question) -> Outcome:
        outcome = known_answer(question, answers)
        if outcome is None:
            raise _Undecided(question)
        return outcome

    double.decider.answer = recall
    try:
        double.tick()
    except _Undecided as undecided:
        return undecided.question
    finally:
        double.decider.answer = None
    return None


def known_answer(question: Question, answers: Sequence[tuple[Question, Outcome]]) -> Outcome | None:
    """The one of ``answers`` for ``question``."""
    return next((outcome for asked, outcome in answers if question.is_also(asked)), None)
