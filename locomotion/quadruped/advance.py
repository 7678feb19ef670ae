"""Advance every animal of a herd by one tick."""

from __future__ import annotations

import math

from locomotion.quadruped import layout as at
from locomotion.quadruped.back import girdles, pelvis_pitch
from locomotion.quadruped.body_on_path import place_body, spring, wrap
from locomotion.quadruped.carriage import carry
from locomotion.quadruped.footfalls import misplaced, step_feet
from locomotion.quadruped.gait import step_gait
from locomotion.quadruped.idle import look_about
from locomotion.quadruped.motion import DT, advance_along
from locomotion.quadruped.pose import write_pose
from locomotion.quadruped.tail import swing_tail
from locomotion.quadruped.trail import trail_point
from locomotion.quadruped.trunk import move_trunk
from surefoot.kernels import kernel

__all__ = ["advance_all"]

_GAZE_HALF_LIFE = 0.10  # [s]
_GAZE_NEAR = 0.12  # [m] nearer targets give no direction to look in
_STILL = 1e-4  # [m, rad] an offset below this counts as gone
CRUMB_SPACING = 0.1
"""[m] between crumbs."""


@kernel
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
        gait = gaits[kind, int(st[at.GAIT_NOW])]
        settled = step_feet(st, pr, gait, pool, ground, origin, feet[i])
        st[at.REST] = 1.0 if settled and _is_over(st) and not misplaced(st, pr, pool, feet[i]) else 0.0
        move_trunk(st, pr, gait)
        carry(st, pr, feet[i])
        _look(st, pr, pool)
        swing_tail(st, pr, girdles(st, pr)[2], pelvis_pitch(st, pr))
        _drop_crumb(st, crumbs[i])
        write_pose(st, pr, feet[i], poses[pose_start[i] : pose_start[i + 1]], joints[i])


@kernel(forceinline=True)
def _move(st, pr, pool):
    if st[at.MODE] == at.ON_TRAIL:
        advance_along(st, pr, pool)
    elif st[at.MODE] == at.SCRIPTED:
        st[at.SCRIPT_TIME] = min(st[at.SCRIPT_TIME] + DT, st[at.SCRIPT_LENGTH])


@kernel
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


@kernel
def _look(st, pr, pool):
    """Turn neck and head to what is a time ahead on the trail, or to what was given; else look about."""
    x, y = st[at.LOOK_X], st[at.LOOK_Y]
    if st[at.FIXED_LOOK] == 0.0:
        x = math.nan
        if st[at.MODE] == at.ON_TRAIL and st[at.WAY] > 0.0:
            x, y, _ = trail_point(
                pool, int(st[at.ROW_START]), int(st[at.ROW_COUNT]), st[at.ROW_STEP],
                st[at.FRONT_ARC] + st[at.SPEED] * pr[at.LOOK_AHEAD],
            )  # fmt: skip
        st[at.LOOK_X], st[at.LOOK_Y] = x, y
    wanted, dip = 0.0, 0.0
    if math.isnan(x):
        wanted, dip = look_about(st, pr)
    else:
        dx, dy = x - st[at.FRONT_X], y - st[at.FRONT_Y]
        far = dx * dx + dy * dy
        wanted = wrap(math.atan2(dy, dx) - st[at.CHEST]) * far / (far + _GAZE_NEAR * _GAZE_NEAR)
        wanted = min(max(wanted, -pr[at.HEAD_TURN]), pr[at.HEAD_TURN])
    off, st[at.GAZE_RATE] = spring(st[at.GAZE] - wanted, st[at.GAZE_RATE], _GAZE_HALF_LIFE)
    st[at.GAZE] = wanted + off
    off, st[at.DIP_RATE] = spring(st[at.DIP] - dip, st[at.DIP_RATE], _GAZE_HALF_LIFE)
    st[at.DIP] = dip + off


@kernel
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
