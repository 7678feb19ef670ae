"""Path tracking: where the body is on its path, and the heading and speed to ask of the controller."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import maximum_filter1d

from locomotion.errors import LocomotionError
from locomotion.paths.command import HEADING_ASKED, SIDEWAYS_ASKED, SLOPE_THERE, SPEED_ASKED
from locomotion.paths.gait_plan import Gaits, Way, hard_again, plan_gaits
from locomotion.paths.table import (
    CURVATURE,
    GAIT,
    HEADING,
    RUN,
    SLOPE,
    SPACING,
    SPEED,
    WALK,
    PathTable,
    TrackingLimits,
    X,
    Y,
    Z,
)
from surefoot.kernels import kernel
from surefoot.numeric import as_floats, is_finite

__all__ = [
    "ARC", "BACKED", "HEADWAY", "HEADWAY_TICK", "LATERAL", "PACE", "REMAINING", "SLOPE_HERE", "SPEED_HERE",
    "STARTS", "STOPS_SINCE", "TRACK_SIZE", "TRIED", "WAITED", "back_along", "checked_points", "make_path",
    "new_track", "shifted", "track",
]  # fmt: skip

(
    ARC, LATERAL, INTEGRAL, REMAINING, SPEED_HERE, SLOPE_HERE, HEADWAY, HEADWAY_TICK, PACE, WAITED, BACKED,
    TRIED, STARTS, STOPS_SINCE,
) = range(14)  # fmt: skip
"""The tracker's memory: arc length of the body's foot point [m], distance to the left of the path [m], its
integral [m s], length left [m], planned speed [m/s] and slope here, greatest arc length so far and the
tick at which it last grew by `_STEP`, present share of the planned speed while giving way, ticks of giving
way since then, how often it has gone back to let others pass, the tick at which it found no way to slow
down or began to without having rehearsed it, the tick before which it does not start, and the one since
which it wants to stop without having rehearsed it (0: it does not).
"""
TRACK_SIZE = 14
_STEP = 0.25
_STEP_REACH = 0.7  # [m] around an obstacle's edge where its height would show as slope
_NEAR, _UNEVEN = 0.2, 0.02  # [m] around a step in the ground, and of its height beyond that of a slope
_LEVEL = 0.05  # slope up to which ground is level
_BACK, _AHEAD = 0.5, 1.5  # [m] search window around the last foot point


def checked_points(points: ArrayLike) -> NDArray[np.float64]:
    """``points`` as (n, 3) float64; raises `LocomotionError` for other shapes and numbers not finite."""
    raw = as_floats(points)
    if raw is None:
        raise LocomotionError(f"a path is numbers of the shape (n, 3), not {points!r}")
    if raw.ndim != 2 or raw.shape[1] != 3:
        raise LocomotionError(f"a path has the shape (n, 3), not {raw.shape}")
    if not np.isfinite(raw).all():
        row = int(np.flatnonzero(~np.isfinite(raw).all(axis=1))[0])
        raise LocomotionError(f"point {row} of the path is {raw[row]}; give finite coordinates")
    return raw


def make_path(
    points: ArrayLike,
    speed: float,
    limits: TrackingLimits,
    present_speed: float,
    edges: ArrayLike = (),
    walk: TrackingLimits | None = None,
    running: bool = False,
) -> PathTable:
    """Resample ``points`` (n, 3) [m] and plan the speed along them: at most ``speed`` [m/s], slower in bends,
    on slopes and before the end, starting from ``present_speed`` [m/s]. ``edges`` (k,) are arc lengths [m]
    at which the path crosses an obstacle: the step in height there is not a slope.

    ``limits`` are those of running; without ``walk`` the body runs all the way. With ``walk`` it runs where
    bends and slopes allow it and running is worth it (or it is ``running`` already), and over each edge, from
    `RUN_UP` before it. It walks elsewhere and before the end, and slows down to that in time, or stops where
    there is no room for that. If ``speed`` is nearer to a walk it walks all the way except over edges, faster
    than usual where that is easy.

    Raises `LocomotionError` for fewer than two distinct points, coordinates that are not finite, or a speed
    that is not above 0.
    """
    raw = checked_points(points)
    if not (is_finite(speed) and speed > 0):
        raise LocomotionError(f"speed must be a finite number above 0 m/s, not {speed}")
    keep = np.ones(len(raw), dtype=bool)
    keep[1:] = np.linalg.norm(np.diff(raw[:, :2], axis=0), axis=1) > 1e-6
    distinct = raw[keep]
    if len(distinct) < 2:
        raise LocomotionError("a path needs at least two points that differ in x or y")
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(distinct[:, :2], axis=0), axis=1))])
    length = float(arc[-1])
    count = max(int(np.ceil(length / SPACING)), 1) + 1
    at = np.linspace(0.0, length, count)
    table = np.empty((count, 8))
    for k in range(3):
        table[:, k] = np.interp(at, arc, distinct[:, k])
    _directions(table, length / (count - 1))
    crossed = np.atleast_1d(np.asarray(edges, dtype=np.float64))
    steps = _steps(table, length / (count - 1))
    for edge in crossed:
        table[np.abs(at - edge) < _STEP_REACH, SLOPE] = 0.0
        steps[np.abs(at - edge) < _STEP_REACH] = False
    table[:, GAIT] = RUN
    way, gaits = Way(table, at, steps), Gaits((limits,), np.zeros(count, np.int64))
    if walk is not None:
        gaits = plan_gaits(way, speed, limits, walk, crossed, present_speed, running)
    _plan_speed(way, length / (count - 1), speed, gaits, present_speed)
    return PathTable(table, length, distinct[-1].copy())


def _directions(table: NDArray[np.float64], step: float) -> None:
    """Heading, curvature and slope from differences over about 0.4 m (slope: 1 m)."""
    n = len(table)
    index = np.arange(n)
    near, far = (max(round(d / step), 1) for d in (0.2, 0.5))
    low, high = np.maximum(index - near, 0), np.minimum(index + near, n - 1)
    dx, dy = table[high, X] - table[low, X], table[high, Y] - table[low, Y]
    table[:, HEADING] = np.unwrap(np.arctan2(dy, dx))
    table[:, CURVATURE] = (table[high, HEADING] - table[low, HEADING]) / ((high - low) * step)
    low, high = np.maximum(index - far, 0), np.minimum(index + far, n - 1)
    table[:, SLOPE] = (table[high, Z] - table[low, Z]) / ((high - low) * step)


def _steps(table: NDArray[np.float64], step: float) -> NDArray[np.bool_]:
    """(n,) bool: where the ground steps up or down, instead of sloping."""
    near = max(round(_NEAR / step), 1)
    high, low = np.roll(table[:, Z], -near), np.roll(table[:, Z], near)
    found = np.abs(high - low - 2.0 * near * step * table[:, SLOPE]) > _UNEVEN
    found[:near] = found[-near:] = False
    return found


def _plan_speed(way: Way, step: float, speed: float, gaits: Gaits, present: float) -> None:
    """``gaits``: the limits at each point of the path."""
    table, _, steps = way
    each = [
        (*g.speeds, g.sideways, *g.tight, g.acceleration, g.deceleration, g.uphill, g.downhill, g.foresight,
         g.steps)
        for g in gaits.kinds
    ]  # fmt: skip
    slowest, fastest, sideways, tight, turning, faster, slower, uphill, downhill, foresight, over_steps = (
        np.ascontiguousarray(np.array(each).T[:, gaits.at])
    )
    slope = table[:, SLOPE]
    wished = np.minimum(_speed_in_bends(table, sideways, tight, turning), np.minimum(speed, fastest))
    slowed = uphill * np.maximum(slope, 0.0) + downhill * np.maximum(-slope, 0.0)
    seen = round(float(foresight.max()) / step) + 1  # points, this one included
    ahead = maximum_filter1d(slowed, seen, mode="nearest", origin=-(seen // 2))
    wished = wished - np.where(foresight > 0.0, ahead, slowed)
    near_steps = maximum_filter1d(steps.view(np.uint8), 2 * seen - 1) > 0
    wished = np.where(near_steps, np.minimum(wished, over_steps), wished)
    wished = np.maximum(wished, slowest)
    wished[-1] = slowest[-1]
    squares = wished * wished
    _slow_down_in_time(squares, slower, step)
    squares[0] = min(squares[0], max(present, slowest[0]) ** 2 + faster[0] * step)
    _speed_up_in_time(squares, faster, step)
    table[:, SPEED] = np.sqrt(squares)


@kernel
def _slow_down_in_time(squares, slower, step):
    """Lower the squares (n,) of speeds so that decelerations of ``slower`` (n,) [m/s²] do."""
    for i in range(len(squares) - 2, -1, -1):
        squares[i] = min(squares[i], squares[i + 1] + 2.0 * slower[i] * step)


@kernel
def _speed_up_in_time(squares, faster, step):
    """The same for accelerations."""
    for i in range(1, len(squares)):
        squares[i] = min(squares[i], squares[i - 1] + 2.0 * faster[i - 1] * step)


def _speed_in_bends(
    table: NDArray[np.float64], sideways: ArrayLike, speed: ArrayLike, rate: ArrayLike
) -> NDArray[np.float64]:
    """[m/s] at most at each point of the path, by its curvature. ``sideways``, ``speed`` and ``rate``, (n,)
    or (): `TrackingLimits.sideways` and `TrackingLimits.tight`."""
    bend = np.maximum(np.abs(table[:, CURVATURE]), 1e-6)
    tight = np.where(np.abs(table[:, SLOPE]) < _LEVEL, np.minimum(speed, rate / bend), 0.0)
    return np.maximum(np.sqrt(sideways / bend), tight)


def shifted(
    path: PathTable, arc: float, shift: ArrayLike, limits: TrackingLimits, walk: TrackingLimits | None = None
) -> PathTable:
    """``path`` with the part after ``arc`` [m] moved by ``shift`` (k, 2) [m], one row for every 0.1 m; slower
    where the new bends require it. Arc lengths are still those of the old path. ``limits`` and ``walk`` as
    for `make_path`.
    """
    move = np.asarray(shift, dtype=np.float64)
    table = path.table.copy()
    step = path.length / (len(table) - 1)
    along = np.asarray(step * np.arange(len(table)), dtype=np.float64)
    given = arc + SPACING * np.arange(len(move))
    for column in (X, Y):
        table[:, column] += np.interp(along, given, move[:, column], left=0.0, right=0.0)
    _directions(table, step)
    table[:, SLOPE] = path.table[:, SLOPE]
    present = walk or limits
    bends = _speed_in_bends(table, present.sideways, *present.tight)
    squares = np.minimum(table[:, SPEED], np.maximum(bends, present.speeds[0])) ** 2
    _slow_down_in_time(squares, np.full(len(squares), present.deceleration), step)
    table[:, SPEED] = np.sqrt(squares)
    if walk is not None:
        hard_again(table, step, limits, walk)
    return replace(path, table=table)


def back_along(path: PathTable, arc: float, to: float, walk: TrackingLimits) -> PathTable:
    """The way back along ``path`` from arc length ``arc`` to ``to`` [m], walking."""
    step = path.length / (len(path.table) - 1)
    first, last = round(to / step), max(round(arc / step), round(to / step) + 1)
    back = make_path(path.table[first : last + 1, :3][::-1], walk.calm, walk, 0.0)
    back.table[:, GAIT] = WALK
    return back


def new_track() -> NDArray[np.float64]:
    """Initial memory of the tracker, (TRACK_SIZE,) float64."""
    memory = np.zeros(TRACK_SIZE)
    memory[PACE] = 1.0
    return memory


@kernel
def _at(table, step, arc, column):
    place = min(max(arc / step, 0.0), table.shape[0] - 1.0)
    i = min(int(place), table.shape[0] - 2)
    w = place - i
    return (1.0 - w) * table[i, column] + w * table[i + 1, column]


@kernel
def track(table, length, gains, memory, x, y, speed, tick, command):
    """One tick: find the body's foot point; write heading, speed, side speed, slope into ``command`` (4,).

    table (n, 7), length: a `PathTable`. gains (6,): preview time [s], lateral rate [1/s], integral rate
    [1/s^2], largest correction [rad], sideways rate [1/s], largest sideways speed [m/s].
    memory (TRACK_SIZE,). x, y: centre of mass [m]. speed: along the path [m/s]. tick: number of the tick.
    """
    n = table.shape[0]
    step = length / (n - 1)
    first = min(max(int((memory[ARC] - _BACK) / step), 0), n - 2)
    last = min(max(int((memory[ARC] + _AHEAD) / step), first + 1), n - 1)
    best, arc = math.inf, memory[ARC]
    for i in range(first, last):
        ex, ey = table[i + 1, X] - table[i, X], table[i + 1, Y] - table[i, Y]
        rx, ry = x - table[i, X], y - table[i, Y]
        w = (rx * ex + ry * ey) / max(ex * ex + ey * ey, 1e-12)
        w = min(max(w, 0.0), 1.0)
        qx, qy = rx - w * ex, ry - w * ey
        distance = qx * qx + qy * qy
        if distance < best:
            best, arc = distance, (i + w) * step
    heading = _at(table, step, arc, HEADING)
    px, py = _at(table, step, arc, X), _at(table, step, arc, Y)
    lateral = -math.sin(heading) * (x - px) + math.cos(heading) * (y - py)
    memory[ARC] = arc
    memory[LATERAL] = lateral
    memory[REMAINING] = length - arc
    if arc > memory[HEADWAY] + _STEP:
        memory[HEADWAY], memory[HEADWAY_TICK], memory[WAITED] = arc, tick, 0.0
    pace = max(speed, 1.0)
    if abs(lateral) < 0.5:
        memory[INTEGRAL] = min(max(memory[INTEGRAL] + 0.01 * lateral, -0.5), 0.5)
    correction = (gains[1] * lateral + gains[2] * memory[INTEGRAL]) / pace
    correction = min(max(correction, -gains[3]), gains[3])
    preview = _at(table, step, arc + pace * gains[0], HEADING)
    memory[SPEED_HERE] = _at(table, step, arc + 0.3 * pace, SPEED)
    memory[SLOPE_HERE] = _at(table, step, arc, SLOPE)
    command[HEADING_ASKED] = preview - correction
    command[SPEED_ASKED] = memory[SPEED_HERE]
    command[SIDEWAYS_ASKED] = min(max(-gains[4] * lateral, -gains[5]), gains[5])
    command[SLOPE_THERE] = memory[SLOPE_HERE]
