"""Following a path: where the body is on it, and the heading and speed to ask of the controller."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import maximum_filter1d

from locomotion.errors import LocomotionError

__all__ = [
    "ARC", "BACKED", "COME_TO_REST", "FAST_WALK", "GAIT", "HEADWAY", "HEADWAY_TICK", "LATERAL", "PACE",
    "REMAINING", "RUN", "RUN_UP", "SLOPE_HERE", "SPEED_HERE", "TRACK_SIZE", "WAITED", "WALK", "PathTable",
    "TrackingLimits", "back_along", "checked_points", "make_path", "new_track", "shifted", "track",
]  # fmt: skip

SPACING = 0.1
"""Spacing of a path's table [m]."""
X, Y, Z, HEADING, CURVATURE, SLOPE, SPEED, GAIT = range(8)
"""Columns of a path's table; `GAIT` is one of the following."""
FAST_WALK, WALK, RUN = -1.0, 0.0, 1.0
"""The body walks as fast as the path says; walks at its usual speed at most, or slows down to that; runs."""
(
    ARC, LATERAL, INTEGRAL, REMAINING, SPEED_HERE, SLOPE_HERE, HEADWAY, HEADWAY_TICK, PACE, WAITED, BACKED
) = range(11)  # fmt: skip
"""What the tracker remembers: arc length of the body's foot point [m], distance to the left of the path [m],
its integral [m s], length left [m], planned speed [m/s] and slope here, greatest arc length so far and the
tick at which it grew last by `_STEP`, share of the planned speed at which it goes to give way, ticks for
which it has done so since then, and how often it has gone back to let others by."""
TRACK_SIZE = 11
RUN_UP = 15.0
"""[m] before an obstacle, along the path, from which a body runs and the speed of each step is planned."""
_STEP = 0.25
_STEP_REACH = 0.7  # [m] around an obstacle's edge where its height would show as slope
_WORTH_IT = 4.0  # [m] that are run at least, before it slows down
COME_TO_REST = 2.0
"""[m] that are walked before the end."""
_BEFORE = 1.0  # [m] that are walked before what cannot be run
_BETWEEN = 4.0  # [m] that are walked between two runs at least
_LEVEL, _STRAIGHT = 0.05, 0.15  # slope, and curvature [1/m], up to which it walks faster than usual
_BEGINS = 2.0  # [m] that are walked as usual first, unless one is faster already:
_ALREADY = 0.15  # [m/s] faster than usual
_CALM = 4.0  # [m] before a run that are walked no faster than usual: runs are begun from that
_LANDED = 5.0  # [m] behind an obstacle's edge that are run
_BACK, _AHEAD = 0.5, 1.5  # [m] search window around the last foot point


@dataclass(frozen=True)
class TrackingLimits:
    """What a running body can follow.

    Attributes:
        speeds: lowest and highest speed [m/s].
        sideways: [m/s^2] highest sideways acceleration in a bend.
        acceleration, deceleration: [m/s^2] of the planned speed along the path.
        uphill, downhill: [m/s per unit of slope] taken off the wished speed on a slope.
        sharpest: curvature [1/m] and steepest: slope [rise over run] above which it does not go this way.
        slowing: [m/s^2] at which it slows down from a run to a walk.
        foresight: [m] before a slope at which it already goes as fast as on it.
        usual: [m/s] of a walk at most, but where a faster walk is asked for, straight on, on level ground,
            away from runs.
    """

    speeds: tuple[float, float]
    sideways: float = 2.5
    acceleration: float = 1.5
    deceleration: float = 0.8
    uphill: float = 2.0
    downhill: float = 4.0
    sharpest: float = math.inf
    steepest: float = math.inf
    slowing: float = 0.6
    foresight: float = 0.0
    usual: float = math.inf

    @property
    def calm(self) -> float:
        """[m/s] of a walk at most, where no faster one is asked for."""
        return min(self.usual, self.speeds[1])


@dataclass(frozen=True)
class PathTable:
    """A path resampled every 0.1 m of horizontal length.

    Attributes:
        table: (n, 8) float64: x, y, z [m], heading [rad, unwrapped], curvature [1/m, left positive], slope
            (rise per length), planned speed [m/s], gait.
        length: horizontal length [m].
        goal: (3,) float64, its last point.
    """

    table: NDArray[np.float64]
    length: float
    goal: NDArray[np.float64]

    def runs(self, arc: float) -> bool:
        """Whether the body is to run at this arc length [m]."""
        return bool(self._gait(arc) == RUN)

    def walks_fast(self, arc: float) -> bool:
        """Whether it may walk faster than usual there."""
        return bool(self._gait(arc) == FAST_WALK)

    def _gait(self, arc: float) -> float:
        last = len(self.table) - 1
        return self.table[min(max(round(arc / self.length * last), 0), last), GAIT]


def checked_points(points: ArrayLike) -> NDArray[np.float64]:
    """``points`` as (n, 3) float64; raises `LocomotionError` for other shapes and numbers not finite."""
    raw = np.asarray(points, dtype=np.float64)
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
    """Resample ``points`` (n, 3) [m] and plan the speed along it: at most ``speed`` [m/s], slower in bends,
    on slopes and before the end, starting from ``present_speed`` [m/s]. ``edges`` (k,) are arc lengths [m] at
    which the path goes over an obstacle: the step in height there is no slope.

    ``limits`` are those of running; without ``walk`` the body runs all the way. With ``walk`` it runs where
    bends and slopes allow it and where a run is worth it (or it is ``running`` already), and over an edge,
    from `RUN_UP` before it; it walks elsewhere and before the end, and slows down to that in time. Whose
    ``speed`` is nearer to a walk walks all the way but over edges, faster than usual where that is easy.

    Raises `LocomotionError` for fewer than two distinct points, coordinates that are not finite, or a speed
    that is not above 0.
    """
    raw = checked_points(points)
    if not (np.isfinite(speed) and speed > 0):
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
    for edge in crossed:
        table[np.abs(at - edge) < _STEP_REACH, SLOPE] = 0.0
    table[:, GAIT] = RUN
    gaits = [limits] * count
    if walk is not None:
        slowing = _length_of_slowing(speed, limits, walk)
        slowest = 0.5 * (walk.speeds[1] + limits.speeds[0])  # below it is nearer to a walk
        runs = _where_to_run(table, at, limits, speed, crossed, running, slowest, slowing)
        near = at - np.maximum.accumulate(np.where(runs, at, -math.inf)) <= slowing  # runs, or slows down
        fast = (speed < slowest) & _can_walk_fast(table, at, runs, walk.foresight) & ~near
        if present_speed < walk.calm + _ALREADY:  # who is told elsewhere all the time does not get fast
            fast &= at >= _BEGINS
        table[:, GAIT] = np.select([runs, fast], [RUN, FAST_WALK], WALK)
        usual = replace(walk, speeds=(walk.speeds[0], walk.calm))
        gaits = [limits if n else walk if f else usual for n, f in zip(near, fast, strict=True)]
    _plan_speed(table, length / (count - 1), speed, gaits, present_speed)
    return PathTable(table, length, distinct[-1].copy())


def _length_of_slowing(speed: float, limits: TrackingLimits, walk: TrackingLimits) -> float:
    """[m] in which a body that runs at up to ``speed`` slows down to a walk."""
    fastest = min(max(speed, limits.speeds[0]), limits.speeds[1])
    return max(fastest**2 - walk.calm**2, 0.0) / (2.0 * limits.slowing)


def _where_to_run(
    table: NDArray[np.float64],
    at: NDArray[np.float64],
    limits: TrackingLimits,
    speed: float,
    edges: NDArray[np.float64],
    running: bool,
    slowest: float,
    slowing: float,
) -> NDArray[np.bool_]:
    """(n,) bool: where the body runs, if ``speed`` is at least ``slowest`` [m/s]; behind that it needs
    ``slowing`` [m] to slow down."""
    hard = _too_hard(table, limits)
    runs = _can_run(hard, at, slowing) & (at <= at[-1] - COME_TO_REST - slowing) & (speed >= slowest)
    ends = np.flatnonzero(np.diff(runs.astype(np.int8), prepend=0, append=0))
    for begin, end in ends.reshape(-1, 2):
        if at[end - 1] - at[begin] < _WORTH_IT and not (running and begin == 0):
            runs[begin:end] = False
    for edge in edges:
        runs[(at >= edge - RUN_UP) & (at <= edge + _LANDED)] = True
    ends = np.flatnonzero(np.diff(runs.astype(np.int8), prepend=0, append=0))
    for end, begin in ends[1:-1].reshape(-1, 2):
        if at[begin] - at[end] < slowing + _BETWEEN and not hard[end:begin].any():
            runs[end:begin] = True
    return runs


def _can_walk_fast(
    table: NDArray[np.float64], at: NDArray[np.float64], runs: NDArray[np.bool_], foresight: float
) -> NDArray[np.bool_]:
    """(n,) bool: where the way is level and straight, for ``foresight`` [m] before and behind, and no run
    begins soon."""
    hardest = np.maximum(np.abs(table[:, SLOPE]) / _LEVEL, np.abs(table[:, CURVATURE]) / _STRAIGHT)
    easy = maximum_filter1d(hardest, 2 * round(foresight / SPACING) + 1) <= 1.0
    next_run = np.minimum.accumulate(np.where(runs, at, math.inf)[::-1])[::-1]
    return easy & (next_run - at >= _CALM)


def _too_hard(table: NDArray[np.float64], limits: TrackingLimits) -> NDArray[np.bool_]:
    """(n,) bool: where bends or slopes are too much for these limits."""
    return (np.abs(table[:, CURVATURE]) > limits.sharpest) | (np.abs(table[:, SLOPE]) > limits.steepest)


def _can_run(hard: NDArray[np.bool_], at: NDArray[np.float64], slowing: float) -> NDArray[np.bool_]:
    """(n,) bool: where nothing ``hard`` is, nor so near before the body that it has to slow down."""
    runs = ~hard
    for each in at[hard]:
        runs[(at >= each - _BEFORE - slowing) & (at <= each)] = False
    return runs


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


def _plan_speed(
    table: NDArray[np.float64], step: float, speed: float, gaits: Sequence[TrackingLimits], present: float
) -> None:
    """``gaits``: the limits at each point of the path."""
    slowest, fastest = np.array([g.speeds for g in gaits]).T
    sideways, faster, slower, uphill, downhill, foresight = np.array(
        [(g.sideways, g.acceleration, g.deceleration, g.uphill, g.downhill, g.foresight) for g in gaits]
    ).T
    bend = np.maximum(np.abs(table[:, CURVATURE]), 1e-6)
    slope = table[:, SLOPE]
    wished = np.minimum(np.sqrt(sideways / bend), np.minimum(speed, fastest))
    slowed = uphill * np.maximum(slope, 0.0) + downhill * np.maximum(-slope, 0.0)
    seen = round(float(foresight.max()) / step) + 1  # points, this one included
    ahead = maximum_filter1d(slowed, seen, mode="nearest", origin=-(seen // 2))
    wished = wished - np.where(foresight > 0.0, ahead, slowed)
    wished = np.maximum(wished, slowest)
    wished[-1] = slowest[-1]
    squares = wished * wished
    for i in range(len(squares) - 2, -1, -1):
        squares[i] = min(squares[i], squares[i + 1] + 2.0 * slower[i] * step)
    squares[0] = min(squares[0], max(present, slowest[0]) ** 2 + faster[0] * step)
    for i in range(1, len(squares)):
        squares[i] = min(squares[i], squares[i - 1] + 2.0 * faster[i - 1] * step)
    table[:, SPEED] = np.sqrt(squares)


def shifted(
    path: PathTable, arc: float, shift: ArrayLike, limits: TrackingLimits, walk: TrackingLimits | None = None
) -> PathTable:
    """``path`` with what comes after ``arc`` [m] moved by ``shift`` (k, 2) [m], one row for every 0.1 m; no
    faster than the new bends allow. Arc lengths are still those of the path before. ``limits`` and ``walk``
    as for `make_path`."""
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
    bend = np.sqrt(present.sideways / np.maximum(np.abs(table[:, CURVATURE]), 1e-6))
    squares = np.minimum(table[:, SPEED], np.maximum(bend, present.speeds[0])) ** 2
    for i in range(len(squares) - 2, -1, -1):
        squares[i] = min(squares[i], squares[i + 1] + 2.0 * present.deceleration * step)
    table[:, SPEED] = np.sqrt(squares)
    if walk is not None:
        slowing = _length_of_slowing(float(table[:, SPEED].max()), limits, walk)
        table[~_can_run(_too_hard(table, limits), along, slowing), GAIT] = WALK
    return replace(path, table=table)


def back_along(path: PathTable, arc: float, to: float, walk: TrackingLimits) -> PathTable:
    """The way back along ``path`` from arc length ``arc`` to ``to`` [m], walking."""
    step = path.length / (len(path.table) - 1)
    first, last = round(to / step), max(round(arc / step), round(to / step) + 1)
    back = make_path(path.table[first : last + 1, :3][::-1], walk.calm, walk, 0.0)
    back.table[:, GAIT] = WALK
    return back


def new_track() -> NDArray[np.float64]:
    """What the tracker remembers at the beginning of a path, (TRACK_SIZE,) float64."""
    memory = np.zeros(TRACK_SIZE)
    memory[PACE] = 1.0
    return memory


@njit(cache=True)
def _at(table, step, arc, column):
    place = min(max(arc / step, 0.0), table.shape[0] - 1.0)
    i = min(int(place), table.shape[0] - 2)
    w = place - i
    return (1.0 - w) * table[i, column] + w * table[i + 1, column]


@njit(cache=True)
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
    command[0] = preview - correction
    command[1] = memory[SPEED_HERE]
    command[2] = min(max(-gains[4] * lateral, -gains[5]), gains[5])
    command[3] = memory[SLOPE_HERE]
