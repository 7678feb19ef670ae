"""Who answers a body's questions, and how its double runs ahead up to the next one."""

from typing import Any

import numpy as np
import pytest

from locomotion.human.human import Human
from locomotion.rehearsal.deciding import Decider, Outcome, Question, known_answer, tick_unless_asked
from locomotion.rehearsal.understudy import Chooser

CHOICES = (0.2, 0.4)


def goes_well(double) -> Any:
    yield
    return 1.0, []


class Counter(Chooser):
    """A body that asks in every third tick how far to step."""

    def __init__(self) -> None:
        self.decider, self.ticks, self.at = Decider(), 0, 0.0
        self.person = Human()

    def save_state(self):
        self.person.reset((self.at, 0.0, 0.0), 0.0)
        return self.person.save_state()

    def vary_step(self, longer):
        self.at += longer

    def tick(self) -> None:
        self.ticks += 1
        if self.ticks % 3 == 0:
            outcome = self.decider.best(self, CHOICES, Chooser.vary_step, goes_well, 1)
            self.vary_step(outcome.choice)


def test_without_anybody_to_ask_it_takes_its_first_choice_and_notes_that():
    body = Counter()
    assert not body.decider.undecided
    for _ in range(3):
        body.tick()
    assert body.at == CHOICES[0] and body.decider.undecided


def test_who_answers_sees_the_body_as_it_is_and_its_choices():
    body, asked = Counter(), []

    def answer(question: Question) -> Outcome:
        asked.append(question)
        return Outcome(question.choices[1], 0.7, [])

    body.decider.answer = answer
    for _ in range(6):
        body.tick()
    assert body.at == 2 * CHOICES[1] and not body.decider.undecided
    first, second = asked
    assert first.choices is CHOICES and first.goes_well is goes_well
    assert not first.is_also(second)  # it has moved
    assert first.is_also(first._replace(state=first.state._replace()))
    assert not first.is_also(first._replace(choices=(0.2, 0.6)))


def test_a_double_stops_before_what_it_does_not_know_and_goes_on_once_it_does():
    body = Counter()
    answers: list[tuple[Question, Outcome]] = []
    assert [tick_unless_asked(body, answers) for _ in range(2)] == [None, None]
    question = tick_unless_asked(body, answers)
    assert question is not None and body.at == 0.0
    assert body.decider.answer is None and not body.decider.undecided
    assert known_answer(question, answers) is None
    answers.append((question, Outcome(CHOICES[1], 1.0, [])))
    body.ticks = 2  # restored to before that tick
    assert tick_unless_asked(body, answers) is None and body.at == CHOICES[1]


def test_another_error_of_the_double_is_not_taken_for_a_question():
    body = Counter()

    def broken():
        raise RuntimeError("broken")

    body.tick = broken  # type: ignore[method-assign]
    with pytest.raises(RuntimeError, match="broken"):
        tick_unless_asked(body, [])
    assert body.decider.answer is None


def test_states_that_differ_in_one_number_are_other_questions():
    body = Counter()
    state = body.save_state()
    one = Question(state, CHOICES, Chooser.vary_step, goes_well, 1)
    numbers = state.numbers.copy()
    numbers[0] = np.nextafter(numbers[0], 1e9)
    assert not one.is_also(one._replace(state=state._replace(numbers=numbers)))
