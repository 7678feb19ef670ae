"""Where a character's feet go (numba kernels): on the ground where the person's are, whatever their size.

The ground under a foot is the level's where that is known and near, else the plane of the person's toes. The
joint of the toes, on which a heel turns up, stays at the same distance ahead of the person's, and the lowest
point of the sole is on the ground when that of the person's is. So a planted foot stays where it is while it
rolls off.
"""

import math

import numpy as np

from locomotion.characters.quaternions import multiply, rotate
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["lift_heel", "place_foot", "planted", "reach_of_lifted_heel", "rest_foot"]

_FOOT, _TOES = 2, 3  # rows of `PersonArrays.limbs`
_LYING, _STEEP = 0.25, 0.5
"""Cosines of the shank's angle to the vertical: below the first it lies, from the second on its foot can
carry weight."""
_MOST_LIFT = 0.45
"""[rad] by which a heel is lifted more than the person's so that a short leg reaches its foot."""
_BEHIND = 0.2
"""[leg lengths] behind the hip from where on a heel may be lifted by that much."""


@kernel
def _smooth(value, low, high):
    share = min(max((value - low) / (high - low), 0.0), 1.0)
    return share * share * (3.0 - 2.0 * share)


@kernel
def planted(shank):
    """How much the foot of a ``shank`` (4,) counts as one that carries weight, 0 to 1."""
    up = 1.0 - 2.0 * (shank[1] * shank[1] + shank[2] * shank[2])
    return _smooth(up, _LYING, _STEEP)


@allocating_kernel
def _lowest(points, turn, start, normal, best):
    """The least height along ``normal`` of ``points`` (k, 3 or 4; the fourth a radius) turned by ``turn``
    about ``start``, or ``best`` if that is less."""
    at = np.empty(3)
    for k in range(len(points)):
        rotate(turn, points[k], at)
        height = 0.0
        for i in range(3):
            height += normal[i] * (start[i] + at[i])
        if points.shape[1] > 3:
            height -= points[k, 3]
        best = min(best, height)
    return best


@allocating_kernel
def place_foot(rig, person, places, contacts, i, side, turn, ankle):
    """Where a character's ``ankle`` (3,) has to be, with its foot turned as ``turn`` (4,): as the person's,
    or with its heel lifted.

    places: (20, 7) of the person's bodies; i: its number in ``contacts``. side: 0 right, 1 left.
    """
    foot, toes = places[person.limbs[_FOOT, side]], places[person.limbs[_TOES, side]]
    axis, ahead, beside, normal = np.zeros(3), np.empty(3), np.empty(3), np.empty(3)
    axis[0] = 1.0
    rotate(toes[3:], axis, ahead)
    axis[0], axis[1] = 0.0, 1.0
    rotate(toes[3:], axis, beside)
    axis[1], axis[2] = 0.0, 1.0
    rotate(toes[3:], axis, normal)
    near, size = contacts.near[i, side], 0.0
    for k in range(3):
        normal[k] += near * (contacts.normals[i, side, k] - normal[k])
        size += normal[k] * normal[k]
    size = math.sqrt(size)
    for k in range(3):
        normal[k] /= size
    plane = _lowest(person.feet[side], foot[3:], foot, normal, np.inf)
    plane = _lowest(person.toes[side], toes[3:], toes, normal, plane)
    outward = -1.0 if side == 0 else 1.0
    joint = np.empty(3)
    for k in range(3):
        joint[k] = toes[k]
        joint[k] += (rig.joints[side, 0] - person.ball) * ahead[k] + outward * rig.beside * beside[k]
    rotate(turn, rig.joints[side], axis)
    for k in range(3):
        ankle[k] = joint[k] - axis[k]
    low = _lowest(rig.feet[side], turn, ankle, normal, np.inf)
    low = _lowest(rig.toes[side], toes[3:], joint, normal, low)
    for k in range(3):
        ankle[k] += (plane + contacts.sunk[i, side] * normal[2] - low) * normal[k]


@allocating_kernel
def rest_foot(rig, person, places, contacts, i, side, ankle):
    """Raise or lower the ``ankle`` (3,) of a foot that lies, until its lowest point is as high as the
    person's; arguments as of `place_foot`."""
    foot, toes = places[person.limbs[_FOOT, side]], places[person.limbs[_TOES, side]]
    up, joint = np.array([0.0, 0.0, 1.0]), np.empty(3)
    height = _lowest(person.feet[side], foot[3:], foot, up, np.inf)
    height = _lowest(person.toes[side], toes[3:], toes, up, height)
    rotate(foot[3:], rig.joints[side], joint)
    for k in range(3):
        joint[k] += ankle[k]
    low = _lowest(rig.feet[side], foot[3:], ankle, up, np.inf)
    low = _lowest(rig.toes[side], toes[3:], joint, up, low)
    ankle[2] += height - low + contacts.sunk[i, side]


@allocating_kernel
def reach_of_lifted_heel(rig, side, hip, ankle, foot, leg):
    """By how much a heel may be lifted [rad]: the further its foot is behind the hip, the more."""
    arm, ahead, axis = np.empty(3), np.empty(3), np.empty(3)
    rotate(foot, rig.joints[side], arm)
    axis[0], axis[1], axis[2] = 1.0, 0.0, 0.0
    rotate(foot, axis, ahead)
    size = math.hypot(ahead[0], ahead[1])
    if size < 1e-6:
        return 0.0
    before = 0.0
    for k in range(2):
        before += (hip[k] - ankle[k] - arm[k]) * ahead[k] / size
    return _MOST_LIFT * _smooth(before, 0.0, _BEHIND * leg)


@allocating_kernel
def lift_heel(foot, angle, out):
    """``foot`` (4,) with its heel turned up by ``angle`` [rad] about its own axis from side to side."""
    turn = np.empty(4)
    turn[0], turn[1], turn[2], turn[3] = math.cos(0.5 * angle), 0.0, math.sin(0.5 * angle), 0.0
    multiply(foot, turn, out)
