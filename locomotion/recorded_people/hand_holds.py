"""Hands of recorded people on what they clear: where a recording has them on the obstacle, and inverse
kinematics that brings them to the top of the real one.

A hand holds on while it rests on the top in the recording. Before and after, the arm goes over into the pose
of the recording and back. The arm's four joints are solved from the pose by damped least squares, so that
they change as little as they have to.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from locomotion.body.anatomy import FOREARM, UPPER_ARM
from locomotion.body.arm_reach import ARM_START, HAND_RADIUS, hand_place, shoulder_frame
from locomotion.body.hand_hold import HAND_POINT

__all__ = ["HandHold", "hand_of", "holds_of", "with_hand_at"]

_SLOW = 1.0  # [m/s] below which a hand rests
_NEAR, _BESIDE = 0.05, 0.05  # [m] over or under the top, and beside it, within which it rests on it
_ROUNDS, _DAMPING, _PROBE = 16, 3e-4, 1e-5
_LONGEST = 0.99 * (UPPER_ARM + FOREARM - HAND_POINT[2])
_STEP, _BENT = 0.3, 0.05  # [rad] most of a round, and least of an elbow


@dataclass(frozen=True)
class HandHold:
    """The hand of ``side`` (-1 right, +1 left) rests on the top of an obstacle from ``first`` to ``last`` [s]
    of a clip."""

    side: float
    first: float
    last: float


def holds_of(
    poses: NDArray[np.float64], times: NDArray[np.float64], obstacle: tuple[float, float, float]
) -> tuple[HandHold, ...]:
    """Of a clip: ``poses`` (n, 46) at ``times`` (n,) [s]; ``obstacle``: its edge, height and depth [m]."""
    edge, height, depth = obstacle
    found = []
    for side in (-1.0, 1.0):
        hand = np.array([hand_place(pose, side) for pose in poses])
        speed = np.linalg.norm(np.gradient(hand, times, axis=0), axis=1)
        rests = (speed < _SLOW) & (np.abs(hand[:, 2] - height) < _NEAR)
        rests &= (hand[:, 0] > edge - _BESIDE) & (hand[:, 0] < edge + depth + _BESIDE)
        at = np.flatnonzero(rests)
        if len(at) > 1:
            found.append(HandHold(side, float(times[at[0]]), float(times[at[-1]])))
    return tuple(found)


def hand_of(pose: NDArray[np.float64], side: float, size: float) -> NDArray[np.float64]:
    """(3,) [m] where the hand of ``side`` of a figure in ``pose`` (46,) is."""
    return pose[:3] + size * (hand_place(pose, side) - pose[:3])


def with_hand_at(
    pose: NDArray[np.float64], side: float, point: NDArray[np.float64], share: float, size: float = 1.0
) -> NDArray[np.float64]:
    """``pose`` (46,) of a figure of a ``size``, with the arm of ``side`` turned so that its hand lies on
    ``point`` (3,) [m], or by a ``share`` of that, 0 to 1. Where the arm is too short the body comes nearer.
    """
    target = point + np.array([0.0, 0.0, size * HAND_RADIUS])
    target = pose[:3] + (target - pose[:3]) / size  # as one of the usual size would have it, about its pelvis
    first = 7 + ARM_START[int(side > 0.0)]
    arm, solved, shoulder = slice(first, first + 4), pose.copy(), shoulder_frame(pose, side)[0]
    away = float(np.linalg.norm(target - shoulder))
    nearer = (target - shoulder) * max(away - _LONGEST, 0.0) / away
    solved[:3] += nearer
    for _ in range(_ROUNDS):
        hand = hand_place(solved, side)
        slope = np.empty((3, 4))
        for k in range(4):
            probe = solved.copy()
            probe[first + k] += _PROBE
            slope[:, k] = (hand_place(probe, side) - hand) / _PROBE
        step = slope.T @ np.linalg.solve(slope @ slope.T + _DAMPING * np.eye(3), target - hand)
        solved[arm] += step.clip(-_STEP, _STEP)
        solved[first + 3] = max(solved[first + 3], _BENT)
    out = pose.copy()
    out[:3] += share * size * nearer
    out[arm] += share * (solved[arm] - pose[arm])
    return out
