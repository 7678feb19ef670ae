"""Where a character's feet stand: what touches the ground stays there until the person's foot leaves it.

A character's soles have another shape than the person's. Where a person's foot pivots about its ball, that of
a character would swing about another point and slide. So while the person's foot stands, its character's does
not turn about the upright of the ground, and how far what touches moves along the ground from one pose to the
next is taken back. Once the person's foot is in the air, the character's goes back to where it would be.
"""

import math
from typing import NamedTuple

import numpy as np

from locomotion.characters.quaternions import multiply, rotate
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["Footing", "FootingArrays", "hold_foot", "hold_turn", "no_footing"]

_TOES = 3  # row of `PersonArrays.limbs`
_STANDING, _LEFT = 0.002, 0.012
"""[m] over the ground: up to the first a person's foot stands, from the second on it does not."""
_SLOW, _FAST = 2.0, 3.0
"""[m/s] of the person's toes along the ground: up to the first its foot stands, from the second on it
slides."""
_TOUCHING = 0.002  # [m] over the lowest point of a foot, of what touches
_BACK = 0.06  # [s] in which a foot in the air goes half of the way back
_FURTHEST, _MOST_TURNED = 0.15, 0.7
"""[m] for legs as long as the person's, [rad]: most that a foot is held from where it would be."""
_PAUSE = 0.25  # [s] after which where a foot stood counts no more


class FootingArrays(NamedTuple):
    """Where the feet of one person and of its character were last, right and left, and for how long each of n
    poses is after the one before; as kernels take it."""

    offsets: np.ndarray
    """(2, 3) [m] that the character's foot is held from where it would be"""
    yaws: np.ndarray
    """(2,) [rad] the same of its turn"""
    held: np.ndarray
    """(2,) 0 to 1: how much it stands"""
    ankles: np.ndarray
    """(2, 3) [m] of the character"""
    turns: np.ndarray
    """(2, 2, 4) of the character's foot and toes"""
    toes: np.ndarray
    """(2, 7) the person's"""
    steps: np.ndarray
    """(n,) [s]; inf for the first pose; -1 for persons each of whom is posed once"""


class Footing:
    """What a character remembers of one person between calls of `Rig.pose_motion`. Starts with nothing."""

    def __init__(self) -> None:
        self._time = -math.inf
        self._last = no_footing(0)
        self._before: tuple[float, FootingArrays] | None = None

    def at(self, times: np.ndarray) -> FootingArrays:
        """For poses at ``times`` (n,) [s]. What was before is forgotten where time goes back, or leaps. A
        single pose at the time of the last one takes its place."""
        if len(times) == 1:
            if times[0] == self._time and self._before is not None:
                self._time, self._last = self._before
            self._before = self._time, FootingArrays(*(each.copy() for each in self._last))
        elif len(times):
            self._before = None
        steps = np.diff(times, prepend=self._time)
        steps[(steps < 0.0) | (steps > _PAUSE)] = np.inf
        if len(times):
            self._time = float(times[-1])
        return self._last._replace(steps=steps)


def no_footing(count: int) -> FootingArrays:
    """For so many persons of whom each is posed once."""
    return FootingArrays(
        np.zeros((2, 3)), np.zeros(2), np.zeros(2), np.zeros((2, 3)), np.zeros((2, 2, 4)), np.zeros((2, 7)),
        np.full(count, -1.0),
    )  # fmt: skip


@kernel
def _share(value, low, high):
    share = min(max((value - low) / (high - low), 0.0), 1.0)
    return share * share * (3.0 - 2.0 * share)


@allocating_kernel
def _upright(contacts, i, side, normal):
    """``normal`` (3,) of the ground under a foot; z where that is not known."""
    normal[:] = contacts.normals[i, side]
    if contacts.near[i, side] <= 0.0:
        normal[0], normal[1], normal[2] = 0.0, 0.0, 1.0


@allocating_kernel
def hold_turn(person, places, contacts, footing, i, side, foot, toes):
    """Find out how much the person's foot stands, and turn its ``foot`` (4,) and ``toes`` (4,) back as far as
    the character's are held. places: (20, 7) of the person's bodies; i: number of the pose."""
    step, now, last = footing.steps[i], places[person.limbs[_TOES, side]], footing.toes[side]
    normal, turn, back = np.empty(3), np.empty(4), np.empty(4)
    _upright(contacts, i, side, normal)
    if step == np.inf:
        footing.offsets[side], footing.yaws[side], footing.held[side] = 0.0, 0.0, 0.0
    elif step > 0.0:
        speed, along = 0.0, 0.0
        for k in range(3):
            along += normal[k] * (now[k] - last[k])
        for k in range(3):
            speed += (now[k] - last[k] - along * normal[k]) ** 2
        speed = math.sqrt(speed) / step
        held = 1.0 - _share(-contacts.depths[i, side], _STANDING, _LEFT)
        held *= 1.0 - _share(speed, _SLOW, _FAST)
        back[0] = last[3]
        for k in range(1, 4):
            back[k] = -last[3 + k]
        multiply(now[3:], back, turn)
        about = turn[1] * normal[0] + turn[2] * normal[1] + turn[3] * normal[2]
        about = 2.0 * math.atan2(about if turn[0] >= 0.0 else -about, abs(turn[0]))
        yaw = (footing.yaws[side] - held * about) * (held + (1.0 - held) * 0.5 ** (step / _BACK))
        footing.yaws[side], footing.held[side] = min(max(yaw, -_MOST_TURNED), _MOST_TURNED), held
    last[:] = now
    half = 0.5 * footing.yaws[side]
    turn[0] = math.cos(half)
    for k in range(3):
        turn[1 + k] = math.sin(half) * normal[k]
    multiply(turn, foot, foot)
    multiply(turn, toes, toes)


@allocating_kernel
def hold_foot(rig, contacts, footing, i, side, foot, toes, ankle):
    """Move the ``ankle`` (3,) of a character's foot turned as ``foot`` (4,), its toes as ``toes``, so that
    what touches the ground stays where it was; and remember where that is. i: number of the pose."""
    step, offset, last = footing.steps[i], footing.offsets[side], footing.ankles[side]
    before, held = footing.turns[side], footing.held[side]
    if 0.0 < step < np.inf:
        normal, slide, change = np.empty(3), np.zeros(3), np.empty(3)
        _upright(contacts, i, side, normal)
        _slide(rig, side, normal, last, before, ankle, foot, toes, slide)
        along = slide[0] * normal[0] + slide[1] * normal[1] + slide[2] * normal[2]
        size = 0.0
        for k in range(3):
            change[k] = offset[k] - held * (slide[k] - along * normal[k])
            change[k] *= held + (1.0 - held) * 0.5 ** (step / _BACK)
            size += change[k] * change[k]
        size = min(_FURTHEST * rig.scale / max(math.sqrt(size), 1e-9), 1.0)
        for k in range(3):
            ankle[k] += size * change[k] - offset[k]
            offset[k] = size * change[k]
    last[:], before[0], before[1] = ankle, foot, toes


@allocating_kernel
def _slide(rig, side, normal, last, before, ankle, foot, toes, slide):
    """``slide`` (3,) [m]: how far the touching points of a foot have moved on average. last, before: its
    ankle (3,) and its and its toes' turns (2, 4) in the pose before."""
    count = len(rig.feet[side])
    now, then = np.empty((count + len(rig.toes[side]), 3)), np.empty((count + len(rig.toes[side]), 3))
    _points(rig, side, last, before[0], before[1], then)
    _points(rig, side, ankle, foot, toes, now)
    heights, lowest = np.empty(len(now)), np.inf
    for p in range(len(now)):
        one, other = 0.0, 0.0
        for k in range(3):
            one += normal[k] * now[p, k]
            other += normal[k] * then[p, k]
        heights[p] = max(one, other)
        lowest = min(lowest, heights[p])
    touching = 0
    for p in range(len(now)):
        if heights[p] <= lowest + _TOUCHING:
            touching += 1
            slide += now[p] - then[p]
    slide /= max(touching, 1)


@allocating_kernel
def _points(rig, side, ankle, foot, toes, out):
    """``out`` (k, 3) the points around a foot and its toes."""
    joint, count = np.empty(3), len(rig.feet[side])
    rotate(foot, rig.joints[side], joint)
    for k in range(3):
        joint[k] += ankle[k]
    for p in range(len(out)):
        if p < count:
            rotate(foot, rig.feet[side, p], out[p])
            out[p] += ankle
        else:
            rotate(toes, rig.toes[side, p - count], out[p])
            out[p] += joint
