"""The bundle of what zones change."""

import numpy as np

from navmesh.zones.switches import FREE, SLOTS, SWITCHES, TURNS
from navmesh.zones.zones import zones_of
from tests.navmesh.zones.test_switching import in_an_apartment


def test_there_is_a_place_for_everything():
    base, outlines = in_an_apartment()
    graph = base.with_zones(outlines)
    assert all(hasattr(zones_of(graph).switches, name) for name in SWITCHES.fields)


def test_turns_and_slots_are_counted():
    base, outlines = in_an_apartment()
    graph = base.with_zones(outlines)
    numbers = zones_of(graph).switches.numbers
    before = numbers.copy()
    graph.block(next(iter(outlines)))
    assert numbers[TURNS] == before[TURNS] + 1
    graph.open(next(iter(outlines)))
    assert numbers[TURNS] == before[TURNS] + 2
    np.testing.assert_array_equal(numbers[SLOTS], before[SLOTS])  # it was rehearsed: those freed do again
    assert 0 <= numbers[FREE] < numbers[SLOTS]
