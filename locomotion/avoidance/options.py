"""What a body that would meet somebody can do, and which of that is cheapest.

It goes on more slowly, or steps aside. All options are foretold in one kernel: there may be forty.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from locomotion.avoidance.yielding import COUNT, HORIZON, SPACING, STEP, Course, first_meeting, foretell
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["Options", "cheapest", "cost_of_meeting", "options"]

_ASIDE = (0.4, 0.8, 1.2, 1.6)
"""[m] to each side that a sidestep leads."""
_METRE_COSTS = (1.0, 1.2)
"""Cost of each metre to the right, and to the left."""
_PACES = (1.0, 0.6, 0.3, 0.0)
_SLOW_COSTS = 2.0
"""Cost of standing."""
_NEAR_COSTS, _TOUCHING_COSTS, _SOONER_COSTS, _DEEPER_COSTS = 1.5, 2.5, 6.0, 20.0
"""Costs of coming too near to somebody (less than standing, lest two wait for each other for ever), of
touching them, of doing so soon, and of passing through them."""
_KEPT = (4.0, 2.0, 1.0)
"""[m] for which a body keeps its former path."""
_KEEPING_COSTS = 0.2
_QUINTIC = 5.7735  # largest second derivative of a smooth step from 0 to 1
_AFTERWARDS = 1.0  # [m] that a body stays aside beyond the place of meeting


@dataclass(frozen=True)
class Options:
    """What a body can do, cheapest first. ``paces`` (n,); ``costs`` (n,) without those of meetings; ``ways``
    (n,) int64: the row of ``shifts`` (s, k, 2) [m] that is added to its course, -1 for none."""

    paces: NDArray[np.float64]
    costs: NDArray[np.float64]
    ways: NDArray[np.int64]
    shifts: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.paces)

    def shift(self, number: int) -> NDArray[np.float64] | None:
        """(k, 2) [m] added to the course; None for none."""
        way = int(self.ways[number])
        return None if way < 0 else self.shifts[way]


def options(course: Course, meeting: int, halts: bool = True, former: Course | None = None) -> Options:
    """Options of a body that would meet somebody at step ``meeting``. ``halts``: whether to include a halt
    for one that does not halt easily. ``former``: its course before it was given another goal just now.
    """
    paces = _paces(course, halts)
    slow = [_SLOW_COSTS * (1.0 - pace) for pace in paces]
    # a row for each option: pace, cost, way
    found = [(pace, dear, -1) for pace, dear in zip(paces, slow, strict=True)]
    shifts = np.empty((0, len(course.points), 2))
    if course.aside and former is not None:
        shifts = _kept(course, former)
        for way in range(len(shifts)):
            found += [(pace, _KEEPING_COSTS + dear, way) for pace, dear in zip(paces, slow, strict=True)]
    if course.aside:
        first, stretches = len(shifts), _stretches(course, meeting)
        swings = np.empty((2 * len(stretches), len(course.points), 2))
        _swing(course.points, np.array(stretches).reshape(-1, 4), swings)
        shifts = np.concatenate([shifts, swings]) if first else swings
        for k, (far, *_) in enumerate(stretches):
            for side, dear in enumerate(_METRE_COSTS):
                way = first + 2 * k + side
                found += [
                    (pace, dear * far + slowly, way)
                    for pace, slowly in zip(paces, slow, strict=True)
                    if pace > 0.0
                ]
    found.sort(key=lambda option: option[1])
    table = np.array(found)
    return Options(table[:, 0].copy(), table[:, 1].copy(), table[:, 2].astype(np.int64), shifts)


def cheapest(
    course: Course,
    among: Options,
    barred: NDArray[np.bool_],
    others: tuple[NDArray[np.float64], NDArray[np.float64], float],
    discs: int,
    least: float,
    meetings: NDArray[np.float64],
) -> int:
    """The number of the option that costs least, meetings included, and less than ``least``; -1 if none does.

    ``barred`` (s,): shifts that do not count. ``others``: where the discs of others will be (COUNT, k, 2),
    their radii (k,) [m], and what is kept from them [m]. ``discs``: of the body. ``meetings`` (n,): costs of
    them as far as they are known, NaN elsewhere; more become known.
    """
    of = among
    body = (
        course.speed, course.slowest, course.acceleration, course.braking, course.eagerness, course.length,
        course.reach, course.turns,
    )  # fmt: skip
    return _cheapest(
        (course.points, course.speeds, body), course.radius, (of.paces, of.costs, of.ways, of.shifts),
        barred, others, discs, least, meetings,
    )  # fmt: skip


@kernel
def cost_of_meeting(near, touches, depth):
    """Cost of a meeting found by `first_meeting`; 0 for none."""
    cost = _NEAR_COSTS if near < COUNT else 0.0
    if touches < COUNT:
        cost += _TOUCHING_COSTS + _SOONER_COSTS * (1.0 - touches / COUNT) + _DEEPER_COSTS * depth
    return cost


@allocating_kernel
def _cheapest(course, radius, among, barred, others, discs, least, meetings):
    points, speeds, body = course
    speed, slowest, acceleration, braking, eagerness, length, reach, turns = body
    paces, costs, ways, shifts = among
    there, radii, room = others
    places, path, best = np.empty((COUNT, discs, 2)), np.empty((points.shape[0], 2)), -1
    for n in range(paces.size):
        if costs[n] >= least:
            break
        way = ways[n]
        if way >= 0 and barred[way]:
            continue
        if math.isnan(meetings[n]):
            for k in range(points.shape[0]):
                for axis in range(2):
                    path[k, axis] = points[k, axis] + (shifts[way, k, axis] if way >= 0 else 0.0)
            foretell(
                path, speeds, speed, paces[n], slowest, acceleration, braking, eagerness, length, reach,
                turns, places,
            )  # fmt: skip
            near, touches, depth = first_meeting(places, radius, there, radii, room)
            meetings[n] = cost_of_meeting(near, touches, depth)
        if costs[n] + meetings[n] < least:
            best, least = n, costs[n] + meetings[n]
    return best


def _stretches(course: Course, meeting: int) -> list[tuple[float, float, float, float]]:
    """Of each sidestep that there is room for: how far aside it leads; where it begins, and goes back, along
    the course; and how long each of that takes [m]."""
    found, end = [], SPACING * (len(course.points) - 1)
    reach = min(meeting * STEP, HORIZON) * float(course.speeds.max())
    for aside in _ASIDE:
        bend = math.sqrt(_QUINTIC * aside / course.sharpest)
        until = max(course.length + reach + _AFTERWARDS, course.begins + bend)
        if until + bend > end:
            until = end - bend
        if until >= course.begins + bend:
            found.append((aside, course.begins, until, bend))
    return found


def _kept(course: Course, former: Course) -> NDArray[np.float64]:
    """(s, k, 2) shifts with which it continues as in ``former`` for a while, if that was about to step aside:
    on ``course`` it would be too late for that."""
    arcs = SPACING * np.arange(len(course.points))
    same = np.minimum(np.arange(len(arcs)), len(former.points) - 1)
    apart = former.points[same, :2] - course.points[:, :2]
    found = []
    for until in _KEPT:
        far = float(np.linalg.norm(apart[min(round(until / SPACING), len(arcs) - 1)]))
        bend = max(math.sqrt(_QUINTIC * far / course.sharpest), course.length)
        if until + bend <= arcs[-1]:
            shares = np.array([1.0 - _smooth_step((arc - until) / bend) for arc in arcs.tolist()])
            found.append(shares[:, None] * apart)
    return np.array(found).reshape(-1, len(arcs), 2)


def _paces(course: Course, halts: bool) -> list[float]:
    """Paces that make a difference; ``halts``: includes 0 also for one that does not halt easily."""
    wanted = float(course.speeds[0])
    slows = course.slowest < 0.8 * wanted
    return [
        pace
        for pace in _PACES
        if pace == 1.0
        or (slows or pace * wanted >= course.slowest if pace > 0.0 else halts or course.slowest == 0.0)
    ]


@kernel
def _smooth_step(share):
    """From 0 to 1 as a ``share`` does, without corners."""
    u = min(max(share, 0.0), 1.0)
    return u * u * u * (10.0 + u * (-15.0 + 6.0 * u))


@kernel
def _swing(points, stretches, shifts):
    """Write ``shifts`` (2 s, k, 2) [m] of sidesteps, to the right and to the left, along ``points`` (k, 3).
    stretches (s, 4): as of `_stretches`."""
    last = points.shape[0] - 1
    for k in range(last + 1):
        after, before = min(k + 1, last), max(k - 1, 0)
        x, y = points[after, 0] - points[before, 0], points[after, 1] - points[before, 1]
        size = max(math.sqrt(x * x + y * y), 1e-9)
        for n in range(stretches.shape[0]):
            far, begins, until, bend = stretches[n]
            arc = SPACING * k
            share = _smooth_step((arc - begins) / bend) - _smooth_step((arc - until) / bend)
            for side in range(2):
                aside = (2 * side - 1) * far * share
                shifts[2 * n + side, k, 0] = -aside * y / size
                shifts[2 * n + side, k, 1] = aside * x / size
