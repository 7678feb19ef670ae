"""Dead reckoning: against integration in small steps, and against published cases."""

import numpy as np
import pytest

from benchmarks.dis_reckoning import errors_against_integration, integrated, random_motion
from runtime.dis.dead_reckoning import MODELS, Motion, reckoned, velocities
from runtime.dis.geodesy import angles_of, rotations_of

TOLD = [30.0, 35.0, 40.0], [-80.0, -85.0, -90.0], np.radians([60.0, 65.0, 70.0])


def published(model, sign):
    """The entity of Towers and Hines (Equations of Motion of the DIS 2.0.3 Dead Reckoning Algorithms,
    1994)."""
    velocity, acceleration, turning = (np.array([each]) for each in TOLD)
    return Motion(
        np.array([MODELS.index(model)]), -sign * np.array([[6378137.0, 5.0, 10.0]]),
        rotations_of(np.radians([[15.0, 20.0, 25.0]])), velocity, acceleration, sign * turning,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("model", "sign", "position", "angles"),
    [
        ("RVW", 1.0, (-6378132.0, 1.88, -1.25), (64.32, 14.84, 72.5)),
        ("FVW", 1.0, (-6378132.0, 1.88, -1.25), (15.0, 20.0, 25.0)),
        ("RPW", 1.0, (-6378122.0, 12.5, 10.0), (64.32, 14.84, 72.5)),
        ("FPW", 1.0, (-6378122.0, 12.5, 10.0), (15.0, 20.0, 25.0)),
        ("RVB", -1.0, (6378144.03, 10.46, 18.32), (-23.07, -8.68, -10.86)),
        ("RPB", -1.0, (6378156.77, 18.75, 28.73), (-23.07, -8.68, -10.86)),
        ("FPB", -1.0, (6378157.13, 18.06, 28.85), (15.0, 20.0, 25.0)),
        ("FVB", -1.0, (6378144.46, 9.62, 18.47), (15.0, 20.0, 25.0)),
        ("static", -1.0, (6378137.0, 5.0, 10.0), (15.0, 20.0, 25.0)),
    ],
)
def test_published_cases(model, sign, position, angles):
    """Half a second on, to the digits that were printed."""
    places, rotations = reckoned(published(model, sign), np.array([0.5]))
    assert places[0] == pytest.approx(position, abs=0.01)
    assert np.degrees(angles_of(rotations))[0] == pytest.approx(angles, abs=0.011)


def test_all_models_agree_with_integration():
    """A second in steps of 1 ms (the benchmark: 5 s in steps of 0.1 ms)."""
    for model in range(1, len(MODELS)):
        metres, radians = errors_against_integration(model, count=8, seconds=1.0, step=1e-3, seed=9)
        assert metres < 1e-3 and radians < 1e-4, MODELS[model]


@pytest.mark.parametrize("rate", [0.0, 1e-9, 1e-4, 0.0299, 0.0301, 3.0])
def test_slow_turns_are_as_exact(rate):
    """Around the size of turn where the series take over."""
    motion = random_motion(20, MODELS.index("RVB"), seed=2)
    motion.turning *= rate / np.linalg.norm(motion.turning, axis=1, keepdims=True)
    places, rotations = reckoned(motion, np.ones(20))
    truth, turned = integrated(motion, 1.0, 1e-3)
    assert np.abs(places - truth).max() < 1e-5 and np.abs(rotations - turned).max() < 1e-6


def test_many_are_reckoned_as_each_alone():
    motion = Motion.empty(9)
    for k in range(9):
        motion.put(np.array([k]), random_motion(1, k + 1, seed=k))
    seconds = np.linspace(0.0, 4.0, 9)
    places, rotations = reckoned(motion, seconds)
    for k in range(9):
        alone = reckoned(motion.of(np.array([k])), seconds[k : k + 1])
        assert np.allclose(places[k], alone[0][0], atol=1e-12) and np.allclose(rotations[k], alone[1][0])


@pytest.mark.parametrize("model", range(10))
def test_velocities_are_the_change_of_places(model):
    motion, seconds = random_motion(10, model, seed=3), np.full(10, 1.3)
    told = velocities(motion, seconds, reckoned(motion, seconds)[1])
    ahead, behind = (reckoned(motion, seconds + d)[0] for d in (1e-5, -1e-5))
    assert np.abs(told - (ahead - behind) / 2e-5).max() < 1e-4
