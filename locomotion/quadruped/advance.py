"""One call that advances every animal of a herd by one tick."""

from __future__ import annotations

import math

from numba import njit

from locomotion.quadruped import layout as at
from locomotion.quadruped.following import front_of, place_body, spring, wrap
from locomotion.quadruped.footfalls import misplaced, step_feet
from locomotion.quadruped.gait import step_gait
from locomotion.quadruped.motion import DT, advance_along
from locomotion.quadruped.pose import write_pose
from locomotion.quadruped.trail import trail_point

__all__ = ["advance_all"]

_HEIGHT_HALF_LIFE = 0.07  # [s]
_STRETCH, _TAUT = 0.90, 0.95  # shares of its length to which a standing leg should and can be stretched
_SOFT = 0.03  # share of a length over which a limit begins to pull the trunk down
_FAR = math.log1p(math.exp(-4.0))  # so that nothing pulls four times as far from it
_CROUCH = 0.25  # [1/rad²] of slope by which a body goes lower on it
_STEEPEST = 0.75  # of the spine's length between the heights of hips and shoulders; the higher ones come down
# for it, so that no foot leaves the ground
_GAZE_HALF_LIFE = 0.10  # [s]
_GAZE_NEAR = 0.12  # [m] nearer targets do not say where to look
_STILL = 1e-4  # [m, rad] of an offset that counts as gone
CRUMB_SPACING = 0.1
"""[m] between crumbs."""


@njit(cache=True)
def advance_all(state, params, gaits, pool, ground, origin, feet, crumbs, poses, pose_start, joints):
    """Advance all animals by one tick of 10 ms.

    state (n, STATE), params (kinds, PARAMS), gaits (kinds, g, GAIT), pool (rows, ROW), ground: see
    `trail.kernel_ground`, origin (3,), feet (n, 4, FOOT), crumbs (n, ring, 3); written: poses (bodies of
    all, 7) with those of animal i from pose_start[i] on, joints (n, JOINTS).
    """
    for i in range(state.shape[0]):
        st = state[i]
        kind = int(st[at.KIND])
        pr = params[kind]
        _move(st, pr, pool)
        place_body(st, pr, pool)
        step_gait(st, pr, gaits[kind], feet[i])
        settled = step_feet(st, pr, pool, ground, origin, feet[i])
        st[at.REST] = 1.0 if settled and _is_over(st) and not misplaced(st, pr, pool, feet[i]) else 0.0
        _carry(st, pr, feet[i])
        _look(st, pr, pool)
        _drop_crumb(st, crumbs[i])
        write_pose(st, pr, feet[i], poses[pose_start[i] : pose_start[i + 1]], joints[i])


@njit(cache=True, inline="always")
def _move(st, pr, pool):
    if st[at.MODE] == at.ON_TRAIL:
        advance_along(st, pr, pool)
    elif st[at.MODE] == at.SCRIPTED:
        st[at.SCRIPT_TIME] = min(st[at.SCRIPT_TIME] + DT, st[at.SCRIPT_LENGTH])


@njit(cache=True)
def _is_over(st):
    """Whether the motion has come to its end, and what was left of the one before has gone."""
    if st[at.MODE] == at.STANDING:
        return True
    if st[at.MODE] == at.ON_TRAIL and (st[at.STOPPING] == 0.0 or st[at.STOP_BEGIN] < st[at.STOP_TIME]):
        return False
    if st[at.MODE] == at.SCRIPTED and st[at.SCRIPT_TIME] < st[at.SCRIPT_LENGTH] - 1e-9:
        return False
    for k in range(4):
        if abs(st[at.OFFSET + k]) > _STILL:
            return False
    return True


@njit(cache=True)
def _highest(feet, joint_x, joint_y, direction, width, first, reach):
    """Height [m] at which both legs of a pair, ``first`` and the next, still reach their feet: those that
    swing too, so that nothing jumps when they come down."""
    highest = math.inf
    for k in range(2):
        foot = feet[first + k]
        side = 0.5 * width if k == 0 else -0.5 * width
        dx = foot[at.FX] - (joint_x - side * math.sin(direction))
        dy = foot[at.FY] - (joint_y + side * math.cos(direction))
        left = reach * reach - dx * dx - dy * dy
        highest = min(highest, foot[at.FZ] + math.sqrt(max(left, 0.01 * reach * reach)))
    return highest


@njit(cache=True)
def _carry(st, pr, feet):
    """Heights of hips and shoulders: over the ground as the feet feel it, and low enough for them."""
    twice = 4.0 * math.pi * st[at.CLOCK]
    bob = st[at.BOB_NOW] * math.cos(twice)
    rock = st[at.ROCK_NOW] * math.cos(0.5 * twice)
    crouch = 1.0 - _CROUCH * st[at.PITCH] * st[at.PITCH]
    for front in range(2):
        z = at.Z_FRONT if front else at.Z_REAR
        leg = 0 if front else 2
        height = pr[at.HEIGHT_FRONT] if front else pr[at.HEIGHT_REAR]
        sizes = at.UPPER_FRONT if front else at.UPPER_REAR
        wanted = (
            0.5 * (feet[leg, at.BASE] + feet[leg + 1, at.BASE])
            + crouch * height
            + bob
            + (rock if front else -rock)
        )
        reach = pr[sizes] + pr[sizes + 1] + pr[sizes + 2]
        if front:
            x, y, direction, width = st[at.FRONT_X], st[at.FRONT_Y], st[at.CHEST], pr[at.WIDTH_FRONT]
        else:
            x, y, direction, width = st[at.X], st[at.Y], st[at.YAW], pr[at.WIDTH_REAR]
        wanted = min(wanted, _highest(feet, x, y, direction, width, leg, _STRETCH * reach))
        off, st[z + 1] = spring(st[z] - wanted, st[z + 1], _HEIGHT_HALF_LIFE)
        st[z] = _below(wanted + off, _highest(feet, x, y, direction, width, leg, _TAUT * reach), reach)
    # the trunk tilts about the hips, which moves the shoulders, which may be too high there for their feet
    reach = pr[at.UPPER_FRONT] + pr[at.LOWER_FRONT] + pr[at.FOOT_FRONT]
    wanted = st[at.Z_FRONT]
    for _ in range(2):
        _tilt(st, pr)
        highest = _highest(
            feet, st[at.FRONT_X], st[at.FRONT_Y], st[at.CHEST], pr[at.WIDTH_FRONT], 0, _TAUT * reach
        )
        st[at.Z_FRONT] = _below(wanted, highest, reach)
    _tilt(st, pr)


@njit(cache=True, inline="always")
def _below(height, limit, size):
    """``height`` [m] kept under a limit, without a kink where it comes near it; ``size`` [m] of the body."""
    soft = _SOFT * size
    over = (height - limit) / soft
    down = math.log1p(math.exp(over)) if over < 30.0 else over
    return height - soft * max(down - _FAR, 0.0)


@njit(cache=True)
def _tilt(st, pr):
    """Pitch of the trunk from the heights of hips and shoulders, and the place of the front under it."""
    length = pr[at.BONES] * pr[at.BONE]
    st[at.Z_FRONT] = _below(st[at.Z_FRONT], st[at.Z_REAR] + _STEEPEST * length, length)
    st[at.Z_REAR] = _below(st[at.Z_REAR], st[at.Z_FRONT] + _STEEPEST * length, length)
    st[at.PITCH] = math.asin((st[at.Z_FRONT] - st[at.Z_REAR]) / length)
    st[at.FRONT_X], st[at.FRONT_Y] = front_of(
        st[at.X], st[at.Y], st[at.YAW], st[at.BEND], pr[at.BONES], pr[at.BONE] * math.cos(st[at.PITCH])
    )


@njit(cache=True)
def _look(st, pr, pool):
    """Turn neck and head to what is a time ahead on the trail, or to what was given."""
    x, y = st[at.LOOK_X], st[at.LOOK_Y]
    if st[at.FIXED_LOOK] == 0.0:
        x = math.nan
        if st[at.MODE] == at.ON_TRAIL and st[at.WAY] > 0.0:
            x, y, _ = trail_point(
                pool, int(st[at.ROW_START]), int(st[at.ROW_COUNT]), st[at.ROW_STEP],
                st[at.FRONT_ARC] + st[at.SPEED] * pr[at.LOOK_AHEAD],
            )  # fmt: skip
        st[at.LOOK_X], st[at.LOOK_Y] = x, y
    wanted = 0.0
    if not math.isnan(x):
        dx, dy = x - st[at.FRONT_X], y - st[at.FRONT_Y]
        far = dx * dx + dy * dy
        wanted = wrap(math.atan2(dy, dx) - st[at.CHEST]) * far / (far + _GAZE_NEAR * _GAZE_NEAR)
        wanted = min(max(wanted, -pr[at.HEAD_TURN]), pr[at.HEAD_TURN])
    off, st[at.GAZE_RATE] = spring(st[at.GAZE] - wanted, st[at.GAZE_RATE], _GAZE_HALF_LIFE)
    st[at.GAZE] = wanted + off


@njit(cache=True)
def _drop_crumb(st, ring):
    """Drop a crumb where the root is on its way forwards; on its way back take them up again."""
    size = ring.shape[0]
    last = int(st[at.CRUMB_LAST])
    dx, dy = 0.0, 0.0
    if st[at.CRUMBS] > 0.0:
        dx, dy = st[at.X] - ring[last, 0], st[at.Y] - ring[last, 1]
        if dx * dx + dy * dy < CRUMB_SPACING * CRUMB_SPACING:
            return
    if st[at.MODE] == at.ON_TRAIL and st[at.WAY] < 0.0:
        if st[at.CRUMBS] > 1.0:
            before = (last - 1) % size
            ax, ay = st[at.X] - ring[before, 0], st[at.Y] - ring[before, 1]
            if ax * ax + ay * ay < dx * dx + dy * dy:
                st[at.CRUMB_LAST] = float(before)
                st[at.CRUMBS] -= 1.0
        return
    last = (last + 1) % size
    ring[last, 0], ring[last, 1], ring[last, 2] = st[at.X], st[at.Y], st[at.HEIGHT]
    st[at.CRUMB_LAST] = float(last)
    st[at.CRUMBS] = min(st[at.CRUMBS] + 1.0, float(size))
