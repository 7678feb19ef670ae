"""Path tables and the tracker, with a point that turns and moves like the running controller's reference."""

from dataclasses import replace

import numpy as np
import pytest

from locomotion.errors import LocomotionError
from locomotion.human.on_feet import RUN_GAINS
from locomotion.paths import tracking as pt
from locomotion.paths.gait_plan import SLOWS_WITHIN, braking_length
from locomotion.paths.table import BRAKE, CURVATURE, FAST_WALK, GAIT

LIMITS = pt.TrackingLimits(speeds=(2.0, 4.0), sideways=2.0)


def circle(radius, turns=0.5, n=100):
    angle = np.linspace(0, 2 * np.pi * turns, n)
    return np.stack([radius * np.sin(angle), radius * (1 - np.cos(angle)), 0 * angle], axis=1)


def ride(points, speed, offset=0.0, drift=0.0, turn_rate=1.0, lag=0.2):
    """Follow a path with a point whose heading lags and whose course is `drift` [rad] off its heading.

    Returns lateral errors (n,) at every tick and the tracker's memory."""
    path = pt.make_path(points, speed, LIMITS, speed)
    memory, command = pt.new_track(), np.zeros(4)
    heading = course = float(path.table[0, pt.HEADING])
    rate, v = 0.0, speed
    x, y = path.table[0, :2] + offset * np.array([-np.sin(heading), np.cos(heading)])
    lateral = []
    for tick in range(6000):
        pt.track(path.table, path.length, RUN_GAINS, memory, x, y, v, tick, command)
        lateral.append(memory[pt.LATERAL])
        if memory[pt.REMAINING] < 0.5:
            return np.array(lateral), memory
        wanted = (command[0] - heading + np.pi) % (2 * np.pi) - np.pi
        rate += np.clip(np.clip(wanted / 0.15, -turn_rate, turn_rate) - rate, -0.04, 0.04)
        heading += 0.01 * rate
        course += 0.01 / lag * (heading + drift - course)
        v += np.clip(command[1] - v, -0.015, 0.015)
        x += 0.01 * (v * np.cos(course) - command[2] * np.sin(course))
        y += 0.01 * (v * np.sin(course) + command[2] * np.cos(course))
    raise AssertionError(f"did not arrive: {memory}")


def test_straight_path_from_beside_it_converges_without_swinging():
    lateral, _ = ride([[0, 0, 0], [40, 0, 0]], 3.5, offset=0.6)
    assert lateral[0] == pytest.approx(0.6)
    assert np.abs(lateral[300:]).max() < 0.05
    assert lateral.min() > -0.15


@pytest.mark.parametrize("radius", [4.0, 8.0])
def test_bends_are_followed(radius):
    lateral, _ = ride(circle(radius), 3.0, turn_rate=1.0)
    assert np.percentile(np.abs(lateral), 95) < 0.2


def test_steady_drift_is_taken_out():
    lateral, _ = ride([[0, 0, 0], [60, 0, 0]], 3.0, drift=0.05)
    assert np.abs(lateral[800:]).max() < 0.06


def test_foot_point_does_not_jump_to_the_other_arm_of_a_hairpin():
    arm = np.linspace(0, 20, 50)
    there = np.stack([arm, 0 * arm, 0 * arm], axis=1)
    back = np.stack([arm[::-1], 0 * arm + 0.3, 0 * arm], axis=1)
    path = pt.make_path(np.concatenate([there, back]), 3.0, LIMITS, 3.0)
    memory, command = pt.new_track(), np.zeros(4)
    for tick, x in enumerate(np.arange(0, 15, 0.03)):
        pt.track(path.table, path.length, RUN_GAINS, memory, x, 0.16, 3.0, tick, command)
    assert memory[pt.ARC] == pytest.approx(15, abs=0.1)


def test_speed_slows_in_bends_on_slopes_and_before_the_end():
    bend = np.concatenate([[[-15.0, 0, 0]], circle(2.0, 0.25), [[2.0, 20.0, 0]]])
    table = pt.make_path(bend, 4.0, LIMITS, 4.0).table
    in_bend = np.abs(table[:, pt.CURVATURE]) > 0.4
    assert table[in_bend, pt.SPEED].max() < 2.3
    assert table[-1, pt.SPEED] == 2.0
    assert table[:, pt.SPEED].max() > 3.9
    change = np.diff(table[:, pt.SPEED] ** 2) / (2 * pt.SPACING)
    assert change.min() > -LIMITS.deceleration * 1.05 and change.max() < LIMITS.acceleration * 1.05
    hill = [[0, 0, 0], [20, 0, 0], [40, 0, 6], [60, 0, 6]]
    table = pt.make_path(hill, 4.0, LIMITS, 4.0).table
    assert table[300, pt.SLOPE] == pytest.approx(0.3, abs=1e-6)
    assert table[300, pt.SPEED] < 3.5


@pytest.mark.parametrize("slope", [0.3, -0.3])
def test_one_with_foresight_goes_before_a_slope_as_slowly_as_on_it(slope):
    x = np.linspace(0.0, 12.0, 121)
    points = np.column_stack([x, np.zeros_like(x), slope * np.clip(x - 6.0, 0.0, 2.0)])
    limits = pt.TrackingLimits((0.3, 1.25), uphill=1.6, downhill=2.2, foresight=0.8)
    table = pt.make_path(points, 1.25, limits, 1.25).table
    x, speed, slow = table[:, 0], table[:, 6], 1.25 - (1.6 if slope > 0.0 else 2.2) * 0.3
    assert speed[(x > 5.75) & (x < 7.4)].max() < slow + 0.01
    late = pt.make_path(points, 1.25, replace(limits, foresight=0.0), 1.25).table
    assert speed[x < 5.6].mean() < late[x < 5.6, 6].mean()
    np.testing.assert_array_equal(speed[x > 8.6], late[x > 8.6, 6])


WALK = pt.TrackingLimits(speeds=(0.3, 1.25), sideways=0.5)
GENTLE = pt.TrackingLimits(speeds=(2.0, 4.0), sharpest=0.3, steepest=0.12, slowing=0.8)
SLOWING = (3.0**2 - 1.25**2) / 1.6
"""[m] in which a run at 3 m/s becomes a walk."""


def stretches(path):
    """(begin, end) [m] of what is run."""
    runs = path.table[:, pt.GAIT] == pt.RUN
    at = np.linspace(0.0, path.length, len(runs))
    ends = np.flatnonzero(np.diff(runs.astype(int), prepend=0, append=0)).reshape(-1, 2)
    return [(at[a], at[b - 1]) for a, b in ends]


def test_runs_where_the_way_is_straight_and_level_and_slows_down_in_time_before_the_rest():
    bend = np.concatenate([[[-15.0, 0, 0]], circle(2.0, 0.25), [[2.0, 20.0, 0]]])
    path = pt.make_path(bend, 3.0, GENTLE, 0.0, walk=WALK)
    first, second = stretches(path)
    assert first == (0.0, pytest.approx(15.0 - 1.0 - SLOWING, abs=0.4))
    assert second == (
        pytest.approx(15.0 + np.pi, abs=0.4),
        pytest.approx(path.length - 2.0 - SLOWING, abs=0.2),
    )
    assert path.runs(5.0) and not path.runs(16.0) and not path.runs(1e9)
    at = np.linspace(0.0, path.length, len(path.table))
    walked = (at > 15.0 - 1.0) & (at < 15.0 + np.pi - 0.5)
    assert path.table[walked, pt.SPEED].max() <= 1.25
    assert path.table[at < first[1], pt.SPEED].max() > 2.9  # slows down only behind it
    assert stretches(pt.make_path(bend, 1.5, GENTLE, 0.0, walk=WALK)) == []


def test_a_fast_walk_is_only_for_who_asks_for_it_where_it_is_level_and_no_run_is_near():
    brisk = replace(WALK, speeds=(0.3, 2.0), usual=1.25, foresight=0.8)
    slowing = (3.0**2 - 1.25**2) / 1.6
    hill = np.array([[0.0, 0, 0], [30, 0, 0], [40, 0, 1], [70, 0, 1]])
    told = pt.make_path(hill, 1.8, GENTLE, 1.25, walk=brisk)
    at = np.linspace(0.0, told.length, len(told.table))
    speeds = told.table[:, pt.SPEED]
    assert stretches(told) == [] and speeds.max() == pytest.approx(1.8)
    assert speeds[(at > 29.5) & (at < 40.5)].max() <= 1.25
    # who asks for a run and finds no room for one goes at the usual pace
    short = pt.make_path([[0, 0, 0], [10, 0, 0]], 3.0, GENTLE, 1.25, walk=brisk)
    assert stretches(short) == [] and short.table[:, pt.SPEED].max() <= 1.25
    # from the usual pace it runs up to an obstacle, and slows down to it
    over = pt.make_path([[0, 0, 0], [80, 0, 0]], 1.8, GENTLE, 1.25, edges=[40.0], walk=brisk)
    (begin, end), at = stretches(over)[0], np.linspace(0.0, over.length, len(over.table))
    speeds = over.table[:, pt.SPEED]
    assert speeds[at < begin - 4.5].max() == pytest.approx(1.8)
    assert speeds[(at > begin - 3.9) & (at < begin)].max() <= 1.25
    assert speeds[at > end + slowing].max() == pytest.approx(1.8)


def test_a_stretch_too_short_is_walked_unless_the_body_runs_already():
    straight = [[0, 0, 0], [10, 0, 0]]
    assert stretches(pt.make_path(straight, 3.0, GENTLE, 0.0, walk=WALK)) == []
    path = pt.make_path(straight, 3.0, GENTLE, 3.0, walk=WALK, running=True)
    assert stretches(path) == [(0.0, pytest.approx(8.0 - SLOWING, abs=0.1))]


def test_obstacles_are_run_up_to_from_behind_the_last_bend_and_one_after_another_without_a_walk_between():
    way = [[0, 0, 0], [8, 0, 0], [8, 10, 0], [8, 40, 0]]
    path = pt.make_path(way, 3.0, GENTLE, 0.0, edges=[18.0], walk=WALK)
    assert stretches(path)[0][0] == pytest.approx(8.3, abs=0.1)
    near = pt.make_path([[0, 0, 0], [8, 0, 0], [8, 40, 0]], 3.0, GENTLE, 0.0, edges=[12.0], walk=WALK)
    assert stretches(near)[0][0] == 0.0  # round the corner, if the rest is too short
    straight = [[0, 0, 0], [80, 0, 0]]
    path = pt.make_path(straight, 1.5, GENTLE, 0.0, edges=[18.0, 40.0], walk=WALK)
    assert stretches(path) == [(pytest.approx(3.0, abs=0.1), pytest.approx(45.0, abs=0.1))]


def where(path, gait):
    at = np.linspace(0.0, path.length, len(path.table))[path.table[:, GAIT] == gait]
    return (float(at[0]), float(at[-1])) if len(at) else None


def test_one_that_runs_brakes_where_it_cannot_slow_down_in_time():
    braking = braking_length(3.0) + SLOWS_WITHIN
    corner = [[0, 0, 0], [4, 0, 0], [4, 40, 0]]
    path = pt.make_path(corner, 3.0, GENTLE, 3.0, walk=WALK, running=True)
    bend = float(np.flatnonzero(np.abs(path.table[:, CURVATURE]) > GENTLE.sharpest)[0]) * 0.1
    assert bend == pytest.approx(3.8, abs=0.11)
    assert stretches(path)[0] == (0.0, pytest.approx(bend - braking, abs=0.15))
    assert where(path, BRAKE) == (pytest.approx(bend - braking, abs=0.15), pytest.approx(bend, abs=0.11))
    assert path.changed(bend - braking + 0.3, 1.0) and not path.changed(bend - 0.2, 1.0)
    far = [[0, 0, 0], [30, 0, 0], [30, 40, 0]]
    assert where(pt.make_path(far, 3.0, GENTLE, 3.0, walk=WALK, running=True), BRAKE) is None
    assert where(pt.make_path(corner, 3.0, GENTLE, 1.2, walk=WALK), BRAKE) is None  # it walks


def test_one_that_runs_to_a_goal_near_before_it_brakes():
    path = pt.make_path([[0, 0, 0], [4, 0, 0]], 3.0, GENTLE, 3.0, walk=WALK, running=True)
    assert where(path, BRAKE) == (pytest.approx(4.0 - 2.8, abs=0.15), 4.0)
    assert stretches(path) == [(0.0, pytest.approx(4.0 - 2.8, abs=0.15))]


def test_behind_an_obstacle_it_brakes_before_a_bend_but_lands_first():
    for depth, begin in ((7.0, 7.0 - 2.8), (3.0, 2.0)):
        way = [[0, 0, 0], [20 + depth, 0, 0], [20 + depth, 40, 0]]
        path = pt.make_path(way, 3.0, GENTLE, 0.0, edges=[20.0], walk=WALK)
        assert where(path, BRAKE)[0] == pytest.approx(20.0 + begin, abs=0.35)


@pytest.mark.parametrize(
    ("points", "speed", "message"),
    [
        ([[0, 0, 0]], 3.0, "at least two points"),
        ([[0, 0, 0], [0, 0, 1]], 3.0, "at least two points"),
        ([[0, 0, 0], [1, np.nan, 0]], 3.0, "point 1 of the path"),
        ([[0, 0], [1, 0]], 3.0, "shape"),
        ([[0, 0, 0], [1, 0, 0]], 0.0, "above 0"),
        ([[0, 0, 0], [1, 0, 0]], np.nan, "above 0"),
    ],
)
def test_bad_paths_are_refused(points, speed, message):
    with pytest.raises(LocomotionError, match=message):
        pt.make_path(points, speed, LIMITS, 2.0)


def stepped(height, at=10.0, edge=0.12):
    """A straight way of 20 m with a step in the ground, which a path shows over a little way."""
    return [[0, 0, 0], [at - edge, 0, 0], [at + edge, 0, height], [20, 0, height]]


@pytest.mark.parametrize("height", [0.05, -0.05, 0.15])
def test_it_slows_down_before_a_step_in_the_ground_but_not_for_a_slope(height):
    walk = pt.TrackingLimits(speeds=(0.3, 1.6), foresight=0.8, steps=0.85, uphill=0.0, downhill=0.0)
    path = pt.make_path(stepped(height), 1.6, walk, 1.0)
    along = np.linspace(0.0, path.length, len(path.table))
    there = np.abs(along - 10.0) < 0.9
    assert path.table[there, pt.SPEED] == pytest.approx(0.85)
    assert path.table[(along > 4.0) & (along < 7.0), pt.SPEED] == pytest.approx(1.6)
    free = pt.make_path(stepped(height), 1.6, replace(walk, steps=np.inf), 1.0)
    assert free.table[there, pt.SPEED] == pytest.approx(1.6)
    slope = pt.make_path(stepped(height, edge=1.5), 1.6, walk, 1.0)
    assert slope.table[there, pt.SPEED] == pytest.approx(1.6)
    crossed = pt.make_path(stepped(height), 1.6, walk, 1.0, edges=[10.0])
    assert crossed.table[there, pt.SPEED] == pytest.approx(1.6)


def test_a_gait_that_is_not_for_steps_ends_before_them():
    walk = pt.TrackingLimits(speeds=(0.3, 1.25), foresight=0.8)
    points = np.array(stepped(0.1)) * [2.0, 1.0, 1.0]
    for steps, runs in ((np.inf, True), (0.0, False)):
        run = pt.TrackingLimits(speeds=(2.5, 4.0), steepest=0.12, steps=steps)
        table = pt.make_path(points, 3.5, run, 0.0, walk=walk).table
        near = np.abs(table[:, 0] - 20.0) < 1.0
        assert (table[near, GAIT] == pt.RUN).all() == runs
        assert (table[:, GAIT] == pt.RUN).any()


def test_it_walks_fast_only_where_it_could_slow_down_before_a_slope():
    walk = pt.TrackingLimits(speeds=(0.3, 1.8), foresight=0.8, usual=1.25, deceleration=0.5)
    points = [[0, 0, 0], [20, 0, 0], [26, 0, 0.9], [40, 0, 0.9]]
    table = pt.make_path(points, 1.8, pt.TrackingLimits(speeds=(2.5, 4.0)), 0.0, walk=walk).table
    fast = table[table[:, GAIT] == FAST_WALK, 0]
    slowing = (1.8**2 - 1.25**2) / (2.0 * 0.5)
    before = fast[fast < 20.0]
    assert before.max() == pytest.approx(20.0 - 0.8 - slowing, abs=0.5)
    assert before.min() < 3.0
