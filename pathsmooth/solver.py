"""Solve a smoothing problem."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pathsmooth import kernels
from pathsmooth.bounded import limited, solve_with_bound
from pathsmooth.curvature import curvature
from pathsmooth.errors import PathSmoothError
from pathsmooth.problem import Problem
from pathsmooth.solution import COMPLETE, INFEASIBLE, ITERATION_LIMIT, Solution
from surefoot.kernels import allocating_kernel
from surefoot.slices import Slices, finish

MAX_ITERATIONS = 5000
"""Iterations after which `solve` gives up reaching the tolerance, where the caller sets no limit."""

RELAXATION = 1.7
CHECKS = (8, 4)  # iterations before the first look at the gap, and between looks
WARM_CHECKS = (1, 3)


def solve(
    problem: Problem, iterations: int | None = None, tolerance: float = 0.01, warm: Solution | None = None
) -> Solution:
    """Smooth a path: Chambolle and Pock's primal-dual algorithm with a pentadiagonal solve in the primal
    step.

    iterations: greatest number of iterations, >= 0: the budget of a frame. None: until the tolerance is
        reached.
    tolerance: >= 0; stop where the objective is proven to be at most this fraction above the optimum. 0 uses
        up the iterations.
    warm: an earlier solution of this problem or of one like it, such as before the path was replanned; with
        or without a bound on curvature. Under a bound it saves only a tenth of the iterations, because each
        round of spreading the waypoints anew changes the problem.

    Raises PathSmoothError for a negative limit or tolerance.
    """
    limit = MAX_ITERATIONS if iterations is None else iterations
    if limit < 0:
        raise PathSmoothError(f"iterations must be 0 or more, not {iterations}")
    if not tolerance >= 0.0:
        raise PathSmoothError(f"tolerance must be 0 or more, not {tolerance}")
    n = len(problem.arc)
    state = np.zeros((4, n, 2)) if warm is None else warm_state(problem, warm)
    bounded_state = None if warm is None else state.copy()
    first_check, check_every = CHECKS if warm is None else WARM_CHECKS
    points = np.empty((n, 3))
    done, value, bound = kernels.solve(
        problem.packed, problem.targets, problem.heights, problem.first, problem.last,
        RELAXATION, limit, tolerance,
        first_check, check_every, state, points,
    )  # fmt: skip
    gap = max(value - bound, 0.0)
    status = INFEASIBLE if problem.obstruction else _status(value, bound, tolerance)
    solution = Solution(points, value, gap, done, status, state, problem)
    if (
        problem.max_curvature is None
        or problem.obstruction
        or curvature(points).max() <= problem.max_curvature
    ):
        return solution
    return solve_with_bound(problem, iterations, tolerance, solution, bounded_state)


def solve_tightest(
    problem: Problem, bounds: Sequence[float], iterations: int, tolerance: float = 0.01
) -> tuple[Solution, bool]:
    """Smooth a path under the tightest of some bounds on curvature: what one gets by calling `solve` without
    a bound, and then with one after the other, the widest first, until one is not met. What the problems
    share is computed once.

    bounds: [1/m] > 0. iterations: greatest number of iterations under each; a path that takes more without
        any is returned as soon as it meets one by itself. tolerance: as for `solve`.

    Returns the solution under the last bound that was met, and True; without a bound, and False, if none was.
    The problem's own bound does not matter. Raises PathSmoothError as `solve` does.
    """
    return finish(tightening(problem, bounds, iterations, tolerance))


def tightening(
    problem: Problem, bounds: Sequence[float], iterations: int, tolerance: float = 0.01
) -> Slices[tuple[Solution, bool]]:
    """What `solve_tightest` does, in slices. Yields iterations times waypoints after each round."""
    free = solve(replace(problem, max_curvature=None), None, tolerance)
    yield free.iterations * problem.count
    if free.status == INFEASIBLE:
        return free, False
    bent, best, held = float(curvature(free.points).max()), free, False
    for bound in sorted(bounds, reverse=True):
        bounded = replace(problem, max_curvature=bound)
        if bent <= bound:
            if free.iterations > iterations:
                break
            best = replace(free, problem=bounded)
        else:
            found = yield from limited(bounded, iterations, tolerance)
            if found.status != COMPLETE:
                break
            best = found
        held = True
    return best, held


def _status(value: float, bound: float, tolerance: float) -> str:
    close = value - bound <= max(tolerance, kernels.EXACT) * bound or value <= kernels.NOTHING
    return COMPLETE if close else ITERATION_LIMIT


def warm_state(problem: Problem, warm: Solution) -> NDArray[np.float64]:
    """(4, n, 2) the state of an earlier solution, carried over to the waypoints of this problem."""
    old = warm.problem
    if old is problem:
        return warm.state.copy()
    state = np.zeros((4, len(problem.arc), 2))
    _carry_over(
        old.targets, old.packed[kernels.WEIGHT], warm.state,
        problem.targets, problem.packed[kernels.WEIGHT], state, problem.first, problem.last,
    )  # fmt: skip
    return state


@allocating_kernel  # what may overlap is copied
def _carry_over(old_targets, old_weight, old_state, targets, weight, state, first, last):
    """Take for each waypoint the state of the nearest earlier one; a disc's force goes to one waypoint
    only."""
    j = 0
    taken = -1
    for i in range(first, last):
        nearest = np.inf
        best = j
        for c in range(j, len(old_targets)):
            dx = old_targets[c, 0] - targets[i, 0]
            dy = old_targets[c, 1] - targets[i, 1]
            if dx * dx + dy * dy < nearest:
                nearest = dx * dx + dy * dy
                best = c
            elif dx * dx + dy * dy > 4.0 * nearest + 1.0:
                break
        j = best
        state[kernels.DISPLACEMENT, i] = old_state[kernels.DISPLACEMENT, j]
        if old_weight[j] > 0.0:
            for row in (kernels.NORM_DUAL, kernels.CURVE_DUAL):
                state[row, i] = old_state[row, j] * (weight[i] / old_weight[j])
        if j != taken:
            state[kernels.DISC_DUAL, i] = old_state[kernels.DISC_DUAL, j]
            taken = j
