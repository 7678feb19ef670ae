"""Trying a learned skill from many starts: how often does it hold?"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from locomotion import MOVING, Ground, Human, LocomotionError, ObstacleAhead
from locomotion.person import CONTROL_DT
from runtime.clearing_trials import vault_attempt
from runtime.drop_trials import drop_attempt
from runtime.progress import Progress

__all__ = [
    "Attempt",
    "evaluate_drop_roll",
    "evaluate_jump",
    "evaluate_run",
    "evaluate_vault",
    "evaluate_walk",
]

RUN_LENGTH = 60.0
"""[m] of each run."""
PUSH, PUSH_TIME, PUSH_EVERY = 200.0, 0.1, 5.0
"""[N], [s] and [s] between: pushes on the pelvis from any side."""
NEAREST, FARTHEST = 10.0, 30.0
"""[m] from the start to the obstacle of a jump."""
_AFTER = 12.0
"""[m] to run on after a jump."""
_SLOWEST = 0.5


@dataclass(frozen=True)
class Attempt:
    """One trial: what was tried, the status that it ended with, and whether that is a success."""

    what: str
    status: str
    held: bool


def evaluate_run(trials: int, seed: int, progress: Progress) -> list[Attempt]:
    """Straight runs of 60 m on a plane at random speeds, with a push from a random side every 5 s."""
    attempts = []
    with progress.stage("running") as stage:
        for k in range(trials):
            rng = np.random.default_rng([seed, k])
            human = Human()
            speed = float(rng.uniform(*human.skill.speeds))
            yaw = float(rng.uniform(-math.pi, math.pi))
            path = np.outer([0.0, RUN_LENGTH], [math.cos(yaw), math.sin(yaw), 0.0])
            human.reset(path[0], yaw)
            human.follow(path, speed)
            pelvis = human.index.root
            for force in _pushes(rng):
                human.data.xfrc_applied[pelvis, :2] = force
                human.tick()
                if human.status not in MOVING or human.time > RUN_LENGTH / _SLOWEST:
                    break
            attempts.append(Attempt(f"{speed:.2f} m/s", human.status, human.status == "arrived"))
            stage.update((k + 1) / trials, f"{sum(each.held for each in attempts)} of {k + 1} held")
    return attempts


def evaluate_walk(trials: int, seed: int, progress: Progress) -> list[Attempt]:
    """Winding paths on level, rolling, bumpy and steep ground and over ramps, with pushes of up to 80 N on
    the level."""
    from locomotion.training.path_trial import draw_path, follow_path
    from locomotion.training.walk import KINDS

    kinds = list(KINDS.items())
    attempts = []
    with progress.stage("walking") as stage:
        for k in range(trials):
            name, kind = kinds[k % len(kinds)]
            scenario = draw_path(np.random.default_rng([seed, k]), **kind)
            arrived = follow_path(scenario).figures["time"] >= scenario.duration
            what = f"{name}, {scenario.length:.1f} m at {scenario.speed:.2f} m/s"
            attempts.append(Attempt(what, "arrived" if arrived else "did not arrive", arrived))
            stage.update((k + 1) / trials, f"{sum(each.held for each in attempts)} of {k + 1} held")
    return attempts


def evaluate_jump(trials: int, seed: int, progress: Progress) -> list[Attempt]:
    """Run-ups of 10 to 30 m to a stair of a height that the skill was learned for, then 12 m on top."""
    attempts = []
    skills = [skill for skill in Human().clearing if skill.affordance == "jump"]
    if not skills:
        raise LocomotionError("there is no jump for this run; learn one with: surefoot train jump")
    with progress.stage("jumping") as stage:
        for k in range(trials):
            rng = np.random.default_rng([seed, k])
            height = round(float(rng.uniform(*skills[0].heights)), 2)
            distance = float(rng.uniform(NEAREST, FARTHEST))
            human = Human(Ground.from_arrays(*_stair(height)))
            edge = np.array([0.0, 0.0, height])
            path = np.array([[-distance, 0, 0], [-1e-3, 0, 0], [1e-3, 0, height], [_AFTER, 0, height]])
            human.reset(path[0], 0.0)
            ahead = ObstacleAhead(distance, "jump", height, edge, np.array([-1.0, 0.0, 0.0]))
            human.follow(path, human.skill.speeds[1], [ahead])
            while human.status in MOVING and human.time < (FARTHEST + _AFTER) / _SLOWEST:
                human.tick()
            what = f"{height:.2f} m from {distance:.1f} m"
            attempts.append(Attempt(what, human.status, human.status == "arrived"))
            stage.update((k + 1) / trials, f"{sum(each.held for each in attempts)} of {k + 1} held")
    return attempts


def evaluate_vault(trials: int, seed: int, progress: Progress) -> list[Attempt]:
    """Run-ups of 10 to 30 m to a wall of a height that the skill was learned for, 0.2 to 0.4 m thick, then
    12 m behind it."""
    attempts = []
    skills = [skill for skill in Human().clearing if skill.affordance == "vault"]
    if not skills:
        raise LocomotionError("there is no vault for this run; learn one with: surefoot train vault")
    with progress.stage("vaulting") as stage:
        for k in range(trials):
            rng = np.random.default_rng([seed, k])
            height, depth = round(float(rng.uniform(*skills[0].heights)), 2), float(rng.uniform(0.2, 0.4))
            result = vault_attempt(height, depth, float(rng.uniform(NEAREST, FARTHEST)))
            status = (
                result.ended if result.vaulted or result.ended != "arrived" else "arrived without its hand"
            )
            what = f"{height:.2f} m from {result.distance:.1f} m"
            attempts.append(Attempt(what, status + ", touched the wall" * result.touched, result.vaulted))
            stage.update((k + 1) / trials, f"{sum(each.held for each in attempts)} of {k + 1} held")
    return attempts


def evaluate_drop_roll(trials: int, seed: int, progress: Progress) -> list[Attempt]:
    """Run-ups of 10 to 30 m to a ledge of a height that the skill was learned for, then 15 m below it."""
    attempts = []
    skills = [skill for skill in Human().clearing if skill.affordance == "drop"]
    if not skills:
        raise LocomotionError("there is no drop-roll for this run; learn one with: surefoot train drop-roll")
    with progress.stage("rolling off drops") as stage:
        for k in range(trials):
            rng = np.random.default_rng([seed, k])
            height = round(float(rng.uniform(*skills[0].heights)), 2)
            result = drop_attempt(height, float(rng.uniform(NEAREST, FARTHEST)))
            what = f"{height:.2f} m from {result.distance:.1f} m"
            status = f"{result.ended}, {result.peak:.1f} body weights, head {result.head:.2f} s"
            attempts.append(Attempt(what, status, result.ended == "arrived"))
            stage.update((k + 1) / trials, f"{sum(each.held for each in attempts)} of {k + 1} held")
    return attempts


def _pushes(rng: np.random.Generator) -> Iterator[np.ndarray]:
    """Horizontal force (2,) [N] of each tick."""
    ticks, length = round(PUSH_EVERY / CONTROL_DT), round(PUSH_TIME / CONTROL_DT)
    while True:
        begin = int(rng.integers(ticks // 2, ticks - length))
        side = rng.uniform(-math.pi, math.pi)
        force = PUSH * np.array([math.cos(side), math.sin(side)])
        for tick in range(ticks):
            yield force if begin <= tick < begin + length else np.zeros(2)


def _stair(height: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces: a floor before x = 0 and one ``height`` [m] above it behind."""
    corners, faces = [], []
    for quad in (
        [(-40, -4, 0), (0, -4, 0), (0, 4, 0), (-40, 4, 0)],
        [(0, 4, 0), (0, -4, 0), (0, -4, height), (0, 4, height)],
        [(0, -4, height), (20, -4, height), (20, 4, height), (0, 4, height)],
    ):
        first = len(corners)
        corners += quad
        faces += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return np.array(corners, dtype=np.float64), np.array(faces)
