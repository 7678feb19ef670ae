"""Where a walking person puts its feet, against slow and independent versions."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from locomotion.gaits.walk.footholds import (
    bearing,
    foot_frame,
    ground_at,
    plan_foothold,
    steps_ahead,
    sway,
)
from locomotion.gaits.walk.layout import (
    CLOCK,
    FOOTHOLD,
    FOOTHOLD_NORMAL,
    GAINS,
    PHASE,
    SINGLE,
    SWING_TIME,
    WALK_SPEED,
    WALK_STANCE,
    first_gains,
    new_walk,
    step_share,
)
from locomotion.ground.ground import Ground, plane_lookup
from locomotion.training.gaits.grounds import KINDS, ground_height, training_ground


@pytest.mark.parametrize("kind", KINDS)
def test_ground_below_a_point_is_what_the_ground_itself_says(kind):
    ground = training_ground(kind)
    points = np.random.default_rng(0).uniform([-39, -39, 6], [39, 39, 9], (200, 3))
    heights, normals = ground.surface_below(points)
    found = np.array([ground_at(ground.lookup, *p) for p in points])
    assert np.allclose(found[:, 0], heights, atol=1e-9) and np.allclose(found[:, 1:], normals, atol=1e-9)
    off = np.abs(heights - ground_height(kind, points[:, 0], points[:, 1])).max()
    assert off < (0.25 if kind == "crags" else 0.12)  # flat within squares
    assert math.isnan(ground_at(ground.lookup, 0.0, 0.0, -10.0)[0])


def pendulum(x, v, pivot, omega, time, parts=20_000):
    """Linear inverted pendulum integrated in small steps."""
    dt = time / parts
    for _ in range(parts):
        v = v + omega * omega * (x - pivot) * dt
        x = x + v * dt
    return x, v


@pytest.mark.parametrize("speed", [0.0, 0.6, 1.2])
def test_steady_walk_of_the_pendulum_repeats_itself(speed):
    """Starting `sway` ahead and inside of one foot, a pendulum is so of the next foot a step later."""
    gains = first_gains()
    omega = math.sqrt(9.81 / 0.92)
    period, width = gains[list(GAINS).index("swing_time")], gains[list(GAINS).index("width")]
    period += gains[list(GAINS).index("transfer_time")]
    ahead, inside = sway(gains, omega, speed)
    for start, foot, end in ((ahead, 0.0, speed * period + ahead), (-inside, 0.0, -width + inside)):
        x, v = pendulum(start, 0.0, foot, omega, period)
        assert x + v / omega == pytest.approx(end, abs=2e-4)


def test_foothold_catches_a_pushed_pendulum():
    """Where the plan says the foot goes, a pendulum pushed in any direction comes back to the steady walk."""
    gains, walk, omega = first_gains(), new_walk(), math.sqrt(9.81 / 0.92)
    period = gains[0] + gains[1]
    for push in ((0.25, 0.0), (-0.15, 0.0), (0.0, -0.15)):
        walk[WALK_SPEED], walk[WALK_STANCE], foot = 0.5, 1.0, np.array([0.0, 0.085, 0.0])
        ahead, inside = sway(gains, omega, 0.5)
        capture = foot[:2] + np.array([ahead + 0.3 * push[0], 0.3 * push[1] - inside])
        for _ in range(8):
            walk[PHASE], walk[CLOCK], walk[SWING_TIME] = SINGLE, 0.0, gains[0]
            hip = foot + np.array([0.0, -walk[WALK_STANCE] * 0.17, 0.85])
            plan_foothold(gains, plane_lookup(), walk, capture[0], capture[1], omega, foot, hip, 0.0)
            time = walk[SWING_TIME] + 0.5 * gains[1]
            capture = foot[:2] + (capture - foot[:2]) * math.exp(omega * time)
            foot = walk[FOOTHOLD].copy()
            walk[WALK_STANCE] = -walk[WALK_STANCE]
        side = walk[WALK_STANCE]
        assert capture[0] - foot[0] == pytest.approx(ahead, abs=0.06)
        assert -side * (capture[1] - foot[1]) == pytest.approx(inside, abs=0.06)
    assert period > 0.3


@pytest.mark.parametrize("stance", [-1.0, 1.0])
def test_a_step_is_made_sooner_where_the_body_drifts_over_the_foot_that_bears(stance):
    """The feet do not cross: the other foot comes down at once, and the step after that catches the body."""
    gains, omega = first_gains(), 3.3
    swings = []
    for drift in (0.0, 0.02, 0.06, 0.12):  # of the capture point beyond the foot, outwards
        walk, foot = new_walk(), np.array([0.0, 0.085 * stance, 0.0])
        walk[WALK_STANCE], walk[PHASE], walk[SWING_TIME] = stance, SINGLE, gains[0]
        hip = foot + np.array([0.0, -stance * 0.17, 0.85])
        _, inside = sway(gains, omega, 0.0)
        capture = foot[1] - stance * (inside * math.exp(-omega * (gains[0] + 0.5 * gains[1])) - drift)
        plan_foothold(gains, plane_lookup(), walk, 0.0, capture, omega, foot, hip, 0.0)
        assert stance * (foot[1] - walk[FOOTHOLD][1]) > 0.0
        swings.append(walk[SWING_TIME])
    assert swings[0] == swings[1] == gains[0] and swings[3] <= swings[2] < gains[0]


def test_foothold_keeps_off_an_edge_and_lies_on_the_ground():
    step = np.array([[-2, -2, 0], [0.32, -2, 0], [0.32, 2, 0], [-2, 2, 0], [0.32, -2, 0.12], [4, -2, 0.12]])
    step = np.vstack([step, [[4, 2, 0.12], [0.32, 2, 0.12]]]).astype(float)
    ground = Ground.from_arrays(step, [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7], [1, 4, 7], [1, 7, 2]])
    gains, walk, omega = first_gains(), new_walk(), 3.3
    walk[WALK_SPEED], walk[PHASE], walk[SWING_TIME] = 0.6, SINGLE, gains[0]
    for reach in np.linspace(0.05, 0.16, 12):
        foot, hip = np.array([0.0, 0.085, 0.0]), np.array([0.15, -0.085, 0.85])
        plan_foothold(gains, ground.lookup, walk, reach, 0.03, omega, foot, hip, 0.0)
        x, _, z = walk[FOOTHOLD]
        toe, heel = x + 0.12, x - 0.08
        assert z == pytest.approx(0.0 if toe < 0.32 else 0.12, abs=1e-9)
        assert np.allclose(walk[FOOTHOLD_NORMAL], [0, 0, 1])
        assert toe < 0.35 or heel > 0.29, "nearly all of the sole is on one side"


@pytest.mark.parametrize(
    ("height", "share"), [(0.0, 0.0), (0.015, 0.0), (0.06, 1.0), (-0.06, 1.0), (0.2, 1.0)]
)
def test_a_step_ahead_counts_as_stairs_whatever_the_height_of_a_tilted_sole(height, share):
    step = np.array(
        [[x, y, z] for x, z in ((-2, 0), (0.45, 0), (0.451, height), (4, height)) for y in (-2, 2.0)]
    )
    faces = [f for k in range(3) for f in ([2 * k, 2 * k + 2, 2 * k + 3], [2 * k, 2 * k + 3, 2 * k + 1])]
    ground = Ground.from_arrays(step, faces)
    for raised in (0.0, 0.04):
        found = steps_ahead(ground.lookup, np.array([0.0, 0.0, raised]), 1.0, 0.0)
        assert step_share(found) == pytest.approx(share)


@given(seed=st.integers(0, 10_000))
@settings(max_examples=60, deadline=None)
def test_bearing_point_is_where_a_rigid_foot_touches(seed):
    """Against a brute-force search for the lowest points of a sole above a plane."""
    rng = np.random.default_rng(seed)
    normal = np.array([*rng.uniform(-0.3, 0.3, 2), 1.0])
    corners = np.array([[-5, -5], [5, -5], [5, 5], [-5, 5]], dtype=float)
    corners = np.column_stack([corners, -(corners @ normal[:2])])
    ground = Ground.from_arrays(corners, [[0, 1, 2], [0, 2, 3]])
    frame, out = np.empty((3, 3)), np.empty(4)
    tilt = np.array([*rng.uniform(-0.3, 0.3, 2), 1.0])
    foot_frame(rng.uniform(-3, 3), tilt / np.linalg.norm(tilt), frame)
    u, v = (g.ravel() for g in np.meshgrid([-0.11, 0.11], [-0.035, 0.035]))
    points = np.outer(u, frame[:, 0]) + np.outer(v, frame[:, 1])
    gaps = points @ normal
    bearing(ground.lookup, np.array([0.0, 0.0, 0.05 - gaps.min()]), frame.ravel(), out)
    weights = np.maximum(1.0 - (gaps - gaps.min()) / 0.02, 0.0)
    weights /= weights.sum()
    assert out[0] == pytest.approx(weights @ u, abs=1e-9) and out[1] == pytest.approx(weights @ v, abs=1e-9)
    spread = [
        math.sqrt(max(weights @ (w / w.max()) ** 2 - (weights @ (w / w.max())) ** 2, 0)) for w in (u, v)
    ]
    assert np.allclose(out[2:], spread, atol=1e-6)


def test_foot_frame_stands_on_the_slope():
    normal, frame = np.array([-0.3, 0.1, 1.0]) / np.linalg.norm([-0.3, 0.1, 1.0]), np.empty((3, 3))
    foot_frame(0.7, normal, frame)
    assert np.allclose(frame.T @ frame, np.eye(3)) and np.allclose(frame[:, 2], normal)
    across = np.cross([math.cos(0.7), math.sin(0.7), 0.0], normal)
    assert frame[:, 0] @ across == pytest.approx(0.0, abs=1e-12) and frame[0, 0] > 0.0
