"""An obstacle on the way is known by its link."""

from dataclasses import replace

import pytest

from locomotion.recorded_people.crossing import Crossing
from tests.locomotion.recorded_people.test_clearing import over


def test_a_crossing_is_of_a_link_of_the_level():
    people, ada = over("vault", 0.8)
    of = ada.crossing
    assert isinstance(of, Crossing) and of.affordance == "vault" and not of.under_way
    assert of.is_there(people.crowd.graph) and of.heading == pytest.approx(0.0)
    assert not replace(of, size=of.size + 0.1).is_there(people.crowd.graph)
    assert not replace(of, end=(of.end[0] + 0.1, *of.end[1:])).is_there(people.crowd.graph)
