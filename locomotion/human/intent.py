"""The path a person intends to take, for others to avoid."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from locomotion.avoidance.yielding import AT_ONCE, HORIZON, SPACING, TURNING_SPEED, Course
from locomotion.gaits.limits import PERSON_RULES
from locomotion.gaits.walk.steps import TURN_RATE
from locomotion.paths import table as path_table
from locomotion.paths.follower import PathFollower
from locomotion.paths.table import TrackingLimits
from surefoot.kernels import kernel

__all__ = ["TURN_FIRST", "course_on_way", "course_to_rest"]

TURN_FIRST = 0.7
"""[rad] off its path's direction at which a walking person turns on the spot."""
_WALK_BEND, _RUN_BEND = 1.0, 0.1
"""[1/m] sharpest curve with which it steps aside; in bends sharper than it has learned to slow down in, a
runner falls behind those it has met (`python -m benchmarks.giving_way --pairs runner-runner`)."""
_WALK_BEGINS, _RUN_BEGINS = 0.5, 1.0  # [m] ahead where it starts to step aside
_SETTING_OFF = 0.5  # [s] for the first step after a turn on the spot
_BESIDE = 0.3  # [m] from its path beyond which it walks there first
_BERTH = 0.14  # [m] added: it sways beside its path, and drifts while turning on the spot
_RADIUS = PERSON_RULES["radius"] + _BERTH


def course_on_way(
    follower: PathFollower,
    limits: TrackingLimits,
    place: NDArray[np.float64],
    velocity: NDArray[np.float64],
    walks: bool,
    facing: float,
    aside: bool,
    turns_first: float = TURN_FIRST,
) -> Course:
    """Course of a person at ``place`` (3,) with ``velocity`` (3,), facing ``facing`` [rad]; if its path leads
    elsewhere by more than ``turns_first`` [rad], it stops and turns first. ``aside``: whether its path may be
    changed."""
    path = follower.path
    assert path is not None
    arc, step = follower.arc, path.length / (len(path.table) - 1)
    far = arc + 2.0 * HORIZON * limits.speeds[1]
    count = math.ceil((min(path.length, far) + 1e-9 - arc) / SPACING)
    points, speeds, headings = np.empty((count, 3)), np.empty(count), np.empty(count)
    _read_path(path.table, arc / step, SPACING / step, limits.speeds[1], points, speeds, headings)
    speed, turns = math.hypot(*velocity[:2].tolist()), 0.0
    ahead = headings[min(round(_WALK_BEGINS / SPACING), count - 1)]
    off = abs(math.remainder(ahead - facing, 2.0 * math.pi))
    before = place[None]
    if off > turns_first:
        turns = (off - TURN_FIRST) / TURN_RATE + _SETTING_OFF
        if speed > TURNING_SPEED:  # it goes straight on until it is slow enough
            before = _straight_on(place, velocity, speed * speed / (2.0 * limits.deceleration))
    away = float(np.linalg.norm(before[-1, :2] - points[0, :2]))
    if len(before) > 1 or away > _BESIDE:
        back = np.linspace(before[-1], points[0], max(round(away / SPACING), 1), endpoint=False)
        points, aside = np.concatenate([before[:-1], back, points]), False
        speeds = np.concatenate([np.full(len(points) - len(speeds), speeds[0]), speeds])
    goes_back = follower.interrupted is not None
    return replace(
        _course(points, speeds, speed, limits, walks),
        pace=follower.pace,
        aside=aside and not goes_back,
        whole=path.length <= far and not goes_back,
        stops=limits.rest if walks else limits.rest + (speed * speed) / (2.0 * limits.slowing),
        turns=turns,
    )


@kernel
def _read_path(table, first, step, fastest, points, speeds, headings):
    """Write what a path's ``table`` has every ``step`` rows from row ``first`` on, at speeds of up to
    ``fastest`` [m/s]."""
    last = table.shape[0] - 1
    for n in range(points.shape[0]):
        row = min(first + n * step, float(last))
        i = max(min(int(row), last - 1), 0)
        w = row - i
        before, after = table[i], table[min(i + 1, last)]
        for k in range(3):
            points[n, k] = (1.0 - w) * before[path_table.X + k] + w * after[path_table.X + k]
        at = path_table.SPEED
        speeds[n] = min((1.0 - w) * before[at] + w * after[at], fastest)
        at = path_table.HEADING
        headings[n] = (1.0 - w) * before[at] + w * after[at]


def course_to_rest(
    place: NDArray[np.float64], velocity: NDArray[np.float64], limits: TrackingLimits
) -> Course:
    """Course of a person at ``place`` (3,) that stops from ``velocity`` (3,)."""
    speed = float(np.linalg.norm(velocity[:2]))
    points = _straight_on(place, velocity, speed * speed / (2.0 * limits.deceleration))
    return _course(points, np.zeros(len(points)), speed, limits, walks=True)


def _course(
    points: NDArray[np.float64],
    speeds: NDArray[np.float64],
    speed: float,
    limits: TrackingLimits,
    walks: bool,
) -> Course:
    """A course that ends standing and cannot be changed."""
    return Course(
        points=points,
        speeds=speeds,
        speed=speed,
        pace=0.0,
        length=0.0,
        reach=0.0,
        radius=_RADIUS,
        acceleration=limits.acceleration,
        braking=limits.deceleration,
        eagerness=AT_ONCE,
        slowest=0.0 if walks else limits.speeds[0],
        sharpest=_WALK_BEND if walks else _RUN_BEND,
        begins=_WALK_BEGINS if walks else _RUN_BEGINS,
        aside=False,
        whole=False,
        stops=0.0,
    )


def _straight_on(
    place: NDArray[np.float64], velocity: NDArray[np.float64], length: float
) -> NDArray[np.float64]:
    """(k, 3) points every `SPACING` from ``place`` in the direction of ``velocity``, at least two."""
    flat = np.array([velocity[0], velocity[1], 0.0])
    ahead = flat / max(float(np.linalg.norm(flat)), 1e-9)
    return place + SPACING * np.arange(max(round(length / SPACING), 1) + 1)[:, None] * ahead
