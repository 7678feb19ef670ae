"""What a body can do about a meeting, and what it chooses."""

import numpy as np
import pytest

from locomotion.avoidance.options import cheapest, cost_of_meeting, options
from locomotion.avoidance.yielding import COUNT, first_meeting
from runtime.traffic.snapshot import foretold_on
from tests.locomotion.avoidance.test_yielding import ALONG, course


def listed(found):
    """Pace, cost and shift of each option."""
    return [(found.paces[n], found.costs[n], found.shift(n)) for n in range(len(found))]


def test_one_that_was_about_to_step_aside_may_go_on_with_that():
    aside = ALONG.copy()
    aside[:, 1] = 0.5
    found = listed(options(course(points=ALONG), 5, former=course(points=aside)))
    shifts = [shift for pace, _, shift in found if shift is not None and pace == 1.0]
    kept = min(shifts, key=lambda shift: abs(shift[:10, 1] - 0.5).max())
    assert kept[:10] == pytest.approx(np.tile([0.0, 0.5], (10, 1))) and kept[-1] == pytest.approx([0.0, 0.0])
    assert all(abs(shift[:3]).max() < 0.1 for *_, shift in listed(options(course(), 5)) if shift is not None)


def test_ways_aside_leave_and_come_back_as_curved_as_may_be():
    found = listed(options(course(), 15))
    assert [cost for _, cost, _ in found] == sorted(cost for _, cost, _ in found)
    assert {pace for pace, _, shift in found if shift is None} == {1.0, 0.6, 0.3, 0.0}
    aside = [(pace, shift) for pace, _, shift in found if shift is not None]
    assert {np.sign(shift[:, 1].sum()) for _, shift in aside} == {-1.0, 1.0}
    for _, shift in aside:
        y = shift[:, 1]
        assert np.abs(y[:6]).max() == 0.0 and abs(y[-1]) < 1e-9
        assert np.abs(np.diff(y, 2)).max() / 0.01 <= 1.05
    right = next(shift for pace, shift in aside if pace == 1.0)
    assert right[:, 1].min() < 0.0  # along x, the right is -y
    assert (
        len(options(course(aside=False), 15).shifts)
        == len(options(course(points=ALONG[:20]), 15).shifts)
        == 0
    )


def test_who_does_not_halt_easily_halts_only_when_told_that_it_must():
    runner, walker = course(slowest=1.0), course()
    for of, halts, wanted in ((runner, False, False), (runner, True, True), (walker, False, True)):
        assert (0.0 in options(of, 20, halts).paces) is wanted


def test_the_cheapest_is_that_of_all_that_are_not_barred():
    random, chosen = np.random.default_rng(5), []
    for number in range(60):
        bends = ALONG.copy()
        bends[:, 1] = 0.5 * np.sin(random.uniform(0.0, 0.5) * ALONG[:, 0])
        own = course(points=bends, slowest=random.choice([0.0, 1.0]), speed=random.uniform(0.0, 1.5))
        count = random.integers(1, 5)
        begin, velocity = (
            random.uniform([1.0, -2.0], [6.0, 2.0], (count, 2)),
            random.normal(0.0, 0.7, (count, 2)),
        )
        there = begin + 0.1 * np.arange(COUNT)[:, None, None] * velocity
        others, discs = (there, random.uniform(0.2, 0.4, count), 0.08), 1 + 2 * (number % 2)
        found = options(own, 10, former=course() if number % 3 == 0 else None)
        barred = random.uniform(size=len(found.shifts)) < 0.3
        least = random.uniform(1.0, 10.0)
        meetings = np.full(len(found), np.nan)
        best = cheapest(own, found, barred, others, discs, least, meetings)
        costs = []
        for n, (pace, cost, shift) in enumerate(listed(found)):
            points = own.points.copy()
            points[:, :2] += 0.0 if shift is None else shift
            met = first_meeting(foretold_on(own, points, pace, discs), own.radius, *others)
            counts = shift is None or not barred[found.ways[n]]
            costs.append(cost + cost_of_meeting(*met) if counts else np.inf)
        wanted = int(np.argmin(costs)) if min(costs) < least else -1
        assert best == wanted
        chosen.append(wanted)
    assert -1 in chosen and len(set(chosen)) > 8
