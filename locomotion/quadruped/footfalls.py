"""Feet: each stands where it came down until its turn, then swings to where it will be needed.

A foot aims for its place under the body in the middle of its coming stance, at the body's predicted place. So
feet fall on the path and do not slide, whatever path and speed do.
"""

from __future__ import annotations

import math

import numpy as np

from locomotion.ground.ground import height_below
from locomotion.quadruped import layout as at
from locomotion.quadruped.body_on_path import front_of, wanted_pose
from locomotion.quadruped.gait import leg_phase, seconds_for, swing_tempo
from locomotion.quadruped.motion import DT, travel
from locomotion.quadruped.trail import trail_point
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["find_ground", "foot_place", "misplaced", "step_feet"]

CLOSE = 0.012
"""[m] A foot this near to its place stays."""
_FREEZE = 0.72  # share of the swing after which its end is fixed
_RAMP, _RAMP_SLOPE, _SHORTEST_RAMP = 0.36, 0.07, 0.14
# share of the swing in which a foot speeds up, and in which it slows down: at rest, less by this times the
# body's way in the swing over the leg's height, and at least
_HASTE = 4.0  # how much faster than evenly a swing follows a change of its aim
_STRETCH = 0.90  # share of a leg's length to which it may be stretched when standing
_SINK = 0.97  # share of its height by which the trunk may sink for a standing foot
_SINK_AHEAD = 0.84  # the same for a foot before it, over which it is yet to come
_SLACK = 0.12  # [m] above a step that a foot may find ground off the surface it is on


@kernel(forceinline=True)
def _ramp(u):
    """Way made by a speed that rises to 1 by the smoothstep while ``u`` goes from 0 to 1."""
    return u * u * u * (1.0 - 0.5 * u)


@kernel(forceinline=True)
def _stride(u, ramp):
    """Share of its way that a foot has made at the share ``u`` of its swing: it speeds up over the share
    ``ramp``, goes on evenly, and slows down as long; neither speed nor acceleration jumps."""
    top = 1.0 / (1.0 - ramp)
    if u < ramp:
        return top * ramp * _ramp(u / ramp)
    if u > 1.0 - ramp:
        return 1.0 - top * ramp * _ramp((1.0 - u) / ramp)
    return top * (u - 0.5 * ramp)


@kernel
def find_ground(ground, origin, x, y, z, reach):
    """Height [m] of the ground at (x, y) within ``reach`` [m] of ``z``, or NaN."""
    h = height_below(
        ground[0], ground[1], ground[2], ground[3], ground[4], x - origin[0], y - origin[1],
        z + reach - origin[2],
    )[0]  # fmt: skip
    h += origin[2]
    return h if h >= z - reach else np.nan


@kernel
def foot_place(st, pr, pool, leg, ahead):
    """(x, y, z, direction) where ``leg`` stands under the body ``ahead`` [s] from now; z is the surface's
    there as the motion knows it."""
    arc = st[at.ARC]
    on_trail = st[at.MODE] == at.ON_TRAIL
    if on_trail and ahead > 0.0:
        arc += st[at.WAY] * travel(st, pr, ahead)
    x, y, z, yaw, bend, front = wanted_pose(st, pr, pool, arc, st[at.SCRIPT_TIME] + ahead)
    if leg >= 2:
        return x, y, z, yaw
    x, y = front_of(x, y, yaw, bend, pr[at.BONES], pr[at.BONE] * math.cos(st[at.PITCH]))
    if on_trail:
        z = trail_point(pool, int(st[at.ROW_START]), int(st[at.ROW_COUNT]), st[at.ROW_STEP], front)[2]
    return x, y, z, yaw + pr[at.BONES] * bend


@kernel
def _aim(st, pr, pool, ground, origin, foot, leg, ahead):
    """Write where ``leg`` is to come down, ``ahead`` [s] from the middle of its stance, as its AIM."""
    x, y, z, direction = foot_place(st, pr, pool, leg, ahead)
    width = pr[at.WIDTH_FRONT] if leg < 2 else pr[at.WIDTH_REAR]
    side = 0.5 * width if leg % 2 == 0 else -0.5 * width
    reach = pr[at.STEP] + _SLACK
    if st[at.MODE] != at.ON_TRAIL:
        z = foot[at.FZ]
    for narrower in (1.0, 0.5, 0.0):
        fx = x - narrower * side * math.sin(direction)
        fy = y + narrower * side * math.cos(direction)
        h = find_ground(ground, origin, fx, fy, z, reach)
        if not math.isnan(h):
            foot[at.AIM], foot[at.AIM + 1], foot[at.AIM + 2] = fx, fy, h
            return True
    foot[at.AIM] = x - side * math.sin(direction)
    foot[at.AIM + 1] = y + side * math.cos(direction)
    foot[at.AIM + 2] = z
    return False


@kernel
def _arch(foot, ground, origin, reach):
    """[m] by which a straight way from FROM to AIM has to be raised in its middle to clear the ground."""
    arch = 0.0
    for k in range(1, 4):
        share = 0.25 * k
        x = foot[at.FROM] + share * (foot[at.AIM] - foot[at.FROM])
        y = foot[at.FROM + 1] + share * (foot[at.AIM + 1] - foot[at.FROM + 1])
        z = foot[at.FROM + 2] + share * (foot[at.AIM + 2] - foot[at.FROM + 2])
        h = find_ground(ground, origin, x, y, z, reach)
        if h > z:
            arch = max(arch, (h - z) / (4.0 * share * (1.0 - share)))
    return arch


@allocating_kernel
def step_feet(st, pr, gait, pool, ground, origin, feet):
    """One tick of the four ``feet`` (4, FOOT) of one animal; returns whether all stand where they belong."""
    cycle = 1.0 / st[at.FREQUENCY_WISH]  # [s] of the coming strides
    settled = True
    for leg in range(4):
        foot = feet[leg]
        duty = st[at.DUTY_FRONT_NOW] if leg < 2 else st[at.DUTY_REAR_NOW]
        phase = leg_phase(st, leg)
        if foot[at.IN_SWING] == 0.0:
            due = phase >= foot[at.STANCE]
            if st[at.REST] > 0.0 or not (due or _overstretched(st, pr, foot, leg)):
                continue
            foot[at.TEMPO] = swing_tempo(st, pr, gait, leg, duty)
        left = seconds_for(st, (1.0 - phase) / foot[at.TEMPO])
        ahead = left + 0.5 * duty * cycle
        if foot[at.IN_SWING] == 0.0:
            found = _aim(st, pr, pool, ground, origin, foot, leg, ahead)
            dx, dy = foot[at.AIM] - foot[at.FX], foot[at.AIM + 1] - foot[at.FY]
            if dx * dx + dy * dy < CLOSE * CLOSE or not found:
                if not found:
                    st[at.NO_GROUND] = 1.0
                foot[at.TO : at.TO + 3] = foot[at.FX : at.FX + 3]
                continue
            foot[at.FROM : at.FROM + 3] = foot[at.FX : at.FX + 3]
            foot[at.TO : at.TO + 3] = foot[at.AIM : at.AIM + 3]
            foot[at.SOFT_AIM : at.SOFT_AIM + 3] = foot[at.AIM : at.AIM + 3]
            foot[at.ARCH] = _arch(foot, ground, origin, pr[at.STEP] + _SLACK)
            foot[at.IN_SWING], foot[at.SWING_FROM] = 1.0, phase
            # its stance was over between two ticks; a swing that waits for the second trails by up to one
            if 0.0 <= phase - foot[at.STANCE] < st[at.FREQUENCY_NOW] * DT:
                foot[at.SWING_FROM] = foot[at.STANCE]
        settled = False
        begun = foot[at.SWING_FROM]
        if phase < begun:
            foot[at.FX : at.FX + 3] = foot[at.TO : at.TO + 3]
            foot[at.BASE] = foot[at.FZ]
            foot[at.IN_SWING] = 0.0
            continue
        done = (phase - begun) / (1.0 - begun)
        if done < _FREEZE:
            foot[at.STANCE] = duty
            if not _aim(st, pr, pool, ground, origin, foot, leg, ahead):
                st[at.NO_GROUND] = 1.0
        pull = min(_HASTE * DT / max(left, DT), 1.0)
        # the aim jumps over edges and when another gait is asked for: the paw's speed must not
        for k in range(3):
            foot[at.SOFT_AIM + k] += pull * (foot[at.AIM + k] - foot[at.SOFT_AIM + k])
            foot[at.TO + k] += pull * (foot[at.SOFT_AIM + k] - foot[at.TO + k])
        swings = 1.0 - (st[at.STANDS_FRONT] if leg < 2 else st[at.STANDS_REAR])
        way = st[at.SPEED] * swings / (st[at.FREQUENCY_NOW] * pr[at.HEIGHT_REAR])
        slow = (1.0 - begun) / (foot[at.TEMPO] * swings)
        # one that takes longer sets out the faster, for the trunk does not wait for it
        ramp = max(_RAMP - _RAMP_SLOPE * way, _SHORTEST_RAMP) / max(slow, 1.0) ** 2
        _swing(foot, done, st[at.LIFT_NOW], ramp)
    return settled


@kernel
def _overstretched(st, pr, foot, leg):
    """Whether the body has gone so far on over a standing leg that the trunk would have to sink for it."""
    if leg < 2:
        x, y, direction, sizes = st[at.FRONT_X], st[at.FRONT_Y], st[at.CHEST], at.UPPER_FRONT
        ground, width, height = st[at.GROUND_FRONT], pr[at.WIDTH_FRONT], pr[at.HEIGHT_FRONT]
    else:
        x, y, direction, sizes = st[at.X], st[at.Y], st[at.YAW], at.UPPER_REAR
        ground, width, height = st[at.GROUND_REAR], pr[at.WIDTH_REAR], pr[at.HEIGHT_REAR]
    side = 0.5 * width if leg % 2 == 0 else -0.5 * width
    dx = foot[at.FX] - x + side * math.sin(direction)
    dy = foot[at.FY] - y - side * math.cos(direction)
    reach = _STRETCH * (pr[sizes] + pr[sizes + 1] + pr[sizes + 2])
    needed = ground + _SINK * height - foot[at.FZ]
    ahead = st[at.WAY] * (dx * math.cos(direction) + dy * math.sin(direction))
    if st[at.MODE] == at.ON_TRAIL and ahead > 0.0:
        needed = min(needed, _SINK_AHEAD * height)
    return dx * dx + dy * dy > reach * reach - needed * needed


@kernel
def _swing(foot, done, lift, ramp):
    """Put a swinging foot at the share ``done`` of its way."""
    along = _stride(done, ramp)
    for k in range(2):
        foot[at.FX + k] = foot[at.FROM + k] + along * (foot[at.TO + k] - foot[at.FROM + k])
    foot[at.BASE] = foot[at.FROM + 2] + along * (foot[at.TO + 2] - foot[at.FROM + 2])
    foot[at.HUMP] = hump = 4.0 * done * (1.0 - done)
    foot[at.FZ] = foot[at.BASE] + 4.0 * along * (1.0 - along) * foot[at.ARCH] + lift * hump * hump


@kernel
def misplaced(st, pr, pool, feet):
    """Whether a standing foot is not where it belongs when nothing moves any more."""
    for leg in range(4):
        x, y, _, direction = foot_place(st, pr, pool, leg, 0.0)
        side = 0.5 * (pr[at.WIDTH_FRONT] if leg < 2 else pr[at.WIDTH_REAR])
        side = side if leg % 2 == 0 else -side
        dx = x - side * math.sin(direction) - feet[leg, at.FX]
        dy = y + side * math.cos(direction) - feet[leg, at.FY]
        if dx * dx + dy * dy > (2.0 * CLOSE) ** 2:
            return True
    return False
