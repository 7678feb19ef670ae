"""Figures of a made-up walk whose figures are known."""

import numpy as np
import pytest

from benchmarks.gait_measures import compare_curves, figures, strikes
from benchmarks.gait_record import Record
from benchmarks.human_walk import CURVES, human_curve
from locomotion.body.person import JOINT_NAMES

STEP, PERIOD, SPEED, STANCE = 0.0025, 1.0, 1.2, 0.6


@pytest.fixture(scope="module")
def record() -> Record:
    """Ten cycles of a walk along x: each foot bears 60 % of the cycle, heel first, 0.1 m apart, and slides
    4 mm; thighs, knees and ankles as people's."""
    n = round(10 * PERIOD / STEP)
    time = np.arange(n) * STEP
    share = np.stack([time / PERIOD % 1.0, (time / PERIOD + 0.5) % 1.0], axis=1)
    bears = share < STANCE
    soles = np.zeros((n, 6, 3))
    for side, y in ((0, -0.05), (1, 0.05)):
        placed = SPEED * PERIOD * (np.floor(time / PERIOD + 0.5 * side) - 0.5 * side)
        for k, ahead in enumerate((0.0, 0.15, 0.2)):
            soles[:, 3 * side + k, :2] = np.stack([placed + ahead, np.full(n, y)], axis=1)
            soles[:, 3 * side + k, 2] = np.where(share[:, side] < 0.1, 0.02 * k, 0.0)
    angles, thighs = np.zeros((n, len(JOINT_NAMES))), np.zeros((n, 2))
    for side, name in enumerate(("right", "left")):
        at = (share[:, side] * 100).astype(int)
        thighs[:, side] = np.radians(human_curve("thigh", 100))[at]
        for joint in ("knee", "ankle"):
            angles[:, JOINT_NAMES.index(f"{name}_{joint}_flexion")] = np.radians(human_curve(joint, 100))[at]
    com = np.stack([SPEED * time, np.zeros(n), 1.0 - 0.02 * np.cos(4 * np.pi * time / PERIOD)], axis=1)
    slid = np.where(bears, 0.004 * STEP / (STANCE * PERIOD), 0.0)
    return Record(
        STEP, com, angles, thighs, 400.0 * bears, soles, slid, np.full(n, 0.003), np.empty(0), False
    )


def test_strikes_come_once_a_cycle(record):
    assert (np.diff(strikes(record, 0)) == PERIOD / STEP).all()
    assert len(strikes(record, 1)) in (9, 10)


def test_figures_are_those_of_the_walk(record):
    found = figures(record)
    assert found["speed"] == pytest.approx(SPEED, rel=0.01)
    assert found["cadence"] == pytest.approx(2.0, rel=0.06)
    assert found["step width"] == pytest.approx(100.0, abs=1.0)
    assert found["rise"] == pytest.approx(40.0, abs=0.5)
    assert found["double support"] == pytest.approx(20.0, abs=1.0)
    assert found["heel first"] == 100.0
    assert found["slide"] == pytest.approx(4.0, rel=0.02)
    assert found["penetration"] == pytest.approx(3.0)
    assert found["knee at midstance"] < 10.0
    assert found["knee in swing"] == pytest.approx(64.0, abs=1.0)
    assert found["left against right"] < 1.0


def test_peoples_curves_are_like_peoples(record):
    for off, alike in compare_curves(record).values():
        assert off < 1.0
        assert alike > 0.99


def test_curves_begin_and_end_alike():
    for name in CURVES:
        assert abs(np.diff(human_curve(name, 100), append=human_curve(name, 100)[0])).max() < 5.0
