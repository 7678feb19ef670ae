"""What several people may rehearse in one tick."""

from dataclasses import dataclass

import pytest

from locomotion.rehearsal.lookahead import PER_TICK
from locomotion.rehearsal.sharing import allot


@dataclass
class Person:
    foresees: int | None
    ticks: int = 0
    needs: int = 0


@pytest.mark.parametrize("ticks", [0, 7, PER_TICK, 2 * PER_TICK + 5, 1000])
def test_who_has_to_decide_soonest_rehearses_first(ticks):
    people = [Person(foresees) for foresees in (30, None, 0, 12, 12, None)]
    allotted = allot(people, ticks)
    assert sum(allotted) == min(ticks, 4 * PER_TICK)
    left = ticks
    for number in (2, 3, 4, 0):
        assert allotted[number] == min(left, PER_TICK)
        left -= allotted[number]
    assert allotted[1] == allotted[5] == 0


@pytest.mark.parametrize("needs, begins", [(30 * PER_TICK, True), (30 * PER_TICK + 1, False)])
def test_who_cannot_have_its_answer_in_time_leaves_the_ticks_to_others(needs, begins):
    people = [Person(30, needs=needs), Person(40)]
    assert allot(people, PER_TICK) == ([PER_TICK, 0] if begins else [0, PER_TICK])


@pytest.mark.parametrize("first, left", [(250, 5), (251, 0)])
def test_answers_that_are_wanted_sooner_are_counted_on(first, left):
    """There are 1000 ticks until the second has to decide."""
    people = [Person(40, needs=750), Person(30, needs=first)]
    assert allot(people, PER_TICK + 5) == [left, PER_TICK]


def test_nobody_gets_anything_if_nobody_is_there():
    assert allot([], 20) == []


def test_nobody_goes_short_where_more_have_to_decide_than_can_rehearse():
    """Each of forty is as far ahead as it has just rehearsed, and comes nearer to it tick by tick."""
    people, shares = [Person(0) for _ in range(40)], [0] * 40
    for _ in range(400):
        for number, ticks in enumerate(allot(people, PER_TICK)):
            shares[number] += ticks > 0
            people[number].foresees = max(people[number].foresees - 1, 0) + ticks
            people[number].ticks += 1
    assert min(shares) == max(shares) == 10
