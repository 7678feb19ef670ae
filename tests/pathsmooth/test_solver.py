"""Smoothing without a bound on curvature: validity, optimality, warm start, symmetry."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.corridors import disc_chain
from pathsmooth import PathSmoothError, Problem, kernels, reference, solve, solve_tightest
from pathsmooth.solver import RELAXATION
from tests.pathsmooth.chains import corridor, ends

seeds = st.integers(0, 2**32 - 1)
quiet = settings(max_examples=40, deadline=None, derandomize=True)


def outside_union(points, problem, samples=9):
    """[m] how far samples on every segment are outside all discs: independent of the assignment."""
    t = np.linspace(0, 1, samples)[:, None, None]
    curve = ((1 - t) * points[:-1, :2] + t * points[1:, :2]).reshape(-1, 2)
    distance = np.linalg.norm(curve[:, None] - problem.centers, axis=2) - problem.radii
    return distance.min(axis=1).max()


@quiet
@given(seed=seeds, tangents=st.booleans(), iterations=st.sampled_from([0, 1, 7, 12, None]))
def test_never_leaves_the_corridor_and_never_raises_the_objective(seed, tangents, iterations):
    waypoints, centers, radii = corridor(seed)
    start, end = ends(waypoints) if tangents else (None, None)
    problem = Problem.from_corridor(waypoints, centers, radii, start_tangent=start, end_tangent=end)
    solution = solve(problem, iterations=iterations)
    assert problem.outside(solution.points) < 3e-9
    assert outside_union(solution.points, problem) < 3e-9
    assert solution.objective <= problem.objective(problem.targets) * (1 + 1e-12)
    assert solution.objective == pytest.approx(problem.objective(solution.points), rel=1e-9, abs=1e-12)
    assert np.array_equal(solution.points[[0, -1], :2], waypoints[[0, -1]])
    if iterations is None:
        assert solution.status == "complete"
        assert solution.gap <= 0.0101 * solution.objective + 1e-12
    else:
        assert solution.iterations <= iterations


@pytest.mark.parametrize("seed", range(6))
def test_kernel_does_what_the_plain_reference_does(seed):
    waypoints, centers, radii = corridor(seed, radius=(0.3, 2.0))
    start, end = ends(waypoints) if seed % 2 else (None, None)
    problem = Problem.from_corridor(waypoints, centers, radii, start_tangent=start, end_tangent=end)
    expected = reference.pentadiagonal(problem, 15, RELAXATION)
    state = np.zeros((3, problem.count, 2))
    left = np.zeros((problem.count, 2))
    kernels.iterate(problem.packed, problem.first, problem.last, RELAXATION, 15, *state, left)
    for mine, theirs in zip(state, expected, strict=True):
        assert np.allclose(mine, theirs, rtol=1e-8, atol=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_plain_two_pass_algorithm_reaches_the_same_optimum(seed):
    problem = Problem.from_corridor(*corridor(seed, discs=6, radius=(0.5, 2.0)))
    plain = reference.two_pass(problem, 3000)
    assert problem.objective(plain) == pytest.approx(solve(problem, tolerance=1e-6).objective, rel=2e-3)
    assert problem.outside(plain) < 1e-9


@quiet
@given(seed=seeds, angle=st.floats(-3.1, 3.1), mirror=st.booleans(), far=st.sampled_from([0.0, 5000.0]))
def test_turning_moving_and_mirroring_the_corridor_does_the_same_to_the_path(seed, angle, mirror, far):
    waypoints, centers, radii = corridor(seed, radius=(0.3, 2.0))
    c, s = np.cos(angle), np.sin(angle)
    matrix = np.array([[c, -s], [s, c]]) @ np.diag([1.0, -1.0 if mirror else 1.0])
    shift = np.array([far, -far])
    one = solve(Problem.from_corridor(waypoints, centers, radii), tolerance=1e-5)
    other = solve(
        Problem.from_corridor(waypoints @ matrix.T + shift, centers @ matrix.T + shift, radii), tolerance=1e-5
    )
    assert other.objective == pytest.approx(one.objective, rel=1e-4, abs=1e-8)
    if len(one.points) == len(other.points):
        assert np.allclose(one.points[:, :2] @ matrix.T + shift, other.points[:, :2], atol=0.02)


def test_warm_start_of_the_same_problem_needs_hardly_an_iteration():
    problem = Problem.from_corridor(*corridor(5, discs=14))
    cold = solve(problem)
    warm = solve(problem, warm=cold)
    assert warm.iterations <= 1 < cold.iterations
    assert warm.status == "complete"


@pytest.mark.parametrize("seed", range(5))
def test_warm_start_when_the_start_has_advanced(seed):
    waypoints, centers, radii = corridor(seed + 40, discs=12, radius=(0.5, 2.5))
    cold = solve(Problem.from_corridor(waypoints, centers, radii))
    advanced = waypoints.copy()
    advanced[0] += 0.3 * (waypoints[1] - waypoints[0])
    passed = int(np.argmax(np.linalg.norm(centers - advanced[0], axis=1) <= radii))
    problem = Problem.from_corridor(advanced, centers[passed:], radii[passed:])
    warm = solve(problem, warm=cold)
    assert warm.status == "complete"
    assert warm.iterations <= solve(problem).iterations
    assert warm.objective <= 1.011 * solve(problem, tolerance=1e-4).objective


def test_end_tangents_are_exact_and_cost_little():
    waypoints, centers, radii = (
        np.array([[0.0, 0], [6, 0]]),
        np.array([[0.0, 0], [3, 0], [6, 0]]),
        np.full(3, 2.0),
    )
    start, end = np.array([1.0, 2.0]), np.array([0.0, -3.0, 1.0])
    problem = Problem.from_corridor(waypoints, centers, radii, start_tangent=start, end_tangent=end)
    points = solve(problem).points[:, :2]
    first, last = points[1] - points[0], points[-1] - points[-2]
    assert np.allclose(first / np.linalg.norm(first), start / np.linalg.norm(start), atol=1e-12)
    assert np.allclose(last / np.linalg.norm(last), [0.0, -1.0], atol=1e-12)
    assert problem.outside(points) == 0.0


def test_a_tangent_that_leads_out_of_the_corridor_is_infeasible():
    waypoints, centers, radii = [[0, 0], [4, 0]], [[2, 0]], [2.0]
    for tangents in ({"start_tangent": [-1, 0]}, {"end_tangent": [-1, 0]}):
        solution = solve(Problem.from_corridor(waypoints, centers, radii, **tangents))
        assert solution.status == "infeasible"
        assert "tangent" in solution.problem.obstruction
        assert solution.problem.outside(solution.points) == 0.0


def test_a_straight_path_stays_straight_without_iterating():
    solution = solve(Problem.from_corridor([[0, 0, 1], [5, 0, 2]], [[2.5, 0]], [3.0]))
    assert solution.iterations == 0 and solution.status == "complete" and solution.objective == 0.0
    assert np.allclose(solution.points[:, 1], 0.0)
    assert np.allclose(solution.points[:, 2], 1.0 + solution.points[:, 0] / 5.0)


def test_objective_hardly_depends_on_the_spacing():
    waypoints, centers, radii = corridor(3, discs=12, radius=(0.6, 2.5))
    values = [
        solve(Problem.from_corridor(waypoints, centers, radii, spacing=h), tolerance=1e-4).objective
        for h in (0.125, 0.25, 0.5)
    ]
    assert max(values) <= 1.3 * min(values)


def test_iterations_and_tolerance_are_checked():
    problem = Problem.from_corridor([[0, 0], [4, 0]], [[2, 0]], [2.0])
    with pytest.raises(PathSmoothError, match="iterations must be 0 or more"):
        solve(problem, iterations=-1)
    with pytest.raises(PathSmoothError, match="tolerance must be 0 or more"):
        solve(problem, tolerance=np.nan)


def test_five_thousand_waypoints():
    rng = np.random.default_rng(0)
    waypoints, centers, radii = disc_chain(rng, 900, (0.3, 2.5), 0.3)
    problem = Problem.from_corridor(waypoints, centers, radii)
    assert problem.count > 4000
    solution = solve(problem)
    assert solution.status == "complete"
    assert problem.outside(solution.points) < 3e-9


@settings(max_examples=12, deadline=None, derandomize=True)
@given(seed=seeds, tangents=st.booleans(), budget=st.sampled_from([12, 200]))
def test_the_tightest_bound_is_found_as_by_one_solve_after_the_other(seed, tangents, budget):
    waypoints, centers, radii = corridor(seed)
    start, end = ends(waypoints) if tangents else (None, None)
    bounds, best, held = (0.4, 0.9, 0.15), None, False
    for bound in (None, *sorted(bounds, reverse=True)):
        problem = Problem.from_corridor(
            waypoints, centers, radii, start_tangent=start, end_tangent=end, max_curvature=bound
        )
        found = solve(problem, None if bound is None else budget)
        if found.status == "infeasible" or (bound is not None and found.status != "complete"):
            break
        best, held = found, bound is not None
    got, got_held = solve_tightest(problem, bounds, budget)
    if best is None:
        assert got.status == "infeasible" and not got_held
    else:
        assert np.array_equal(got.points, best.points) and got_held == held
        assert got.problem.max_curvature == best.problem.max_curvature
