"""Where along its path a body runs, walks, slows down and stops."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d

from locomotion.paths.table import (
    BRAKE,
    CURVATURE,
    FAST_WALK,
    GAIT,
    RUN,
    SLOPE,
    SPACING,
    SPEED,
    WALK,
    TrackingLimits,
)

__all__ = [
    "LANDED",
    "RUN_UP",
    "SET_OFF",
    "SLOWS_WITHIN",
    "Gaits",
    "Way",
    "braking_length",
    "hard_again",
    "plan_gaits",
]

RUN_UP = 15.0
"""[m] before an obstacle, along the path, from which a body runs and each step's speed is planned."""
SET_OFF = 7.7
"""[m] before an obstacle at which a walking body turns to it, to gain speed from there."""
LANDED = 5.0
"""[m] behind an obstacle's edge that are run, unless it has to stop sooner."""
SLOWS_WITHIN = 1.0
"""[m] that it may run on beyond a point to slow down or brake, until it finds how."""
_OFF_EDGE = 2.0  # [m] behind an obstacle's edge that are run in any case
_WORTH_IT = 4.0  # [m] least length of a run before it slows down
_BEFORE = 1.0  # [m] that are walked before what cannot be run
_BETWEEN = 4.0  # [m] least walk between two runs
_LEVEL, _STRAIGHT = 0.05, 0.15  # slope, and curvature [1/m], up to which it walks faster than usual
_BEGINS = 2.0  # [m] first walked at usual speed, unless it is faster already
_ALREADY = 0.15  # [m/s] faster than usual
_CALM = 4.0  # [m] before a run walked at usual speed, from which runs begin
_SURELY = 0.75  # [m/s^2] usual least deceleration to a walk
_BRAKING = 2.5  # [m/s^2] least deceleration to a stand: see `surefoot evaluate brake`


class Gaits(NamedTuple):
    """The limits at each of n points: ``kinds[at[i]]``; ``at`` (n,) int64."""

    kinds: tuple[TrackingLimits, ...]
    at: NDArray[np.int64]


class Way(NamedTuple):
    """A path of n points: its ``table`` (n, 8); their arc lengths ``at`` (n,) [m]; ``steps`` (n,): where the
    ground steps up or down."""

    table: NDArray[np.float64]
    at: NDArray[np.float64]
    steps: NDArray[np.bool_]


def plan_gaits(
    way: Way,
    speed: float,
    limits: TrackingLimits,
    walk: TrackingLimits,
    edges: NDArray[np.float64],
    present_speed: float,
    running: bool,
) -> Gaits:
    """Write the gaits into the table of ``way``; gives the limits at each point. Other arguments as in
    `tracking.make_path`."""
    table, at, steps = way
    fastest = min(max(speed, limits.speeds[0]), limits.speeds[1])
    slowing = _length_of_slowing(fastest, limits, walk)
    slowest = 0.5 * (walk.speeds[1] + limits.speeds[0])  # slower is nearer to a walk
    hard = _too_hard(table, limits) | (steps & (limits.steps == 0.0))
    runs = _where_to_run(hard, at, speed >= slowest, edges, running, slowing, limits.rest)
    entering = present_speed if running else 0.0
    surely = max(limits.slowing, _SURELY)
    brakes = _where_to_brake(hard, at, edges, runs, fastest, entering, walk.calm, surely)
    last_run = np.maximum.accumulate(np.where(runs, at, -math.inf))
    stood = np.maximum.accumulate(np.where(brakes, at, -math.inf)) > last_run
    near = (at - last_run <= slowing) & ~stood & (at <= at[-1] - limits.rest)  # runs, or slows down
    fast = (speed < slowest) & _can_walk_fast(table, at, runs, walk) & ~near
    if present_speed < walk.calm + _ALREADY:  # keeps a person with ever-changing orders slow
        fast &= at >= _BEGINS
    table[:, GAIT] = np.select([runs, brakes, fast], [RUN, BRAKE, FAST_WALK], WALK)
    usual = replace(walk, speeds=(walk.speeds[0], walk.calm))
    return Gaits((limits, walk, usual), np.where(near, 0, np.where(fast, 1, 2)))


def hard_again(table: NDArray[np.float64], step: float, limits: TrackingLimits, walk: TrackingLimits) -> None:
    """Let it walk where a shifted path has become too hard to run. step: [m] between the points of ``table``
    (n, 8)."""
    fastest = min(max(float(table[:, SPEED].max()), limits.speeds[0]), limits.speeds[1])
    slowing = _length_of_slowing(fastest, limits, walk)
    along = np.asarray(step * np.arange(len(table)), dtype=np.float64)
    table[~_can_run(_too_hard(table, limits), along, slowing), GAIT] = WALK


def braking_length(speed: float) -> float:
    """[m] in which a body running at ``speed`` [m/s] stops."""
    return speed * speed / (2.0 * _BRAKING)


def _length_of_slowing(speed: float, limits: TrackingLimits, walk: TrackingLimits) -> float:
    """[m] in which a body running at ``speed`` [m/s] slows down to a walk, as planned."""
    return max(speed**2 - walk.calm**2, 0.0) / (2.0 * limits.slowing)


def _where_to_run(
    hard: NDArray[np.bool_],
    at: NDArray[np.float64],
    worth: bool,
    edges: NDArray[np.float64],
    running: bool,
    slowing: float,
    rest: float,
) -> NDArray[np.bool_]:
    """(n,) bool: where the body runs, if it is ``worth`` it; it needs ``slowing`` [m] afterwards to slow
    down, and ``rest`` [m] at the end to come to rest."""
    runs = _can_run(hard, at, slowing) & (at <= at[-1] - rest - slowing) & worth
    for begin, end in _stretches(runs):
        if at[end - 1] - at[begin] < _WORTH_IT and not (running and begin == 0):
            runs[begin:end] = False
    for edge in edges:
        bends = at[hard & (at < edge - SET_OFF)]
        runs[(at >= max(edge - RUN_UP, bends.max(initial=0.0))) & (at <= edge + LANDED)] = True
    between = np.flatnonzero(np.diff(runs.astype(np.int8), prepend=0, append=0))[1:-1]
    for end, begin in between.reshape(-1, 2):
        if at[begin] - at[end] < slowing + _BETWEEN and not hard[end:begin].any():
            runs[end:begin] = True
    return runs


def _where_to_brake(
    hard: NDArray[np.bool_],
    at: NDArray[np.float64],
    edges: NDArray[np.float64],
    runs: NDArray[np.bool_],
    fastest: float,
    entering: float,
    calm: float,
    surely: float,
) -> NDArray[np.bool_]:
    """(n,) bool: where a body that runs at up to ``fastest`` [m/s], and enters the path at ``entering``,
    brakes to a stop, because it cannot slow down to a walk at ``calm`` before what cannot be run or the
    end, with ``surely`` [m/s^2] at least; changes ``runs``, where it runs before that, in place.
    """
    brakes = np.zeros(len(at), dtype=bool)
    stretches = _stretches(runs)
    if entering > 0.0 and not runs[0]:
        stretches = [(0, 0), *stretches]
    for begin, end in stretches:
        speed = max(entering, fastest if end else 0.0) if begin == 0 else fastest
        left = at[min(end, len(at) - 1)]
        passed = edges[edges <= left]
        earliest = max(at[begin], passed.max(initial=-math.inf) + _OFF_EDGE)
        ahead = at[hard & (at >= max(at[begin], passed.max(initial=-math.inf)))]
        stop = float(ahead[0]) if len(ahead) else float(at[-1])
        if stop - left >= (speed**2 - calm**2) / (2.0 * surely):
            continue
        first = max(stop - braking_length(speed) - SLOWS_WITHIN, earliest)
        runs[(at >= at[begin]) & (at < first)] = True
        stands = (at >= first) & (at <= max(stop, first + _BEFORE))
        runs[stands] = False
        brakes |= stands
    return brakes


def _stretches(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Begin and end of each row of True ones."""
    ends = np.flatnonzero(np.diff(flags.astype(np.int8), prepend=0, append=0))
    return [(int(begin), int(end)) for begin, end in ends.reshape(-1, 2)]


def _can_walk_fast(
    table: NDArray[np.float64], at: NDArray[np.float64], runs: NDArray[np.bool_], walk: TrackingLimits
) -> NDArray[np.bool_]:
    """(n,) bool: where the path is straight for `TrackingLimits.foresight` before and behind, and level for
    as far as it takes to slow down, too, and no run begins soon."""
    slowing = (walk.speeds[1] ** 2 - walk.calm**2) / (2.0 * walk.deceleration)
    easy = np.ones(len(table), dtype=bool)
    for column, most, far in (
        (CURVATURE, _STRAIGHT, walk.foresight),
        (SLOPE, _LEVEL, walk.foresight + slowing),
    ):
        easy &= maximum_filter1d(np.abs(table[:, column]), 2 * round(far / SPACING) + 1) <= most
    next_run = np.minimum.accumulate(np.where(runs, at, math.inf)[::-1])[::-1]
    return easy & (next_run - at >= _CALM)


def _too_hard(table: NDArray[np.float64], limits: TrackingLimits) -> NDArray[np.bool_]:
    """(n,) bool: where bends or slopes exceed these limits."""
    return (np.abs(table[:, CURVATURE]) > limits.sharpest) | (np.abs(table[:, SLOPE]) > limits.steepest)


def _can_run(hard: NDArray[np.bool_], at: NDArray[np.float64], slowing: float) -> NDArray[np.bool_]:
    """(n,) bool: where nothing ``hard`` is here or so near ahead that the body has to slow down."""
    there = at[hard]
    if len(there) == 0:
        return ~hard
    following = np.searchsorted(there, at)  # the next that is hard, here or ahead
    next_one = there[np.minimum(following, len(there) - 1)]
    return (following == len(there)) | (at < next_one - _BEFORE - slowing)
