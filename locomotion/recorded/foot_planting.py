"""Feet planted on the ground: sampled poses with the legs bent so that the feet stand where they were put
down.

A foot that bears stands still: on its heel, its whole sole or its ball, as the pose has it. A foot that
swings goes from where it stood to where it is put down next, as it does in the recording, and over the edge
of a step. The pelvis goes up and down with the feet. All of it is a function of the phase and the footfalls
(`locomotion.recorded.footfalls`)::

    channels, roots = sample_gait(motions, level, gaits, speeds, phases)
    channels, roots = planted(motions, level, (gaits, speeds, phases), (channels, roots), places,
        footfalls)

The hips of low figures do not turn: their feet point where their pelvis does. So that it stays still over a
foot that stands, it faces the way they go, and does not turn to and fro as in the recording.
"""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from locomotion.body.anatomy import ANKLE, SHANK, THIGH
from locomotion.body.leg_kinematics import solve_leg, solve_plain_leg
from locomotion.recorded.footfalls import (
    AHEAD,
    BALL,
    BEARS,
    FEET,
    HALF_SOLE,
    HEEL,
    LEFT,
    STRIKES,
    TURNED,
    footings,
)
from locomotion.recorded.motion_set import MotionSet
from locomotion.recorded.posing import posed
from locomotion.recorded.sampling import Sample, placed_roots, stride_of
from locomotion.recorded.skeletons import LEVELS, Skeleton, skeleton
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["LEG", "ROOM", "leg_columns", "plant", "planted", "strides_ahead"]

LEG = ("hip_flexion", "hip_abduction", "hip_rotation", "knee_flexion", "ankle_flexion", "ankle_inversion")
"""The joints of a leg that `solve_leg` gives."""
_HIP = 0.085  # [m] of a hip to the side of the pelvis' origin
_REACH = THIGH + SHANK
_SOFT = 0.005  # [m] over which the pelvis begins to give way to a leg that is nearly straight
_FADES = 0.2  # share of a swing over which it takes leave of a footfall, and over which it meets one
_RUN_NEAR = 0.25  # share of these for a run, whose legs are nearly straight when they strike, and would kick
_RUN_FADES = 0.08  # the same of a run, whose feet are far ahead of the body for an instant only
_OVER = 0.12  # height of a swing over the line between two footfalls, per height of the step
_BEFORE = 0.6  # share of a swing in which a foot that goes up comes to its height
_HEEL_AHEAD, _BALL_AHEAD = HEEL[0], BALL[0]
_LOWEST = 0.3  # [m] by which the pelvis is lowered at most for feet to reach the ground
_SETTLED = 0.01  # [m] over the ground, up to which an end of a sole counts as on it
_FREE, _FARTHEST = 0.08, 0.13
# [m] beside where the recording has it, from which on a foot is held back, and to which it comes at most
_TURNS_FREE, _TURNS_MOST = 0.6, 1.0
# [rad] beside where its figure faces, from which on a foot turns along, and which it is beside it at most
_TURNS_SWINGING = (
    0.3  # share of these for a foot in the air: a folded leg with its foot aside would flip over
)
_ROUNDS = 3  # of solving a leg whose ankle cannot turn in or out
_PLAIN_ROUNDS = 2  # the same of one whose hip cannot turn either
_TIPPED = 0.15  # sine of the angle of a sole that stands on one end
ROOM = (6, 3, 3)
"""Shape of the memory that `plant` works in."""


def planted(
    motions: MotionSet,
    level: int,
    moments: tuple[ArrayLike, ArrayLike, ArrayLike],
    sample: Sample,
    places: ArrayLike,
    footfalls: ArrayLike,
    since: ArrayLike | None = None,
) -> Sample:
    """Plant n figures of one level. ``moments``: gaits, speeds and phases (n,), from which `sample_gait` made
    the ``sample``. ``places`` (n, 4): where even travel has come to, x, y, z [m] and heading [rad].
    ``footfalls`` (n, 2, 2, 6): as of `locomotion.recorded.footfalls.Steps`. ``since`` (n, 2): the share of
    the cycle since each foot struck, 0 to 1, by default as the phase has it; of a figure that is not to be
    planted below 0. A foot that has been put down far from where the recording has it, as that of a figure
    which is pushed, slides rather than stretch its leg.

    Gives channels (n, c), and roots (n, 7) in the world.
    """
    gaits, speeds, phases = (np.asarray(each, np.float64) for each in moments)
    gaits = gaits.astype(np.int64)
    footing = footings(motions, gaits, speeds)
    strides = strides_ahead(motions)[gaits] * stride_of(motions, gaits, speeds)
    struck = (phases[:, None] - footing[:, :, STRIKES]) % 1.0 if since is None else np.asarray(since)
    own, at = skeleton(LEVELS[level]), np.ascontiguousarray(places, np.float64)
    steps = np.ascontiguousarray(footfalls, np.float64)
    channels, roots = sample[0].copy(), placed_roots(sample[1], at)
    bodies = posed(own, *sample)
    feet = np.stack([bodies[:, own.bodies.index(name)] for name in FEET], axis=1)
    roots[:, 2] = np.where(struck[:, 0] < 0.0, roots[:, 2], sample[1][:, 2])
    _plant_all((leg_columns(own), footing, strides, struck), feet, at, steps, (channels, roots))
    return channels, roots


def strides_ahead(motions: MotionSet) -> NDArray[np.float64]:
    """(gaits,) 1 for gaits that go ahead, -1 for those that go backwards."""
    return np.where(motions.travel[motions.cycles[motions.gait_first[:-1]], 0] < 0.0, -1.0, 1.0)


def leg_columns(own: Skeleton) -> NDArray[np.int64]:
    """(2, 6) int64: channels of `LEG` of the right and the left leg, -1 for joints that do not move."""
    names = [[f"{side}_{joint}" for joint in LEG] for side in ("right", "left")]
    return np.array([[own.channels.index(n) if n in own.channels else -1 for n in leg] for leg in names])


@kernel
def _smooth(x):
    x = min(max(x, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


@kernel
def _axes(place, out):
    """Rotation matrix ``out`` (3, 3) of a place (7,)."""
    w, x, y, z = place[3], place[4], place[5], place[6]
    out[0, 0], out[0, 1], out[0, 2] = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
    out[1, 0], out[1, 1], out[1, 2] = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)
    out[2, 0], out[2, 1], out[2, 2] = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)


@kernel
def _held_back(x, y, place, ahead, left, share):
    """The middle of a sole at (x, y), or, where that is too far from where the recording has it, ``ahead``
    and to the ``left`` of the ``place`` (x, y, and cosine and sine of the heading) of the figure, nearer to
    that: at a ``share`` of `_FARTHEST` at most."""
    px, py, c, s = place
    dx, dy = x - px - c * ahead + s * left, y - py - s * ahead - c * left
    off, free = math.sqrt(dx * dx + dy * dy), share * _FREE
    if off <= free:
        return x, y
    spare = share * _FARTHEST - free
    less = (free + spare * math.tanh((off - free) / spare)) / off - 1.0
    return x + less * dx, y + less * dy


@kernel
def _pivoted(heading, ahead, swings):
    """The heading of a foot whose figure faces ``ahead`` [rad]: it turns along with one that turns far, the
    sooner the more it ``swings``, 0 to 1."""
    off = (heading - ahead + math.pi) % (2.0 * math.pi) - math.pi
    share = 1.0 - (1.0 - _TURNS_SWINGING) * swings
    far = abs(off) - share * _TURNS_FREE
    if far <= 0.0:
        return heading
    spare = share * (_TURNS_MOST - _TURNS_FREE)
    kept = (share * _TURNS_FREE + spare * math.tanh(far / spare)) * min(math.pi - abs(off), 1.0)
    return ahead + math.copysign(kept, off)


@kernel
def _unit_of(x, y):
    """Cosine and sine of the direction of (x, y)."""
    size = math.sqrt(x * x + y * y)
    return (x / size, y / size) if size > 0.0 else (1.0, 0.0)


@kernel
def _foot(cycle, foot, steps, place, turns, axes, point):
    """Where a foot has to be: its ``axes`` (3, 3) and the ``point`` (3,) in the world for the end of its sole
    that it stands on, or that is lower; gives where that is ahead of the ankle, the height of the ground for
    the pelvis, and the sine of the angle by which its front is up over the ground. ``cycle``: its footing,
    the stride and since when it stands; ``foot`` (7,) is its place in the recording, ``steps`` (2, 6) are its
    last footfall and the next one; ``place`` as of `_held_back`; ``turns``: whether hips do, so that a foot
    keeps its heading when the figure turns.
    """
    footing, stride, since = cycle
    _axes(foot, axes)
    turn_c, turn_s = _unit_of(axes[1, 1], -axes[0, 1])
    up_c, up_s = _unit_of(axes[2, 2], axes[2, 0])
    half, end = (HALF_SOLE, _HEEL_AHEAD) if up_s >= 0.0 else (-HALF_SOLE, _BALL_AHEAD)
    # the middle of the sole in the recording, if it stood flat on that end
    x = foot[0] + end * axes[0, 0] - ANKLE * axes[0, 2] + half * turn_c
    y = foot[1] + end * axes[1, 0] - ANKLE * axes[1, 2] + half * turn_s
    z = foot[2] + end * axes[2, 0] - ANKLE * axes[2, 2]
    swung = max(since - footing[BEARS], 0.0) / (1.0 - footing[BEARS])
    fades = _FADES if footing[BEARS] > 0.5 else _RUN_FADES
    free = _smooth(swung / fades) * _smooth((1.0 - swung) / fades)
    share = (x - footing[AHEAD]) / stride + since - 0.5 * footing[BEARS]
    share = free * min(max(share, 0.0), 1.0) + (1.0 - free) * (0.0 if swung < 0.5 else 1.0)
    # a foot that stands may still have its ball off the ground, on its toes
    height = free * max(z, 0.0) + (1.0 - free) * max(z - _SETTLED, 0.0)
    rise = steps[1, 2] - steps[0, 2]
    risen = _smooth(share / _BEFORE) if rise > 0.0 else _smooth((share - 1.0 + _BEFORE) / _BEFORE)
    over = _OVER * abs(rise) * 4.0 * share * (1.0 - share)
    way = steps[0, 3] + share * (steps[1, 3] - steps[0, 3])
    slope = steps[0, 4] + share * (steps[1, 4] - steps[0, 4])
    tilt = steps[0, 5] + share * (steps[1, 5] - steps[0, 5])
    heading, turned = way, way - footing[TURNED]
    ahead = math.atan2(place[3], place[2])
    if not turns:
        heading = ahead
    elif free > 0.0:
        heading += free * (math.atan2(turn_s, turn_c) - footing[TURNED])
    if free > 0.0:
        tilt += free * math.asin(min(max(axes[2, 1], -1.0), 1.0))
    heading = _pivoted(heading, ahead, free)
    c, s, slope_c, slope_s = math.cos(heading), math.sin(heading), math.cos(slope), math.sin(slope)
    # faces the heading, with its front and its left side up by these angles
    cp, sp = slope_c * up_c - slope_s * up_s, slope_s * up_c + slope_c * up_s
    cr, sr = math.cos(tilt), math.sin(tilt)
    axes[0, 0], axes[1, 0], axes[2, 0] = c * cp + s * sr * sp, s * cp - c * sr * sp, cr * sp
    axes[0, 1], axes[1, 1], axes[2, 1] = -s * cr, c * cr, sr
    axes[0, 2], axes[1, 2], axes[2, 2] = s * sr * cp - c * sp, -s * sp - c * sr * cp, cr * cp
    middle_x = steps[0, 0] + share * (steps[1, 0] - steps[0, 0])
    middle_y = steps[0, 1] + share * (steps[1, 1] - steps[0, 1])
    if free > 0.0:
        left = free * (y - footing[LEFT])
        middle_x -= left * math.sin(turned)
        middle_y += left * math.cos(turned)
    near = 1.0 if footing[BEARS] > 0.5 else _RUN_NEAR
    middle_x, middle_y = _held_back(middle_x, middle_y, place, x, y, near)
    point[0] = middle_x - half * slope_c * c
    point[1] = middle_y - half * slope_c * s
    point[2] = steps[0, 2] + rise * risen + over + height - half * slope_s
    return end, steps[0, 2] + swung * rise, up_s


@kernel
def _ankle(point, axes, end, out):
    """The ankle ``out`` (3,) of a foot with these axes, the ``end`` of whose sole is at ``point``."""
    for k in range(3):
        out[k] = point[k] - end * axes[k, 0] + ANKLE * axes[k, 2]


@allocating_kernel
def _plant_all(cycles, feet, places, footfalls, poses):
    """Kernel of `planted`; ``poses`` hold the sample and are changed."""
    columns, footing, strides, since = cycles
    channels, roots = poses
    room = np.empty(ROOM)
    for n in range(since.shape[0]):
        cycle = columns, footing[n], strides[n], since[n]
        plant(cycle, feet[n], places[n], footfalls[n], (channels[n], roots[n]), room)


@kernel
def plant(cycle, feet, place, footfalls, pose, room):
    """Kernel of `planted`, for one figure: ``cycle`` are its legs' columns, footing, stride, and since when
    its feet stand; ``pose`` its channels and root, which are changed. ``room`` (`ROOM`) is overwritten."""
    columns, footing, stride, since = cycle
    channels, root = pose
    if since[0] < 0.0:
        return
    if footing[0, BEARS] == 0.0 or footing[1, BEARS] == 0.0:
        for side in range(2):
            root[2] += 0.25 * (footfalls[side, 0, 2] + footfalls[side, 1, 2])
        return
    axes, pelvis, points, hip, ankle = room[:2], room[2], room[3], room[4, 0], room[4, 1]
    ends, tips = room[4, 2], room[5, 2]
    turns = columns[0, 2] >= 0
    here = place[0], place[1], math.cos(place[3]), math.sin(place[3])
    for side in range(2):
        its = footing[side], stride, since[side]
        ends[side], height, tips[side] = _foot(
            its, feet[side], footfalls[side], here, turns, axes[side], points[side]
        )
        root[2] += 0.5 * height
    if not turns:
        _face(root, place[3])
    _axes(root, pelvis)
    stretched = 1.0
    for side in range(2):
        _hip(root, pelvis, side, hip)
        _ankle(points[side], axes[side], ends[side], ankle)
        reach = _REACH * _REACH - (hip[0] - ankle[0]) ** 2 - (hip[1] - ankle[1]) ** 2
        over = min(hip[2] - ankle[2] - math.sqrt(max(reach, 0.0)), _LOWEST)
        stretched += math.exp(over / _SOFT)
    root[2] -= _SOFT * math.log(stretched)
    for side in range(2):
        _hip(root, pelvis, side, hip)
        foot = points[side], axes[side], ends[side], tips[side]
        _bend_leg(columns[side], (pelvis, hip), foot, side, channels, room)


@kernel
def _face(root, heading):
    """Turn a pelvis about the vertical so that it faces a ``heading`` [rad]."""
    w, x, y, z = root[3], root[4], root[5], root[6]
    off = 0.5 * (heading - math.atan2(2.0 * (x * y + w * z), 1.0 - 2.0 * (y * y + z * z)))
    c, s = math.cos(off), math.sin(off)
    root[3], root[4], root[5], root[6] = c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w


@kernel
def _hip(root, pelvis, side, out):
    """Where a hip is (3,) [m]."""
    for k in range(3):
        out[k] = root[k] + (2 * side - 1) * _HIP * pelvis[k, 1]


@kernel
def _bend_leg(columns, body, foot, side, channels, room):
    """Bend a leg so that an end of the sole is where it has to be; ``body`` are the pelvis' axes and the hip,
    ``foot`` the point for the end, the foot's axes, where the end is ahead of the ankle, and by how much the
    front is up over the ground."""
    pelvis, hip = body
    point, axes, end, tip = foot
    ankle, angles = room[4, 1], room[5].reshape(9)[:6]
    turns, rolls = columns[2] >= 0, columns[5] >= 0
    if not turns:
        # its pelvis decides where the foot points: it turns about the end that it stands on, or its middle
        pivot = _HEEL_AHEAD + HALF_SOLE * (1.0 - min(max(tip / _TIPPED, -1.0), 1.0))
        for k in range(3):
            point[k] += (pivot - end) * axes[k, 0]
        end = pivot
    for _ in range(1 if rolls else (_ROUNDS if turns else _PLAIN_ROUNDS)):
        _ankle(point, axes, end, ankle)
        if not turns:
            solve_plain_leg(pelvis, hip, axes, ankle, 2.0 * side - 1.0, angles)
            continue
        solve_leg(pelvis, hip, axes, ankle, 2.0 * side - 1.0, angles)
        if not rolls:
            # an ankle that cannot turn in or out leaves the foot as the shank has it
            roll = (2 * side - 1) * angles[5]
            c, s = math.cos(roll), math.sin(roll)
            for k in range(3):
                y, z = axes[k, 1], axes[k, 2]
                axes[k, 1], axes[k, 2] = c * y + s * z, c * z - s * y
    for k in range(6):
        if columns[k] >= 0:
            channels[columns[k]] = angles[k]
