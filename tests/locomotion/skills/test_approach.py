"""The speed planner against its definition, its cvxpy reference, and hand-made cases."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from locomotion.errors import LocomotionError
from locomotion.skills.approach import ApproachWeights, plan_approach, plan_approach_exact

distances = st.floats(0.3, 40.0)
speeds = st.floats(1.0, 5.0)
entries = st.floats(2.0, 4.5)
models = st.tuples(st.floats(0.05, 0.4), st.floats(0.05, 0.5))
weights = st.one_of(st.floats(0.2, 5.0), st.lists(st.floats(0.2, 5.0), min_size=2, max_size=4))


@settings(max_examples=40, deadline=None)
@given(distances, speeds, entries, models, weights, st.integers(1, 25))
def test_closed_form_is_the_optimum(distance, speed, entry, model, change, steps):
    options = dict(takeoff=0.2, step_length=model, weights=ApproachWeights(change=change), steps=steps)
    plan = plan_approach(distance, speed, entry, **options)
    exact = plan_approach_exact(distance, speed, entry, **options)
    assert plan.cost <= exact.cost + 1e-6 * (1.0 + exact.cost)
    assert plan.speeds == pytest.approx(exact.speeds, abs=2e-3 * (1.0 + np.abs(exact.speeds).max()))
    assert plan.takeoff_error == pytest.approx(exact.takeoff_error, abs=2e-3)


@settings(max_examples=60, deadline=None)
@given(
    distances, speeds, entries, models, weights, st.floats(0.0, 1.0), st.floats(0.0, 1.0), st.integers(1, 25)
)
def test_bounded_plan_is_the_optimum(distance, speed, entry, model, change, below, above, steps):
    bounds = (entry - below, entry + above)
    options = dict(
        takeoff=0.2, step_length=model, weights=ApproachWeights(change=change), steps=steps, bounds=bounds
    )
    plan = plan_approach(distance, speed, entry, **options)
    exact = plan_approach_exact(distance, speed, entry, **options)
    assert plan.speeds.min() >= bounds[0] - 1e-12
    assert plan.speeds.max() <= bounds[1] + 1e-12
    assert plan.cost == pytest.approx(exact.cost, rel=1e-5, abs=1e-5)
    assert plan.speeds == pytest.approx(exact.speeds, abs=2e-3 * (1.0 + entry))


@settings(max_examples=200, deadline=None)
@given(st.floats(0.0, 12.0), speeds, entries)
def test_number_of_steps_is_the_best_one(distance, speed, entry):
    options = dict(step_length=(0.2, 0.17), bounds=(min(2.0, entry), max(4.5, entry)))
    plan = plan_approach(distance, speed, entry, **options)
    every = [plan_approach(distance, speed, entry, steps=n, **options).cost for n in range(0, 40)]
    assert plan.cost <= min(every) + 1e-9


@given(distances, speeds, entries)
def test_returned_figures_follow_from_the_speeds(distance, speed, entry):
    plan = plan_approach(distance, speed, entry, takeoff=0.5, step_length=(0.25, 0.3))
    lengths = 0.25 * plan.speeds + 0.3
    assert plan.takeoff_error == pytest.approx(distance - lengths.sum() - 0.5, abs=1e-9)
    if plan.speeds.size:
        assert plan.speeds[-1] == entry


def test_at_the_mark_the_plan_is_empty():
    plan = plan_approach(0.62, 3.5, 3.5, takeoff=0.6, step_length=(0.2, 0.17))
    assert plan.speeds.shape == (0,)
    assert plan.takeoff_error == pytest.approx(0.02)


def test_steady_run_that_fits_is_left_alone():
    step = 0.2 * 3.5 + 0.17
    plan = plan_approach(0.6 + 8 * step, 3.5, 3.5, takeoff=0.6, step_length=(0.2, 0.17))
    assert plan.speeds == pytest.approx(np.full(8, 3.5))
    assert plan.takeoff_error == pytest.approx(0.0, abs=1e-12)


def test_late_changes_can_be_made_dear():
    options = dict(takeoff=0.6, step_length=(0.2, 0.17), steps=10)
    even = plan_approach(9.0, 3.0, 3.8, **options)
    late = plan_approach(9.0, 3.0, 3.8, weights=ApproachWeights(change=(20.0, 20.0, 1.0)), **options)
    assert abs(late.speeds[-3] - 3.8) < abs(even.speeds[-3] - 3.8)


@pytest.mark.parametrize(
    "change, message",
    [
        (dict(distance=float("nan")), "distance"),
        (dict(entry=0.0), "entry"),
        (dict(bounds=(1.0, 2.0)), "bounds"),
        (dict(step_length=(-0.1, 0.2)), "step_length"),
        (dict(weights=ApproachWeights(change=0.0)), "weights.change"),
        (dict(weights=ApproachWeights(error=-1.0)), "weights.error"),
        (dict(steps=-1), "steps"),
    ],
)
def test_refuses_wrong_values(change, message):
    with pytest.raises(LocomotionError, match=message):
        plan_approach(**{**dict(distance=10.0, speed=3.0, entry=3.5), **change})
