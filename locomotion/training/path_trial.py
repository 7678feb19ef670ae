"""Trials of following paths: winding ways over level and rolling ground, run as a mission runs them."""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from locomotion import controller as c
from locomotion.body import Human
from locomotion.ground import Ground
from locomotion.human_state import MOVING
from locomotion.person import CONTROL_DT
from locomotion.skill import RunSkill
from locomotion.training.rollout import Measures, Trial

__all__ = ["PathScenario", "draw_path", "follow_path", "rolling_height"]

HALF = 40.0
"""Half the side [m] of the training ground: level for x < 0, rolling ever more steeply for x > 0."""
_MESH = 0.5  # [m] side of the training ground's squares
_WAVES = ((0.9, 0.35, 0.4), (-0.4, 0.8, 1.9), (0.55, -0.65, 3.1))  # (wave numbers x, y [1/m], phase)
_PACE = 0.25  # [m] between a path's points
_TURN_IN = 1.0  # [m] along which a path goes over from one curvature to the next


@dataclass(frozen=True)
class PathScenario:
    """One path to follow.

    points: (n, 3) float64 [m]; speed: wished [m/s]; pushes: (j, 3) rows of time [s] and force x, y [N] on
    the chest for 0.1 s.
    """

    points: np.ndarray
    speed: float
    pushes: np.ndarray

    @property
    def duration(self) -> float:
        """Time [s] that the path may take at most."""
        length = float(np.linalg.norm(np.diff(self.points[:, :2], axis=0), axis=1).sum())
        return 3.0 + length / 1.2


def rolling_height(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Height of the training ground [m]: slopes up to 0.35 at its right end."""
    waves = sum(np.sin(kx * x + ky * y + phase) / math.hypot(kx, ky) for kx, ky, phase in _WAVES)
    return 0.2 * np.clip(x / HALF, 0.0, 1.0) * waves


@lru_cache(maxsize=1)
def _ground() -> Ground:
    n = round(2 * HALF / _MESH) + 1
    line = np.linspace(-HALF, HALF, n)
    x, y = (g.ravel() for g in np.meshgrid(line, line, indexing="ij"))
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    a, b, d, e = corner, corner + n, corner + n + 1, corner + 1
    faces = np.concatenate([np.stack([a, b, d], axis=1), np.stack([a, d, e], axis=1)])
    return Ground.from_arrays(np.stack([x, y, rolling_height(x, y)], axis=1), faces)


def draw_path(
    rng: np.random.Generator,
    length: tuple[float, float] = (8.0, 18.0),
    speeds: tuple[float, float] = (2.0, 3.5),
    radius: float = 1.3,
    rolling: float = 0.5,
    push: float = 0.0,
) -> PathScenario:
    """A random winding path.

    length [m] and speeds [m/s]: ranges drawn from; radius: of the tightest bends [m]; rolling: share of
    the paths over rolling ground; push: highest force [N] of pushes every 3 s or so.
    """
    count = max(round(rng.uniform(*length) / _PACE), 8)
    curvature = np.empty(0)
    while len(curvature) < count:
        bend = rng.uniform(-1.0, 1.0) / radius * (rng.random() < 0.65)
        span = rng.uniform(1.0, 4.0) if bend == 0.0 else rng.uniform(0.3, 1.8) / max(abs(bend), 0.15)
        curvature = np.concatenate([curvature, np.full(max(round(span / _PACE), 2), bend)])
    window = round(_TURN_IN / _PACE)
    curvature = np.convolve(np.pad(curvature, window, mode="edge"), np.full(window, 1.0 / window), "same")
    curvature = curvature[window : window + count]
    heading = rng.uniform(-np.pi, np.pi) + np.concatenate([[0.0], np.cumsum(curvature * _PACE)[:-1]])
    points = np.zeros((count + 1, 3))
    points[1:, 0], points[1:, 1] = np.cumsum(_PACE * np.cos(heading)), np.cumsum(_PACE * np.sin(heading))
    low, high = points.min(axis=0), points.max(axis=0)
    side = (2.0, HALF - 2.0) if rng.random() < rolling else (2.0 - HALF, -2.0)
    margin = HALF - 2.0
    points[:, 0] += rng.uniform(side[0] - low[0], max(side[1] - high[0], side[0] - low[0]))
    points[:, 1] += rng.uniform(-margin - low[1], margin - high[1])
    points[:, 2] = rolling_height(points[:, 0], points[:, 1])
    times = np.arange(rng.uniform(1.0, 3.0), 20.0, 3.0)
    angle, force = rng.uniform(0, 2 * np.pi, len(times)), push * np.sqrt(rng.random(len(times)))
    pushes = np.stack([times, force * np.cos(angle), force * np.sin(angle)], axis=1)
    return PathScenario(points, float(rng.uniform(*speeds)), pushes if push > 0.0 else np.zeros((0, 3)))


def follow_path(skill: RunSkill, scenario: PathScenario) -> Trial:
    """Follow the path from a held start; the figure ``time`` is the share of the path covered, times the
    scenario's duration."""
    human = Human(_ground(), skill, clearing=())
    points = scenario.points
    yaw = math.atan2(points[1, 1] - points[0, 1], points[1, 0] - points[0, 0])
    human.reset(points[0], yaw)
    human.follow(points, scenario.speed)
    measures = Measures(human.data, human.index)
    push, state = human.data.xfrc_applied[human.index.chest], human.control
    aside, ticks = 0.0, 0
    while human.status in MOVING and ticks * CONTROL_DT < scenario.duration:
        time = ticks * CONTROL_DT
        push[:2] = 0.0
        for start, fx, fy in scenario.pushes:
            if start <= time < start + 0.1:
                push[:2] = fx, fy
        human.tick()
        ticks += 1
        aside += min(abs(human.lateral_error), 1.0)
        measures.add(state, float(state[c.TURN_RATE]), float(state[c.SPEED]))
    length = float(np.linalg.norm(np.diff(points[:, :2], axis=0), axis=1).sum())
    done = 1.0 if human.status == "arrived" else min(human.arc_length / length, 0.99)
    figures = measures.figures(state, ticks)
    figures["time"] = done * scenario.duration
    figures["side_drift"] = 2.0 * aside / max(ticks, 1)
    return Trial(figures, np.concatenate([human.qpos, state]))
