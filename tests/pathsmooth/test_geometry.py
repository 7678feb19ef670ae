"""The nearest point of two overlapping discs; lengths and values along polylines."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pathsmooth.geometry import arc_along, interpolated, lens_corners, nearest_in_lens, steps_along

DIRECTIONS = np.column_stack([f(np.linspace(0.0, 2.0 * np.pi, 2001)) for f in (np.cos, np.sin)])


def nearest_on_rims(point, discs):
    """The nearest of many points on both rims that lie in both discs; the obvious way."""
    rims = np.concatenate([np.array(center) + radius * DIRECTIONS for center, radius in discs])
    inside = np.all([np.linalg.norm(rims - c, axis=1) <= r + 1e-9 for c, r in discs], axis=0)
    return np.linalg.norm(rims[inside] - point, axis=1).min(initial=np.inf)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(seed=st.integers(0, 2**32 - 1), concentric=st.booleans())
def test_it_lies_in_both_and_none_is_nearer(seed, concentric):
    rng = np.random.default_rng(seed)
    ra, rb = rng.uniform(0.2, 2.0, 2)
    apart = 0.0 if concentric else rng.uniform(0.0, 0.98 * (ra + rb))
    angle = rng.uniform(0.0, 2.0 * np.pi)
    a = rng.uniform(-1.0, 1.0, 2)
    b = a + apart * np.array([np.cos(angle), np.sin(angle)])
    point = a + rng.uniform(-4.0, 4.0, 2)
    found = np.array(nearest_in_lens(*point, *a, ra, *b, rb))
    assert np.linalg.norm(found - a) <= ra + 1e-9 and np.linalg.norm(found - b) <= rb + 1e-9
    if np.linalg.norm(point - a) <= ra and np.linalg.norm(point - b) <= rb:
        assert np.array_equal(found, point)
    else:
        assert np.linalg.norm(found - point) <= nearest_on_rims(point, [(a, ra), (b, rb)]) + 1e-9


@pytest.mark.parametrize(
    ("point", "nearest"),
    [
        ((0.0, 0.5), (0.0, 0.5)),  # inside
        ((3.0, 0.0), (0.4, 0.0)),  # beside the lens, on the left disc's rim
        ((-3.0, 0.0), (-0.4, 0.0)),
        ((0.0, 3.0), (0.0, 0.8)),  # above its upper corner
        ((0.1, -9.0), (0.0, -0.8)),
    ],
)
def test_two_unit_discs_that_overlap(point, nearest):
    """Centres 1.2 m apart, so that the rims meet at 0.8 m above and below."""
    assert nearest_in_lens(*point, -0.6, 0.0, 1.0, 0.6, 0.0, 1.0) == pytest.approx(nearest, abs=1e-12)


def test_discs_that_touch_have_one_point():
    assert nearest_in_lens(0.3, 5.0, -1.0, 0.0, 1.0, 1.0, 0.0, 1.0) == pytest.approx((0.0, 0.0), abs=1e-9)


def test_rims_meet_at_two_corners():
    corners = lens_corners.py_func(-0.6, 0.0, 1.0, 0.6, 0.0, 1.0)
    assert corners == pytest.approx((0.0, 0.8, 0.0, -0.8), abs=1e-12)


@given(seed=st.integers(0, 10_000), count=st.integers(2, 30), columns=st.integers(1, 4))
@settings(max_examples=60, deadline=None, derandomize=True)
def test_interpolation_of_several_columns_is_numpys_of_each(seed, count, columns):
    rng = np.random.default_rng(seed)
    steps = rng.choice([0.0, 0.1, 1.0], count - 1) * rng.random(count - 1)
    places, rows = arc_along(steps), rng.normal(size=(count, columns))
    at = np.sort(np.concatenate([places, rng.uniform(-1.0, places[-1] + 1.0, 40)]))
    expected = np.column_stack([np.interp(at, places, rows[:, k]) for k in range(columns)])
    assert np.array_equal(interpolated(at, places, rows), expected)


def test_arc_lengths_add_up_the_horizontal_steps():
    points = np.array([[0.0, 0.0, 5.0], [3.0, 4.0, 9.0], [3.0, 4.0, 1.0], [3.0, 6.0, 1.0]])
    assert steps_along(points).tolist() == [5.0, 0.0, 2.0]
    assert arc_along(steps_along(points)).tolist() == [0.0, 5.0, 5.0, 7.0]
