"""Figures of a made-up walk whose figures are known."""

import numpy as np
import pytest

from benchmarks.gait_measures import compare_curves, deepest_limb, figures, strikes
from benchmarks.gait_record import Record
from benchmarks.human_run import CURVES, runners_cadence, runners_curves
from benchmarks.human_walk import human_curves
from locomotion.body.person import JOINT_NAMES

STEP, PERIOD, SPEED, STANCE = 0.0025, 1.0, 1.2, 0.6


def walk_of(apart: float) -> Record:
    """Ten cycles of a walk along x: each foot bears 60 % of the cycle, heel first, so far ``apart`` [m], and
    slides 4 mm; thighs, knees and ankles as people's."""
    n = round(10 * PERIOD / STEP)
    time = np.arange(n) * STEP
    share = np.stack([time / PERIOD % 1.0, (time / PERIOD + 0.5) % 1.0], axis=1)
    bears = share < STANCE
    soles = np.zeros((n, 6, 3))
    for side, y in ((0, -0.5 * apart), (1, 0.5 * apart)):
        placed = SPEED * PERIOD * (np.floor(time / PERIOD + 0.5 * side) - 0.5 * side)
        for k, ahead in enumerate((0.0, 0.15, 0.2)):
            soles[:, 3 * side + k, :2] = np.stack([placed + ahead, np.full(n, y)], axis=1)
            soles[:, 3 * side + k, 2] = np.where(share[:, side] < 0.1, 0.02 * k, 0.0)
    people = human_curves(100)
    angles, thighs = np.zeros((n, len(JOINT_NAMES))), np.zeros((n, 2))
    for side, name in enumerate(("right", "left")):
        at = (share[:, side] * 100).astype(int)
        thighs[:, side] = np.radians(people["thigh"])[at]
        for joint in ("knee", "ankle"):
            angles[:, JOINT_NAMES.index(f"{name}_{joint}_flexion")] = np.radians(people[joint])[at]
    com = np.stack([SPEED * time, np.zeros(n), 1.0 - 0.02 * np.cos(4 * np.pi * time / PERIOD)], axis=1)
    slid = np.where(bears, 0.004 * STEP / (STANCE * PERIOD), 0.0)
    limbs = {"left hand in left thigh": 0.002, "left foot in right shank": 0.007}
    return Record(STEP, com, angles, thighs, 400.0 * bears, soles, slid, np.full(n, 0.003), limbs, False)


@pytest.fixture(scope="module")
def record() -> Record:
    return walk_of(apart=0.1)


def test_strikes_come_once_a_cycle(record):
    assert (np.diff(strikes(record, 0)) == PERIOD / STEP).all()
    assert len(strikes(record, 1)) in (9, 10)


def test_figures_are_those_of_the_walk(record):
    found = figures(record)
    assert found["speed"] == pytest.approx(SPEED, rel=0.01)
    assert found["cadence"] == pytest.approx(2.0, rel=0.06)
    assert found["step width"] == pytest.approx(100.0, abs=1.0)
    assert found["crossing"] == 0.0
    assert found["rise"] == pytest.approx(40.0, abs=0.5)
    assert found["double support"] == pytest.approx(20.0, abs=1.0)
    assert found["heel first"] == 100.0
    assert found["slide"] == pytest.approx(4.0, rel=0.02)
    assert found["penetration"] == pytest.approx(3.0)
    assert found["limb in limb"] == pytest.approx(7.0)
    assert found["flight"] == 0.0
    assert found["hardest step"] == pytest.approx(found["peak reaction"])
    assert found["knee at midstance"] < 10.0
    assert found["knee in swing"] == pytest.approx(64.0, abs=1.0)
    assert found["left against right"] < 1.0


def test_feet_that_cross_are_told_by_how_much():
    found = figures(walk_of(apart=-0.06))
    assert found["step width"] == pytest.approx(-60.0, abs=1.0)
    assert found["crossing"] == pytest.approx(30.0, abs=1.0)


def test_the_deepest_limb_is_named(record):
    assert deepest_limb(record) == ("left foot in right shank", 0.007)


def test_peoples_curves_are_like_peoples(record):
    for off, alike in compare_curves(record, human_curves(100)).values():
        assert off < 1.0
        assert alike > 0.99


def test_curves_that_begin_elsewhere_are_shifted_first(record):
    elsewhere = {name: np.roll(curve, 30) for name, curve in human_curves(100).items()}
    assert compare_curves(record, elsewhere)["knee"][0] > 20.0
    for off, alike in compare_curves(record, elsewhere, shifted=True).values():
        assert off < 1.0
        assert alike > 0.99


@pytest.mark.parametrize("curves", [human_curves(100), *(runners_curves(v, 100) for v in (2.5, 3.2, 4.5))])
def test_curves_begin_and_end_alike(curves):
    for curve in curves.values():
        assert abs(np.diff(curve, append=curve[0])).max() < 6.0


def test_runners_are_those_of_the_speed_or_of_the_nearest():
    assert runners_curves(2.5, 25)["knee"] == pytest.approx(CURVES[2.5]["knee"])
    between = 0.5 * (np.array(CURVES[3.5]["ankle"]) + CURVES[4.5]["ankle"])
    assert runners_curves(4.0, 25)["ankle"] == pytest.approx(between)
    assert runners_curves(6.0, 25)["thigh"] == pytest.approx(CURVES[4.5]["thigh"])
    assert runners_cadence(2.5) == pytest.approx(2.0 / 0.7451, rel=0.01)
    assert runners_cadence(5.0) == pytest.approx(3.13, abs=0.02)
