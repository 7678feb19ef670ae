"""The solver's algorithms in plain NumPy and SciPy: slow, obvious, for tests to compare with."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pathsmooth import kernels as k
from pathsmooth.problem import Problem


def second_difference(problem: Problem) -> NDArray[np.float64]:
    """(n, n) matrix of the second divided difference of the waypoints [1/m^2]; its first and last rows are
    zero."""
    n = problem.count
    h = np.diff(problem.arc)
    matrix = np.zeros((n, n))
    for i in range(1, n - 1):
        mean = 0.5 * (h[i - 1] + h[i])
        matrix[i, i - 1] = 1.0 / (h[i - 1] * mean)
        matrix[i, i + 1] = 1.0 / (h[i] * mean)
        matrix[i, i] = -matrix[i, i - 1] - matrix[i, i + 1]
    return matrix


def project(problem: Problem, d: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 2) displacements moved to the nearest ones inside the discs, one waypoint after another."""
    return np.array([k.project(problem.packed, i, *d[i]) for i in range(problem.count)])


def _shrink_to_ball(y: NDArray[np.float64], radius: NDArray[np.float64]) -> NDArray[np.float64]:
    size = np.linalg.norm(y, axis=1)
    return y * np.minimum(1.0, radius / np.maximum(size, 1e-300))[:, None]


def pentadiagonal(
    problem: Problem, iterations: int, relaxation: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """The iterates d, y, v (n, 2) of `kernels.iterate` from zero, with a dense solve in the primal step."""
    free = slice(problem.first, problem.last)
    matrix = second_difference(problem)
    weight = problem.packed[k.WEIGHT][:, None]
    hessian = 2.0 * problem.smoothness * matrix.T @ (weight * matrix)
    gradient = hessian @ (problem.targets - problem.targets[0])
    s = problem.packed[k.NORM_STEP][:, None]
    r = problem.packed[k.DISC_STEP][:, None]
    d, y, v = (np.zeros((problem.count, 2)) for _ in range(3))
    system = (hessian + np.diagflat(s + r))[free, free]
    for _ in range(iterations):
        new = np.zeros_like(d)
        new[free] = np.linalg.solve(system, ((s + r) * d - y - v - gradient)[free])
        ahead = 2.0 * new - d
        new_y = _shrink_to_ball(y + s * ahead, weight[:, 0])
        z = v + r * ahead
        new_v = z - r * project(problem, z / r)
        for old, result in ((d, new), (y, new_y), (v, new_v)):
            old[free] += relaxation * (result - old)[free]
    return d, y, v


def two_pass(
    problem: Problem, iterations: int, step: float = 0.06, relaxation: float = 1.8
) -> NDArray[np.float64]:
    """Chambolle and Pock's algorithm in its plainest form, two passes over the path per iteration.

    The discs are in the primal step, and both terms of the objective in the dual: K = (sqrt(λh̄) D; h̄ I),
    with the diagonal preconditioning of Pock and Chambolle (2011), α = 1. step: γ [m], the ratio of primal to
    dual step sizes.
    Returns the points (n, 2).
    """
    free = np.zeros((problem.count, 1))
    free[problem.first : problem.last] = 1.0
    weight = problem.packed[k.WEIGHT][:, None]
    bend = np.sqrt(problem.smoothness * weight) * second_difference(problem)
    bent = bend @ (problem.targets - problem.targets[0])
    tau = step / (np.abs(bend).sum(axis=0)[:, None] + weight)
    sigma_bend = 1.0 / (step * np.maximum(np.abs(bend).sum(axis=1)[:, None], 1e-300))
    sigma_move = 1.0 / (step * weight)
    d = np.zeros((problem.count, 2))
    u = np.zeros_like(d)
    y = np.zeros_like(d)
    for _ in range(iterations):
        new = free * project(problem, d - tau * (bend.T @ u + weight * y))
        ahead = 2.0 * new - d
        new_u = (u + sigma_bend * (bend @ ahead + bent)) / (1.0 + 0.5 * sigma_bend)
        new_y = _shrink_to_ball(y + sigma_move * weight * ahead, np.ones(problem.count))
        for old, result in ((d, new), (u, new_u), (y, new_y)):
            old += relaxation * (result - old)
    return problem.targets + free * project(problem, d)
