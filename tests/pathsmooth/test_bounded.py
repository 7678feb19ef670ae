"""The bound on curvature: where a curve exists it is found, where none exists the status says so."""

import numpy as np
import pytest

from benchmarks.corridors import bounded_curve, disc_chain, sharp_corner, turn_on_the_spot
from pathsmooth import Problem, bounded, curvature, solve, solve_exact
from pathsmooth.bounded import SLACK_OF_BOUND
from pathsmooth.bounded_kernels import CONVERGED, IMPOSSIBLE, excludes, solve_bounded
from pathsmooth.packing import with_bound
from pathsmooth.solution import COMPLETE, INFEASIBLE, ITERATION_LIMIT

BOUNDS = [0.2, 0.5, 1.0]


def problem_of(corridor, bound):
    waypoints, centers, radii, start, end = corridor
    return Problem.from_corridor(waypoints, centers, radii, 0.25, start, end, bound)


def assert_holds(solution, bound, start, end):
    assert solution.status == COMPLETE
    assert curvature(solution.points).max() <= (1.0 + SLACK_OF_BOUND) * bound
    assert solution.problem.outside(solution.points) < 3e-8
    points = solution.points[:, :2]
    for step, tangent in ((points[1] - points[0], start), (points[-1] - points[-2], end)):
        assert np.allclose(step / np.linalg.norm(step), tangent / np.linalg.norm(tangent), atol=1e-9)


@pytest.mark.parametrize("bound", BOUNDS)
@pytest.mark.parametrize("seed", range(6))
def test_finds_a_curve_where_one_exists_by_construction(seed, bound):
    corridor = bounded_curve(np.random.default_rng(seed), bound, 0.1 + 0.06 * seed)
    assert_holds(solve(problem_of(corridor, bound)), bound, *corridor[3:])


@pytest.mark.parametrize("bound", BOUNDS)
@pytest.mark.parametrize("seed", range(3))
def test_says_so_where_a_corner_is_too_sharp_for_the_corridor(seed, bound):
    corridor = sharp_corner(np.random.default_rng(seed), bound)
    solution = solve(problem_of(corridor, bound))
    assert solution.status == INFEASIBLE
    assert solution.problem.outside(solution.points) < 3e-9


@pytest.mark.parametrize("bound", BOUNDS)
def test_says_so_where_there_is_no_room_to_turn_round(bound):
    solution = solve(problem_of(turn_on_the_spot(np.random.default_rng(1), bound, 0.8), bound))
    assert solution.status == INFEASIBLE


def test_turns_round_where_there_is_room():
    corridor = turn_on_the_spot(np.random.default_rng(1), 1.0, 3.5)
    assert_holds(solve(problem_of(corridor, 1.0)), 1.0, *corridor[3:])


def test_convex_problem_with_a_bound_agrees_with_cvxpy():
    waypoints, centers, radii = disc_chain(np.random.default_rng(4), 8, (0.8, 2.5), 0.5)
    problem = Problem.from_corridor(waypoints, centers, radii, max_curvature=0.5)
    exact = solve_exact(problem)
    assert exact.status == COMPLETE
    state, d = np.zeros((4, problem.count, 2)), np.zeros((problem.count, 2))
    _, _, value, bound = solve_bounded(
        with_bound(problem.packed, problem.first, problem.last), np.full(problem.count, 0.5), problem.first,
        problem.last, 1.7, 20000, 1e-5, 1e-4, 50, True, state, d,
    )  # fmt: skip
    assert value == pytest.approx(exact.objective, rel=1e-3)
    assert bound <= exact.objective * (1 + 1e-6)


def tried(problem, bound, gives_up):
    """(code, iterations) of the convex problem with a bound."""
    state, d = np.zeros((4, problem.count, 2)), np.zeros((problem.count, 2))
    return solve_bounded(
        with_bound(problem.packed, problem.first, problem.last), np.full(problem.count, bound), problem.first,
        problem.last, 1.7, 6000, 0.01, 0.006, 20, gives_up, state, d,
    )[:2]  # fmt: skip


def test_what_is_proven_impossible_is_impossible_for_cvxpy_too_and_soon():
    proven, possible, soon, late = 0, 0, 0, 0
    for seed in range(24):
        waypoints, centers, radii = disc_chain(np.random.default_rng(seed), 5, (0.4, 1.2), 0.4)
        bound = (0.02, 0.05, 0.1, 0.3)[seed % 4]
        problem = Problem.from_corridor(waypoints, centers, radii, max_curvature=bound)
        exact = solve_exact(problem).status
        code, count = tried(problem, bound, gives_up=True)
        if code == IMPOSSIBLE:
            assert exact == INFEASIBLE
            proven, soon = proven + 1, soon + count
            late += tried(problem, bound, gives_up=False)[1]
        else:
            assert code == CONVERGED
            possible += exact == COMPLETE
    assert proven >= 6 and possible >= 6 and soon < 0.5 * late


def test_no_direction_excludes_what_is_possible():
    """A curve that keeps the bound is among the displacements; so no direction proves that there is none."""
    rng = np.random.default_rng(0)
    corridor = disc_chain(rng, 8, (0.8, 2.5), 0.5)
    problem = Problem.from_corridor(*corridor, max_curvature=0.5)
    assert solve_exact(problem).status == COMPLETE
    packed, kappa = with_bound(problem.packed, problem.first, problem.last), np.full(problem.count, 0.5)
    pull = np.zeros((problem.count, 2))
    for size in np.geomspace(1e-6, 1e3, 200):
        ray = size * rng.normal(size=(problem.count, 2)) * (rng.random((problem.count, 1)) < 0.3)
        assert not excludes(packed, kappa, ray, pull, problem.first, problem.last)
    assert not excludes(packed, kappa, np.zeros((problem.count, 2)), pull, problem.first, problem.last)


def test_a_bound_that_does_not_bind_changes_nothing():
    corridor = disc_chain(np.random.default_rng(4), 8, (0.8, 2.5), 0.3)
    free = solve(Problem.from_corridor(*corridor))
    bound = 1.1 * curvature(free.points).max()
    assert np.array_equal(solve(Problem.from_corridor(*corridor, max_curvature=bound)).points, free.points)


def test_an_iteration_limit_is_kept():
    corridor = sharp_corner(np.random.default_rng(2), 0.5)
    solution = solve(problem_of(corridor, 0.5), iterations=50)
    assert solution.status == ITERATION_LIMIT
    assert solution.iterations <= 70


@pytest.mark.parametrize("seed", range(6))
def test_the_curve_is_as_near_to_the_best_as_was_asked_for_whatever_its_rounds(seed):
    """Also where the first round, which is a rough one, meets the bound at once."""
    solution = solve(problem_of(bounded_curve(np.random.default_rng(seed), 0.5, 0.1 + 0.06 * seed), 0.5))
    assert solution.gap <= 0.01 * solution.objective


def test_only_a_limited_run_gives_up_what_looks_hopeless(monkeypatch):
    corridor = bounded_curve(np.random.default_rng(1), 1.0, 0.1)
    patient, full = (solve(problem_of(corridor, 1.0), iterations=limit) for limit in (2000, None))
    monkeypatch.setattr(bounded, "HOPELESS", (1.0 + SLACK_OF_BOUND,))
    given_up, still = (solve(problem_of(corridor, 1.0), iterations=limit) for limit in (2000, None))
    assert patient.status == COMPLETE and np.array_equal(full.points, still.points)
    assert given_up.status == ITERATION_LIMIT and given_up.iterations < patient.iterations


def test_warm_start_under_a_bound_saves_iterations():
    cold_total = warm_total = 0
    for seed in range(6):
        corridor = bounded_curve(np.random.default_rng(seed), 0.5, 0.2 + 0.05 * seed)
        problem = problem_of(corridor, 0.5)
        cold = solve(problem)
        warm = solve(problem, warm=cold)
        assert_holds(warm, 0.5, *corridor[3:])
        cold_total, warm_total = cold_total + cold.iterations, warm_total + warm.iterations
    assert 0 < warm_total < cold_total


def test_warm_start_under_a_bound_takes_a_solution_without_one_and_the_other_way_round():
    corridor = bounded_curve(np.random.default_rng(3), 0.5, 0.3)
    free, bounded = problem_of(corridor, None), problem_of(corridor, 0.5)
    assert_holds(solve(bounded, warm=solve(free)), 0.5, *corridor[3:])
    assert solve(free, warm=solve(bounded)).objective <= 1.02 * solve(free).objective
