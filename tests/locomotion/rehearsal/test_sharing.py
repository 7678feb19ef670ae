"""What several people may rehearse in one tick."""

from dataclasses import dataclass

import pytest

from locomotion.rehearsal.lookahead import PER_TICK
from locomotion.rehearsal.sharing import allot


@dataclass
class Person:
    foresees: int | None


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


def test_nobody_gets_anything_if_nobody_is_there():
    assert allot([], 20) == []
