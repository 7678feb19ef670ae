"""Odds are judged by what came of it."""

import math

import numpy as np
import pytest

from runtime.evaluation.preconditions import area_under_curve, bins_of, judged

HOLDS = np.array([True, True, False, True, False, False])


def test_the_area_is_the_chance_that_one_that_holds_has_the_higher_odds():
    assert area_under_curve(np.array([0.9, 0.8, 0.1, 0.7, 0.2, 0.3]), HOLDS) == 1.0
    assert area_under_curve(np.array([0.9, 0.8, 0.1, 0.2, 0.7, 0.2]), HOLDS) == pytest.approx(7.5 / 9.0)
    assert area_under_curve(np.full(6, 0.5), HOLDS) == 0.5
    assert math.isnan(area_under_curve(np.full(3, 0.5), np.ones(3, dtype=bool)))


def test_false_goes_and_false_stops_are_shares_of_those_who_go_and_stop():
    found = judged("jump", "at take-off", True, np.array([0.9, 0.8, 0.6, 0.4, 0.1, 0.2]), HOLDS)
    assert found.false_go == pytest.approx(1 / 3) and found.false_stop == pytest.approx(1 / 3)
    assert found.stopped == 0.5 and found.usual == 0.25 and found.held == 0.5
    assert found.brier == pytest.approx((0.01 + 0.04 + 0.36 + 0.36 + 0.01 + 0.04) / 6)
    assert math.isnan(judged("jump", "x", True, np.full(6, 0.7), HOLDS).false_stop)


def test_moments_of_like_odds_are_counted_together():
    bins = bins_of(np.array([0.05, 0.08, 0.95, 1.0, 0.55, 0.51]), HOLDS)
    assert [each.count for each in bins] == [2, 2, 2]
    assert [each.held for each in bins] == [1.0, 0.0, 0.5]
    assert bins[0].odds == pytest.approx(0.065) and bins[-1].odds == pytest.approx(0.975)
