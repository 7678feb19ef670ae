"""What a person has to decide, who tells it how, and a tick of its double up to the moment at which it has
to."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from typing import Any, Generic, NamedTuple, TypeVar

from locomotion.human.state import HumanState, same
from locomotion.rehearsal.predicted import Predicted
from locomotion.rehearsal.understudy import Chooser, Understudy

__all__ = ["Decider", "Outcome", "Question", "Trial", "known_answer", "tick_unless_asked"]

_T = TypeVar("_T")

Trial = Generator[None, None, tuple[float, list[HumanState]]]
"""A body goes on by a tick at a time; in the end, how well it went and what was seen of it (`Outcome`)."""


class Outcome(NamedTuple, Generic[_T]):
    """The choice that was made, how well it went, and what was seen of it: its states after each tick, each
    with the events of that tick only; empty where nothing was noted."""

    choice: _T
    went: float
    seen: list[HumanState]


class Question(NamedTuple):
    """What is to be decided in ``state``; see `trials.first_good`."""

    state: HumanState
    choices: Sequence[Any]
    choose: Callable[[Chooser, Any], None]
    goes_well: Callable[[Understudy], Trial]

    def is_also(self, other: Question) -> bool:
        """Whether the answer is the same."""
        return self.choices == other.choices and same(self.state, other.state)


class Decider:
    """Which variation of what it is about to do a body takes. ``answer``: who knows; None: nobody, it takes
    the first. ``undecided``: whether nobody knew, since that was set to False. ``predicted``: what the body
    knows of its next ticks."""

    def __init__(self) -> None:
        self.answer: Callable[[Question], Outcome] | None = None
        self.undecided = False
        self.predicted = Predicted()

    def best(
        self,
        body: Chooser,
        choices: Sequence[_T],
        choose: Callable[[Chooser, _T], None],
        goes_well: Callable[[Understudy], Trial],
    ) -> Outcome[_T]:
        """The best of ``choices``, see `trials.first_good`; without rehearsals the first is taken to go
        well. What was seen of it is there to be taken over, and not simulated again."""
        if self.answer is None:
            self.undecided = True
            return Outcome(choices[0], 1.0, [])
        return self.answer(Question(body.save_state(), choices, choose, goes_well))


class _Undecided(Exception):
    """The double has come to a moment at which something is to be decided."""

    def __init__(self, question: Question) -> None:
        super().__init__()
        self.question = question


def tick_unless_asked(double: Understudy, answers: Sequence[tuple[Question, Outcome]]) -> Question | None:
    """A tick of the double, which knows ``answers``; or what is undecided in it, and then it is not made: the
    double has to be restored to the state before."""

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
    """The one of ``answers`` that answers ``question``."""
    return next((outcome for asked, outcome in answers if question.is_also(asked)), None)
