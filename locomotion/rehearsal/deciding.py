"""What a person has to decide, and a tick of its double up to the moment at which it has to."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from locomotion.human.state import HumanState, same

if TYPE_CHECKING:
    from locomotion.human.human import Human
    from locomotion.human.rehearsing import RehearsingPerson
    from locomotion.rehearsal.rehearsal import Outcome

__all__ = ["Question", "known_answer", "tick_unless_asked"]


class Question(NamedTuple):
    """What is to be decided in ``state``; see `rehearsal.first_good`."""

    state: HumanState
    choices: Sequence[Any]
    choose: Callable[[Human, Any], None]
    goes_well: Callable[[Human], Generator[None, None, tuple[float, list[HumanState]]]]

    def is_also(self, other: Question) -> bool:
        """Whether the answer is the same."""
        return self.choices == other.choices and same(self.state, other.state)


class _Undecided(Exception):
    """The double has come to a moment at which something is to be decided."""

    def __init__(self, question: Question) -> None:
        super().__init__()
        self.question = question


def tick_unless_asked(double: Human, answers: Sequence[tuple[Question, Outcome]]) -> Question | None:
    """A tick of the double, which knows ``answers``; or what is undecided in it, and then it is not made: the
    double has to be restored to the state before."""

    def recall(_: RehearsingPerson, question: Question) -> Outcome:
        outcome = known_answer(question, answers)
        if outcome is None:
            raise _Undecided(question)
        return outcome

    double.decides = recall
    try:
        double.tick()
    except _Undecided as undecided:
        return undecided.question
    finally:
        double.decides = None
    return None


def known_answer(question: Question, answers: Sequence[tuple[Question, Outcome]]) -> Outcome | None:
    """The one of ``answers`` that answers ``question``."""
    return next((outcome for asked, outcome in answers if question.is_also(asked)), None)
