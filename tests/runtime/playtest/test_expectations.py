"""What a plan expects and does not hold is a fault."""

import re

import numpy as np
import pytest

from runtime.playtest import playtest
from runtime.playtest.expectations import broken_expectations
from runtime.playtest.plan import LoadedPlan
from tests.runtime.playtest.levels import FLOOR, box, room, site_of


def test_expectations_that_do_not_hold_are_faults(level, tmp_path):
    plan = tmp_path / "plan.yaml"
    plan.write_text(
        "spawns:\n  - {name: door, at: [1.0, 1.0, 0.0]}\n"
        "places:\n  - {name: pit, at: [5.0, 6.0, -1.5], reachable: false}\n"
        "  - {name: top, at: [13.0, 6.0, 0.5]}\n"
        "routes:\n  - {from: door, to: top, at_most: 5.0}\n"
    )
    found = playtest(level, bots=0, plan=plan).report
    assert sorted(fault.kind for fault in found.failures) == ["detour", "forbidden", "trap"]


@pytest.fixture(scope="module")
def site():
    return site_of(room(FLOOR, box(8, 8.3, 0, 8, 0, 3.2)))  # a wall that one goes round in the north


PLAN = """
spawns: [{name: a, at: [6, 2, 0]}]
places:
  - {name: b, at: [10, 2, 0], reachable: %s}
routes: [{from: a, to: b, at_most: %s}]
"""


@pytest.mark.parametrize(
    ("reachable", "most", "faults"),
    [
        ("true", 17.0, []),
        ("true", 9.0, [("detour", r"the way from a to b is 1[0-9]\.[0-9] m long; at most 9 m are allowed")]),
        ("false", 17.0, [("forbidden", r"b at \(10\.0, 2\.0, 0\.0\) can be reached")]),
    ],
)
def test_places_and_ways_are_as_the_plan_says(site, tmp_path, reachable, most, faults):
    (tmp_path / "plan.yaml").write_text(PLAN % (reachable, most))
    plan = LoadedPlan.read(tmp_path / "plan.yaml")
    at = site.part_at(np.array([[10.0, 2.0, 0.0]]))
    found = list(broken_expectations(site, plan, site.part_at(np.array([[6.0, 2.0, 0.0]])), at))
    assert [fault.kind for fault in found] == [kind for kind, _ in faults]
    for fault, (_, says) in zip(found, faults, strict=True):
        assert pytest.approx((10.0, 2.0, 0.0)) == fault.position
        assert re.match(says, fault.text)
