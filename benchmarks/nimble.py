"""How soon a person has its speed, and from where on it no longer runs before a goal.

    python -m benchmarks.nimble [--speed 3.5] [--starts 12] [--seed 1]

A person in a world stands on level ground and is sent straight ahead, each time in another direction and
over another distance of 30 to 40 m. Its speed is the mean over the time of a step, 0.36 s. Printed, with
medians and the worst: the time [s] and the way [m] until it has 95 % of the speed asked for, and how far from
its goal [m] it was when it last had 2.2 m/s; below that people walk.
"""

import argparse
import math

import numpy as np
from numpy.typing import NDArray

from benchmarks.walks import hall
from locomotion.body.person import CONTROL_DT
from runtime import Fell, World

__all__ = ["before_goal", "speeds", "to_speed"]

_SIDE = 90.0  # [m] of the floor
_STEP = 36  # ticks
_HAS, _WALKS = 0.95, 2.2  # share of the speed asked for; [m/s]
_LIMIT = 40.0  # [s]


def speeds(places: NDArray[np.float64]) -> NDArray[np.float64]:
    """Speed [m/s] at each of the ``places`` (n, 2), one a tick: the mean over a step around it."""
    half = _STEP // 2
    padded = np.pad(places, ((half, half), (0, 0)), mode="edge")
    return np.linalg.norm(padded[2 * half :] - padded[: -2 * half], axis=1) / (2 * half * CONTROL_DT)


def to_speed(places: NDArray[np.float64], speed: float) -> tuple[float, float]:
    """Time [s] and way [m] until somebody has the ``speed``, infinite if it never has."""
    has = np.flatnonzero(speeds(places) >= _HAS * speed)
    if not len(has):
        return math.inf, math.inf
    return float(has[0] * CONTROL_DT), float(np.linalg.norm(places[has[0]] - places[0]))


def before_goal(places: NDArray[np.float64], goal: NDArray[np.float64]) -> float:
    """How far [m] from the ``goal`` (2,) somebody last ran; infinite if it never did."""
    runs = np.flatnonzero(speeds(places) >= _WALKS)
    return float(np.linalg.norm(places[runs[-1]] - goal)) if len(runs) else math.inf


def run(speed: float, rng: np.random.Generator) -> tuple[NDArray[np.float64], NDArray[np.float64], bool]:
    """A run from a stand to a stand: ``places`` (n, 2), ``goal`` (2,), and whether it held."""
    world = World(hall(_SIDE), seed=int(rng.integers(1 << 31)))
    heading, middle = float(rng.uniform(-math.pi, math.pi)), np.full(2, 0.5 * _SIDE)
    goal = middle + rng.uniform(30.0, 40.0) * np.array([math.cos(heading), math.sin(heading)])
    agent = world.spawn("human", (*middle, 0.0), heading)
    for _ in range(round(1.0 / CONTROL_DT)):
        world.step(CONTROL_DT)
    agent.go_to((*goal, 0.0), speed=speed)
    places, held = [agent.position[:2].copy()], True
    while agent.moving and len(places) * CONTROL_DT < _LIMIT:
        world.step(CONTROL_DT)
        places.append(agent.position[:2].copy())
        held &= not any(isinstance(event, Fell) for event in world.events)
    return np.array(places), goal, held and agent.status == "arrived"


def main() -> None:
    """Print medians and the worst."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--speed", type=float, default=3.5, help="[m/s]")
    parser.add_argument("--starts", type=int, default=12)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    found, held = [], 0
    for k in range(options.starts):
        places, goal, arrived = run(options.speed, np.random.default_rng([options.seed, k]))
        held += arrived
        found.append((*to_speed(places, options.speed), before_goal(places, goal)))
    print(f"{held} of {options.starts} arrive at {options.speed:g} m/s")
    rows = (
        f"time to {_HAS * options.speed:.2f} m/s [s]",
        "way to it [m]",
        f"below {_WALKS} m/s before a goal [m]",
    )
    for name, values in zip(rows, np.array(found).T, strict=True):
        print(f"{name:34} median {np.median(values):5.2f}, worst {values.max():5.2f}")


if __name__ == "__main__":
    main()
