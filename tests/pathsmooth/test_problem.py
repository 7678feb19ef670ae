"""Making a problem: subdivision, portals, discs, and wrong input."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.corridors import disc_chain
from pathsmooth import Problem, solve
from pathsmooth.errors import PathSmoothError

PATH = np.array([[0.0, 0, 0], [4, 0, 1]])
CENTERS = np.array([[0.0, 0, 0], [2, 0, 0], [4, 0, 0]])
RADII = np.array([1.5, 1.5, 1.5])


@settings(max_examples=60, deadline=None, derandomize=True)
@given(seed=st.integers(0, 2**32 - 1), spacing=st.sampled_from([0.1, 0.25, 0.6]))
def test_waypoints_lie_on_the_path_and_in_both_discs_of_their_segments(seed, spacing):
    rng = np.random.default_rng(seed)
    waypoints, centers, radii = disc_chain(rng, int(rng.integers(1, 20)))
    problem = Problem.from_corridor(waypoints, centers, radii, spacing=spacing)
    assert problem.outside(problem.targets) < 3e-9
    assert np.all(np.diff(problem.segment_disc) >= 0)
    assert np.diff(problem.arc).max() <= spacing * (1 + 1e-9)
    on_path = np.column_stack([np.interp(problem.arc, problem.source, problem.source)])
    assert on_path[0, 0] == 0.0
    # targets leave the pulled path only where waypoints were merged
    t = problem.arc
    total = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(waypoints, axis=0).T))])
    exact = np.column_stack([np.interp(t, total, waypoints[:, axis]) for axis in range(2)])
    assert np.linalg.norm(problem.targets - exact, axis=1).max() <= 0.11 * spacing


def test_height_is_carried_along():
    problem = Problem.from_corridor(PATH, CENTERS, RADII)
    assert np.allclose(problem.heights, problem.arc / 4)
    assert np.allclose(solve(problem).points[:, 2], problem.heights)


def test_a_disc_that_is_not_needed_is_left_out():
    centers = np.array([[0.0, 0], [2, 0], [2, 0], [4, 0]])
    problem = Problem.from_corridor(PATH, centers, [2.1, 0.0, 2.1, 2.1])
    assert 1 not in problem.segment_disc


def test_discs_that_touch_in_one_point_hold_the_waypoint_there():
    problem = Problem.from_corridor([[0, 0], [4, 0]], [[1, 0], [3, 0]], [1.0, 1.0])
    portal = int(np.argmin(np.abs(problem.arc - 2.0)))
    assert problem.arc[portal] == pytest.approx(2.0, abs=1e-8)
    points = solve(problem).points
    assert np.allclose(points[portal], [2, 0, 0], atol=1e-8)


def test_a_disc_of_no_radius_pins_the_path():
    waypoints = [[0, 0.2], [1, 0], [2, 0.2]]
    problem = Problem.from_corridor(waypoints, [[0.45, 0], [1, 0], [1.55, 0]], [0.55, 0.0, 0.55])
    solution = solve(problem)
    assert np.min(np.linalg.norm(solution.points[:, :2] - [1, 0], axis=1)) < 1e-7
    assert solution.status == "complete"


def test_repeated_waypoints_change_nothing():
    repeated = np.array([[0.0, 0, 0], [0, 0, 0], [2, 0, 0.5], [2, 0, 0.5], [4, 0, 1], [4, 0, 1]])
    one = Problem.from_corridor(PATH, CENTERS, RADII)
    other = Problem.from_corridor(repeated, CENTERS, RADII)
    assert np.allclose(one.targets, other.targets)


def test_a_path_shorter_than_the_spacing_has_four_segments():
    problem = Problem.from_corridor(
        [[0, 0], [0.01, 0.01]], [[0, 0]], [1.0], start_tangent=[1, 0], end_tangent=[1, 0]
    )
    assert problem.count >= 5
    solution = solve(problem)
    assert solution.status == "complete"
    assert np.isfinite(solution.points).all()


def test_tangent_against_the_path():
    problem = Problem.from_corridor(PATH, CENTERS, RADII, start_tangent=[-1, 0], end_tangent=[-1, 0])
    solution = solve(problem)
    assert solution.status == "complete"
    assert problem.outside(solution.points) < 1e-9
    assert solution.points[1, 0] < 0


def test_a_disc_may_be_missed_by_rounding_only():
    Problem.from_corridor([[0, 0], [4, 0]], [[1, 0], [3, 0]], [1.0, 1.0 - 5e-10])
    with pytest.raises(PathSmoothError, match="corridor has a gap"):
        Problem.from_corridor([[0, 0], [4, 0]], [[0.9, 0], [3, 0]], [1.0, 1.1 - 1e-6])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"waypoints": [[0, 0]]}, "has 1 rows; a path has at least 2"),
        ({"waypoints": [0.0, 1.0]}, r"waypoints has shape \(2,\), not \(n, 2\) or \(n, 3\)"),
        ({"waypoints": [[0, 0], [np.nan, 0]]}, r"waypoints\[1\] is not finite"),
        ({"waypoints": "path"}, "waypoints must be an array of numbers"),
        ({"waypoints": [[1, 1, 0], [1, 1, 5]]}, "no horizontal length"),
        ({"centers": [[0, 0], [2, 0]]}, "2 centers but 3 radii"),
        ({"centers": [[0, 0, 0, 0]]}, "centers has shape"),
        ({"centers": np.full((3, 2), np.inf)}, r"centers\[0\] is not finite"),
        ({"radii": [1.5, -0.1, 1.5]}, r"radii\[1\] is -0.1 m"),
        ({"radii": [[1.5], [1.5], [1.5]]}, r"radii has shape \(3, 1\), not \(n,\)"),
        ({"centers": np.zeros((0, 2)), "radii": []}, "the corridor has no discs"),
        ({"radii": [1.5, 0.2, 1.5]}, r"discs 0 to 0 in order cover the path up to arc length 1.5 m of 4 m, "
                                     r"where it is 0.3 m outside disc 1"),
        ({"waypoints": [[-3, 0], [4, 0]]}, "the path starts 1.5 m outside disc 0"),
        ({"waypoints": [[0, 0], [7, 0]]}, "cover the path up to arc length 5.5 m of 7 m"),
        ({"spacing": 0.0}, r"spacing must be a positive number \[m\], not 0.0"),
        ({"spacing": "fine"}, "spacing must be a positive number"),
        ({"smoothness": -1.0}, "smoothness must be a positive number"),
        ({"max_curvature": 0.0}, r"max_curvature must be a positive number \[1/m\]"),
        ({"start_tangent": [0, 0, 1]}, "start_tangent has no horizontal part"),
        ({"end_tangent": [np.inf, 0]}, "end_tangent must be a finite direction"),
        ({"end_tangent": 3}, "end_tangent must be a finite direction"),
    ],
)  # fmt: skip
def test_wrong_input(change, message):
    given = {"waypoints": PATH, "centers": CENTERS, "radii": RADII} | change
    with pytest.raises(PathSmoothError, match=message):
        Problem.from_corridor(**given)


def test_objective_of_points_of_another_problem_is_refused():
    problem = Problem.from_corridor(PATH, CENTERS, RADII)
    with pytest.raises(PathSmoothError, match="the problem has"):
        problem.objective(np.zeros((3, 2)))


@settings(max_examples=60, deadline=None, derandomize=True)
@given(seed=st.integers(0, 2**32 - 1), by=st.sampled_from([0.05, 0.2, 1.0]))
def test_narrowed_discs_still_hold_the_targets_and_the_solution(seed, by):
    rng = np.random.default_rng(seed)
    waypoints, centers, radii = disc_chain(rng, int(rng.integers(1, 20)))
    problem = Problem.from_corridor(waypoints, centers, radii)
    narrow = problem.narrowed(by)
    assert narrow.outside(narrow.targets) < 3e-9
    assert (narrow.radii <= problem.radii).all() and (narrow.radii >= problem.radii - by - 1e-12).all()
    for j, radius in enumerate(narrow.radii):  # as small as it may be
        held = np.flatnonzero(problem.segment_disc == j)
        ends = problem.targets[np.union1d(held, held + 1)]
        farthest = np.linalg.norm(ends - problem.centers[j], axis=1).max(initial=0.0)
        assert radius == pytest.approx(min(max(problem.radii[j] - by, farthest), problem.radii[j]))
    solution = solve(narrow)
    assert solution.status == "infeasible" or narrow.outside(solution.points) < 1e-6


def test_a_corridor_is_narrowed_by_a_positive_length():
    with pytest.raises(PathSmoothError, match="by must be a positive number"):
        Problem.from_corridor(PATH, CENTERS, RADII).narrowed(0.0)
