"""The exact optimum by cvxpy: what it promises, and that the solver comes as near to it as it says."""

import sys

import numpy as np
import pytest

from pathsmooth import PathSmoothError, Problem, solve
from pathsmooth.exact import solve_exact
from tests.pathsmooth.chains import corridor, ends


@pytest.mark.parametrize("seed", range(12))
def test_agrees_with_cvxpy(seed):
    waypoints, centers, radii = corridor(seed)
    start, end = ends(waypoints) if seed % 2 else (None, None)
    problem = Problem.from_corridor(waypoints, centers, radii, start_tangent=start, end_tangent=end)
    exact = solve_exact(problem)
    assert exact.status == "complete"
    assert solve(problem).objective <= 1.01 * exact.objective + 1e-7
    close = solve(problem, tolerance=1e-6)
    assert close.objective == pytest.approx(exact.objective, rel=1e-5, abs=1e-7)
    # the bound that the gap rests on is below the optimum
    for iterations in (3, 10, 40):
        solution = solve(problem, iterations=iterations, tolerance=0.0)
        assert solution.objective - solution.gap <= exact.objective * (1 + 1e-6) + 1e-7


def test_it_is_no_worse_than_any_other_path_and_inside_the_discs():
    problem = Problem.from_corridor(*corridor(3, discs=6))
    exact = solve_exact(problem)
    assert exact.objective <= solve(problem, tolerance=1e-6).objective + 1e-9
    assert problem.outside(exact.points) < 1e-7
    assert exact.gap == 0.0


def test_a_bound_that_no_points_meet_is_infeasible():
    """A right angle in a narrow corridor, under a bound of nearly a straight line."""
    path = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0]]
    discs = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [2.0, 2.0]]
    problem = Problem.from_corridor(path, discs, np.full(5, 0.6), max_curvature=0.01)
    assert solve_exact(problem).status == "infeasible"


def test_without_cvxpy_the_error_says_how_to_install_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "cvxpy", None)
    with pytest.raises(PathSmoothError, match=r"needs cvxpy, which is not installed: .*\[exact\]"):
        solve_exact(Problem.from_corridor(*corridor(0, discs=2)))
