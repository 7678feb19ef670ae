"""Exact optimum of the same problem with cvxpy: a reference for tests and benchmarks, too slow for a game
frame."""

from __future__ import annotations

import numpy as np

from pathsmooth import kernels
from pathsmooth.errors import PathSmoothError
from pathsmooth.problem import Problem
from pathsmooth.solution import COMPLETE, INFEASIBLE, ITERATION_LIMIT, Solution


def solve_exact(problem: Problem) -> Solution:
    """Solve a smoothing problem with a second-order cone solver (Clarabel).

    The points meet the discs to about 1e-8 m. A bound on curvature is taken as the convex constraint on the
    second divided difference at the problem's own spacing. Raises PathSmoothError where cvxpy is not
    installed.
    """
    try:
        import cvxpy
    except ImportError:
        raise PathSmoothError(
            "solve_exact needs cvxpy, which is not installed: in Surefoot's folder, pip install -e '.[exact]'"
        ) from None
    n = problem.count
    origin = problem.targets[0]
    p = problem.targets - origin
    h = np.diff(problem.arc)[:, None]
    mean = 0.5 * (h[:-1] + h[1:])
    x = cvxpy.Variable((n, 2))
    slope = cvxpy.multiply(1.0 / h, x[1:] - x[:-1])
    second = cvxpy.multiply(1.0 / mean, slope[1:] - slope[:-1])
    moved = problem.packed[kernels.WEIGHT] @ cvxpy.norm(x - p, 2, axis=1)
    bent = cvxpy.sum(cvxpy.multiply(mean, cvxpy.square(second)))
    constraints = [x[: problem.first] == p[: problem.first], x[problem.last :] == p[problem.last :]]
    for center_row, radius_row in ((kernels.AX, kernels.AR), (kernels.BX, kernels.BR)):
        center = problem.packed[center_row : center_row + 2].T + p
        constraints.append(cvxpy.norm(x - center, 2, axis=1) <= problem.packed[radius_row])
    if problem.max_curvature is not None:
        constraints.append(cvxpy.norm(second, 2, axis=1) <= problem.max_curvature)
    program = cvxpy.Problem(cvxpy.Minimize(moved + problem.smoothness * bent), constraints)
    program.solve(solver=cvxpy.CLARABEL)
    status = {"optimal": COMPLETE, "infeasible": INFEASIBLE}.get(program.status, ITERATION_LIMIT)
    xy = p if x.value is None else x.value
    points = np.column_stack([xy + origin, problem.heights])
    iterations = int(program.solver_stats.num_iters or 0)
    return Solution(points, problem.objective(points), 0.0, iterations, status, np.zeros((3, n, 2)), problem)
