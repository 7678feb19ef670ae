"""Switching between levels of detail, in small numbers."""

import numpy as np
import pytest

from benchmarks.giving_way import floor
from benchmarks.levels_of_detail import frame_figures, steps, switch


@pytest.fixture(scope="module")
def plain():
    return floor((-5.0, -40.0, 120.0, 40.0))


@pytest.mark.parametrize(
    ("mode", "to"), [("walk", "physics"), ("walk", "full"), ("run", "physics"), ("roll", "physics")]
)
def test_nobody_sees_the_switch_and_nobody_falls(mode, to):
    of = switch(mode, to, np.random.default_rng(4))
    assert of["switched"] == of["up"] == 1.0 and of["waited"] < 0.5
    assert of["jump"] < 1e-6 and of["jump_root"] < 1e-6
    assert (
        of["joint_after"] < max(of["joint_before"], 12.0) + 5.0
        and of["root_after"] < of["root_before"] + 0.02
    )


@pytest.mark.parametrize("mode", ["roll", "vault"])
def test_behind_an_obstacle_physics_takes_over_and_holds(mode):
    rng = np.random.default_rng(5)
    assert [switch(mode, "physics", rng)["up"] for _ in range(6)] == [1.0] * 6


def test_a_frame_of_people_at_all_levels_is_timed(plain):
    of = frame_figures(plain, (0, 2, 2, 2), 0.1, 1)
    assert 0.0 < of["posing"] <= of["median"] <= of["p99"] <= of["worst"]
    assert of["share_moving"] == 1.0


def test_a_hinge_that_goes_on_past_half_a_turn_makes_a_small_step():
    before, after = np.zeros(46), np.zeros(46)
    before[3] = after[3] = 1.0
    before[10], after[10], after[0] = np.pi - 0.01, -np.pi + 0.01, 0.03
    assert steps([before, after]) == pytest.approx((np.degrees(0.02), 0.03))
