"""Random trials for running, and their cost."""

from dataclasses import dataclass

import numpy as np

from locomotion.training.gaits.rollout import Scenario, Trial
from locomotion.training.gaits.walk_starts import WALK_STARTS

__all__ = ["MIDDLE", "TrialKind", "cost", "draw_scenario"]

MIDDLE = 3.5
"""Speed [m/s] at which training starts."""
_CAPTURED_SPEED, _CAPTURED_RATE = 5.26, 3.69
# [m/s], steps per s of a captured run, its 66 frames taken for a stride: the constants in equation 8


@dataclass(frozen=True)
class TrialKind:
    """What random trials have in common.

    duration [s]; range of desired speeds [m/s], drawn anew every 2 to 3 s; noise: start noise (1 = 0.3
    m/s, 0.05 rad); push: highest force [N] of pushes of 0.1 s; weakest: least share of it; lateral: highest
    lateral acceleration [m/s^2] of turns; tilt: highest slope of the ground [rise over run]; walking: share
    of the trials that start from a walk; climb: range of the slope along the start's heading instead of
    ``tilt``; steady: one speed all the time; circle: with ``steady``, one sharp turn all the time.
    """

    duration: float
    speeds: tuple[float, float] = (MIDDLE, MIDDLE)
    noise: float = 0.0
    push: float = 0.0
    weakest: float = 0.0
    lateral: float = 0.0
    tilt: float = 0.0
    walking: float = 0.0
    climb: tuple[float, float] | None = None
    steady: bool = False
    circle: bool = False


def draw_scenario(rng: np.random.Generator, kind: TrialKind) -> Scenario:
    """A random trial of a ``kind``."""
    duration, (low, high), noise, push, lateral = (
        kind.duration,
        kind.speeds,
        kind.noise,
        kind.push,
        kind.lateral,
    )
    if kind.steady:
        low = high = float(rng.uniform(low, high))
    changes = np.arange(0.0, duration, 2.5)
    speed = np.stack([changes, rng.uniform(low, high, len(changes))], axis=1)
    turns = np.stack(
        [changes, rng.uniform(-1, 1, len(changes)) * lateral / np.maximum(speed[:, 1], 1.0)], axis=1
    )
    turns[:, 1] *= rng.random(len(changes)) < 0.7
    if kind.circle:
        turns[:, 1] = rng.choice([-1.0, 1.0]) * rng.uniform(0.6, 1.0) * lateral / speed[0, 1]
    times = np.arange(1.0, duration - 0.5, 2.0) + rng.uniform(0, 0.5)
    angle = rng.uniform(0, 2 * np.pi, len(times))
    force = push * np.sqrt(kind.weakest**2 + (1.0 - kind.weakest**2) * rng.random(len(times)))
    pushes = np.stack([times, force * np.cos(angle), force * np.sin(angle), np.full(len(times), 0.1)], axis=1)
    direction, steepness = rng.uniform(0, 2 * np.pi), kind.tilt * np.sqrt(rng.random())
    slope = (float(steepness * np.cos(direction)), float(steepness * np.sin(direction)))
    if kind.climb is not None:
        slope = (float(rng.uniform(*kind.climb)), float(rng.uniform(-0.1, 0.1)))
    sizes = noise * np.concatenate([np.full(3, 0.3), np.full(3, 0.3), np.full(45, 0.05)])
    return Scenario(
        duration=duration,
        speeds=speed,
        headings=turns,
        pushes=pushes if push > 0 else np.zeros((0, 4)),
        tilt=slope,
        walking=int(rng.integers(WALK_STARTS)) if rng.random() < kind.walking else None,
        start_noise=rng.normal(size=51) * sizes if noise > 0 else np.zeros(0),
    )


def cost(trial: Trial, duration: float, style: float, soft: float = 0.0) -> float:
    """Cost of one trial of ``duration`` [s]; ``style`` in [0, 1] weighs looks against survival, ``soft`` is
    the cost of hard landings and of step rates other than equation 8's.

    Errors count as long as the person is up, and the time after a fall as much as the worst error, so that
    falling early does not pay. Every stage asks for the step rate (equation 8 of "Terrain Runner"): long,
    high steps look cheap at first, but cannot be corrected often enough later.
    """
    f = trial.figures
    up = f["time"] / duration
    wanted_rate = _CAPTURED_RATE * (0.2 * f["speed"] / _CAPTURED_SPEED + 0.8)
    wrong = (
        4.0 * f["speed_error"]
        + 1.0 * f["side_drift"]
        + 1.5 * f["heading_error"]
        + 2.0 * f["trunk"]
        + 0.5 * (1.0 + soft) * abs(f["step_rate"] - wanted_rate)
        + style * (4.0 * f["reaction"] + 0.06 * f["effort"] + 0.05 * f["head"])
        + soft * f["landing"]
    )
    return 10.0 * (1.0 - up) + up * min(wrong, 10.0)
