"""Smoothing under a bound on curvature.

Curvature is not convex in the waypoints, but the second divided difference is, and the two agree if the
waypoints lie as far apart as their nominal spacing. So the solver solves the convex problem, spreads the
waypoints evenly along the result and solves again, tightening the bound where the true curvature exceeds it,
until the true curvature is within the bound.

If that fails, `reach` either proves that no such curve exists, or finds a rough one to start again from.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pathsmooth import bounded_kernels, kernels, reach
from pathsmooth.curvature import curvature
from pathsmooth.errors import PathSmoothError
from pathsmooth.geometry import arc_along, interpolated, nearest_in_lens, steps_along
from pathsmooth.packing import keep_near, with_bound
from pathsmooth.placement import cover
from pathsmooth.problem import SLACK, Problem
from pathsmooth.solution import COMPLETE, INFEASIBLE, ITERATION_LIMIT, Solution
from surefoot.slices import Slices, finish

SLACK_OF_BOUND = 0.03
"""Relative amount by which the true curvature of a complete solution may exceed the bound."""

ROUNDS = 15
ROUGH_TOLERANCE, ROUGH_SLACK = 0.1, SLACK_OF_BOUND  # of the first round, on waypoints yet to be spread
HOPELESS = (np.inf, 1.4, 1.3)
"""True curvature over the bound after the first, second and later rounds from which a limited run has not
come to meet it, on routes of two levels."""
RELAXATION = 1.7
# rounds from a way found by the search
FREE_ROUNDS = 40
FREE_LIMIT = 200  # iterations in one
FREE_REACH = 0.06  # radii of the tightest curve that a waypoint may move in one
FREE_TIGHTEN = 1.3  # excess of curvature below which the bound is tightened
_CHECK_EVERY = 12
_ROUND_LIMIT = 3000  # iterations in one round

SEARCHES = tuple(
    reach.Fineness(*each) for each in ((0.5, 3, 0.06), (0.4, 4, 0.025), (0.25, 4, 0.01), (0.15, 5, 0.004))
)
"""Ever finer searches: turn per step [rad], heading cells in it, cell size in radii of the tightest curve."""


@dataclass(slots=True)
class _Trial:
    """The last round of one run of `_rounds`."""

    problem: Problem
    displacements: NDArray[np.float64]
    state: NDArray[np.float64]
    objective: float
    bound: float
    worst: float
    """True curvature over the bound."""
    iterations: int

    @property
    def complete(self) -> bool:
        return self.worst <= 1.0 + SLACK_OF_BOUND


def solve_with_bound(
    problem: Problem,
    limit: int | None,
    tolerance: float,
    without: Solution,
    state: NDArray[np.float64] | None = None,
) -> Solution:
    """Smooth a path under problem.max_curvature.

    limit: greatest number of iterations over all rounds; None: no limit, and the search if they fail.
    without: solution of the problem without the bound, returned if the bound cannot be met. state: (4, n, 2)
    of an earlier solution, to start from.
    """
    if limit is not None:
        return finish(limited(problem, limit, tolerance, state))
    trial = finish(_rounds(problem, None, tolerance, state))
    if trial.complete:
        return _solution(trial)
    best = trial
    for fineness in SEARCHES:
        code, positions, discs = _search(problem, fineness)
        if code == reach.UNREACHABLE:
            without.status = INFEASIBLE
            return without
        if code == reach.UNDECIDED:
            break
        curve, used = _curve(problem, positions, discs)
        try:
            # the way found takes the place of the pulled path, which may have no bounded curve near it
            start = _from_curve(problem, curve, used)
        except PathSmoothError:  # the cells strayed from the corridor by more than their discs overlap
            continue
        trial = finish(_rounds(start, None, tolerance, None, free=True))
        if not trial.complete:  # along a curve that nearly holds, the convex problem is nearly the true one
            points = trial.problem.targets + trial.displacements
            curve = np.column_stack([points, trial.problem.heights])
            start = _from_curve(trial.problem, curve, np.unique(trial.problem.segment_disc))
            trial = finish(_rounds(start, None, tolerance, None))
        if trial.complete:
            return _solution(trial)
        if trial.worst < best.worst:
            best = trial
    return _solution(best)


def limited(
    problem: Problem, limit: int, tolerance: float, state: NDArray[np.float64] | None = None
) -> Slices[Solution]:
    """The same with a ``limit``, round by round."""
    trial = yield from _rounds(problem, limit, tolerance, state)
    return _solution(trial)


def _rounds(
    problem: Problem,
    limit: int | None,
    tolerance: float,
    state: NDArray[np.float64] | None,
    free: bool = False,
) -> Slices[_Trial]:
    """Solve, spread the waypoints and tighten the bound where the curvature exceeds it, until it holds.

    Each round starts from the state of the round before; the first one is solved only roughly. free: each
    round takes the previous curve as its pulled path and stays near it, so that a loop is not pulled tight.
    """
    bound = float(problem.max_curvature or np.inf)
    margin = np.ones(problem.count)
    left = ROUNDS * _ROUND_LIMIT if limit is None else limit
    state = np.zeros((4, problem.count, 2)) if state is None else state.copy()
    best = None
    done = 0
    for number in range(FREE_ROUNDS if free else ROUNDS):
        rough = number == 0 and not free
        packed = with_bound(problem.packed, problem.first, problem.last)
        if free:
            keep_near(packed, FREE_REACH / bound)
        displacements = np.zeros((problem.count, 2))
        code, count, value, low = bounded_kernels.solve_bounded(
            packed, bound * margin, problem.first, problem.last, RELAXATION,
            min(FREE_LIMIT if free else _ROUND_LIMIT, left),
            max(tolerance, ROUGH_TOLERANCE) if rough else tolerance,
            ROUGH_SLACK if rough else 0.2 * SLACK_OF_BOUND, _CHECK_EVERY, not free, state, displacements,
        )  # fmt: skip
        done += count
        left -= count
        yield count * problem.count
        points = problem.targets + displacements
        excess = curvature(points) / bound
        trial = _Trial(problem, displacements, state, value, low, float(excess.max()), done)
        if best is None or trial.complete or trial.worst < best.worst:
            best = trial
        if (code == bounded_kernels.IMPOSSIBLE and not free) or left <= 0:
            break
        if trial.complete:
            if rough:
                continue  # the waypoints may stay
            break
        if limit is not None and trial.worst > HOPELESS[min(number, len(HOPELESS) - 1)]:
            break
        for _ in range(2):
            excess[1:-1] = np.maximum(np.maximum(excess[:-2], excess[2:]), excess[1:-1])
        if not free or trial.worst < FREE_TIGHTEN:
            margin = margin / np.maximum(1.0, excess)
        along = arc_along(steps_along(points))
        used = np.unique(problem.segment_disc)
        if free:
            problem = _from_curve(problem, np.column_stack([points, problem.heights]), used)
            state = np.zeros((4, problem.count, 2))
        else:
            problem = problem.along(points, problem.source, used)
            state = _carried(state, along, points, problem)
        margin = np.interp(problem.arc, along, margin)
    assert best is not None
    best.iterations = done
    return best


def _carried(
    state: NDArray[np.float64], along: NDArray[np.float64], points: NDArray[np.float64], problem: Problem
) -> NDArray[np.float64]:
    """State (4, n, 2) interpolated at `points` (n, 2), arc lengths `along` (n,), from that of a problem whose
    waypoints are spread along the same points."""
    moved = np.zeros((4, problem.count, 2))
    free = slice(problem.first, problem.last)
    duals = (state[kernels.NORM_DUAL], state[kernels.DISC_DUAL], state[kernels.CURVE_DUAL])
    rows = interpolated(problem.arc, along, np.concatenate((points, *duals), axis=1))
    moved[kernels.DISPLACEMENT, free] = (rows[:, :2] - problem.targets)[free]
    moved[kernels.NORM_DUAL, free] = rows[free, 2:4]
    moved[kernels.DISC_DUAL, free] = rows[free, 4:6]
    moved[kernels.CURVE_DUAL, 1:-1] = rows[1:-1, 6:]
    return moved


def _from_curve(problem: Problem, curve: NDArray[np.float64], discs: NDArray[np.integer]) -> Problem:
    """The problem with a curve (k, 3) inside the discs (j,) as its pulled path; PathSmoothError if it is
    outside."""
    return Problem.from_corridor(
        curve, problem.centers[discs], problem.radii[discs], problem.spacing, *problem.tangents,
        problem.max_curvature, problem.smoothness,
    )  # fmt: skip


def _solution(trial: _Trial) -> Solution:
    problem = trial.problem
    points = np.column_stack([problem.targets + trial.displacements, problem.heights])
    return Solution(
        points,
        trial.objective,
        max(trial.objective - trial.bound, 0.0),
        trial.iterations,
        COMPLETE if trial.complete else ITERATION_LIMIT,
        trial.state,
        problem,
    )


def _search(problem: Problem, fineness: reach.Fineness):
    start, goal = (None if t is None else float(np.arctan2(t[1], t[0])) for t in problem.tangents)
    return reach.search(
        reach.End(problem.path[0, :2], start), reach.End(problem.path[-1, :2], goal),
        problem.centers, problem.radii + SLACK, float(problem.max_curvature or np.inf), fineness,
    )  # fmt: skip


def _curve(problem: Problem, positions: NDArray[np.float64], discs: NDArray[np.integer]):
    """A chain of cells as a curve inside the discs: (points (k, 3), discs used (j,))."""
    centers, radii = problem.centers, problem.radii
    points = [problem.path[0, :2]]
    at = [int(discs[0])]
    ahead = [*zip(positions[1:], discs[1:], strict=True), (problem.path[-1, :2], len(radii) - 1)]
    for position, disc in ahead:
        for j in range(at[-1], int(disc)):
            middle = 0.5 * (points[-1] + position)
            lens = (*centers[j], radii[j], *centers[j + 1], radii[j + 1])
            points.append(np.array(nearest_in_lens(middle[0], middle[1], *lens)))
            at.append(j + 1)
        own = (*centers[disc], radii[disc])
        points.append(np.array(nearest_in_lens(position[0], position[1], *own, *own)))
        at.append(int(disc))
    points[-1] = problem.path[-1, :2]
    curve = np.array(points)

    # height of the nearest place of the pulled path within the stretch of each point's disc, never going back
    path = problem.path[:, :2] - problem.path[0, :2]
    arc = arc_along(steps_along(path))
    _, _, _, begin, end = cover(path, arc, centers - problem.path[0, :2], radii, SLACK)
    samples = np.linspace(0.0, arc[-1], 20 * len(arc) + 200)
    on_path = np.column_stack([np.interp(samples, arc, problem.path[:, axis]) for axis in range(2)])
    source = np.empty(len(curve))
    for i, disc in enumerate(at):
        in_stretch = (samples >= begin[disc] - SLACK) & (samples <= end[disc] + SLACK)
        distance = np.where(in_stretch, np.hypot(*(on_path - curve[i]).T), np.inf)
        source[i] = samples[np.argmin(distance)] if in_stretch.any() else begin[disc]
    source[0], source[-1] = 0.0, arc[-1]
    height = np.interp(np.maximum.accumulate(source), arc, problem.path[:, 2])
    return np.column_stack([curve, height]), np.unique(at)
