"""Turning the head uphill while lying on the front, on a slope (numba).

Hands and feet that lift a body across a slope, or head downhill, tip it over, and it rolls down. On its front
it lies still. There it turns first: it swings arms and legs to one side, bends the other way, and lies spread
out again, as far as it has to turn, and does so again if that was not enough. A whole swing turns it by some
110 degrees and takes it 0.1 m downhill; half of it turns it by 30.

The postures were found by CMA-ES from people who had fallen on slopes of 31 to 44 degrees.
"""

import math

import numpy as np

from locomotion.gaits.walk.layout import wrap
from locomotion.recovery.layout import MODE_CLOCK, PIVOT, SEEN_COM, SEEN_TURN
from locomotion.recovery.postures import mirrored, move, posture
from locomotion.recovery.scrambling import lie_of
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["PIVOTS", "ROUND", "SPREAD", "begin_round", "off_uphill", "pivot"]

PIVOTS = 0.6
"""[rad] off uphill from which on it turns before it gets up."""
_TIMES = (0.4, 0.75, 1.1)  # [s] at which it has come to each posture
ROUND = _TIMES[2]
"""[s] that a round takes."""
_MOVES = 0.8  # share of its time in which it comes to a posture
_LEAST, _PER_RADIAN = 0.37, 0.37  # of a whole swing; for each radian that it has to turn

SPREAD = posture(
    shoulder_flexion=0, shoulder_abduction=85, shoulder_rotation=-50, elbow_flexion=25, neck_pitch=-20,
    hip_abduction=20,
)  # fmt: skip
"""How it lies before and after: (39,) angles [rad]."""
# to the left
_REACH_ROUND = posture(
    right_shoulder_flexion=30, left_shoulder_flexion=27, right_shoulder_abduction=91,
    left_shoulder_abduction=70, right_shoulder_rotation=-81, left_shoulder_rotation=-90,
    right_elbow_flexion=9, left_elbow_flexion=43, right_hip_flexion=4, left_hip_flexion=7,
    right_hip_abduction=-30, left_hip_abduction=-4, right_knee_flexion=-2, left_knee_flexion=35,
    waist_roll=-22, chest_roll=-20, waist_pitch=-25, chest_pitch=12, neck_pitch=-20,
)  # fmt: skip
_PULL_ROUND = posture(
    right_shoulder_flexion=9, left_shoulder_flexion=5, right_shoulder_abduction=100,
    left_shoulder_abduction=121, right_shoulder_rotation=-70, left_shoulder_rotation=-42,
    right_elbow_flexion=46, left_elbow_flexion=0, right_hip_flexion=-24, left_hip_flexion=0,
    right_hip_abduction=19, left_hip_abduction=22, right_knee_flexion=43, left_knee_flexion=35,
    waist_roll=5, chest_roll=20, waist_pitch=-15, chest_pitch=9, neck_pitch=-20,
)  # fmt: skip
_LEFT = np.array([_REACH_ROUND, _PULL_ROUND, SPREAD])
_ROUNDS = np.array([[mirrored(each) for each in _LEFT], _LEFT])


@allocating_kernel
def off_uphill(ground, memory):
    """[rad] by which uphill is to the left of where the head of a body that lies on its front points."""
    com, turn, gradient = memory[SEEN_COM], memory[SEEN_TURN], np.empty(2)
    lie_of(ground, com[0], com[1], com[2] - 0.2, gradient)
    return wrap(math.atan2(gradient[1], gradient[0]) - math.atan2(turn[5], turn[2]))


@kernel
def begin_round(memory, off):
    """The body begins to turn to the left by ``off`` [rad], or to the right where that is below 0."""
    memory[PIVOT] = math.copysign(min(_LEAST + _PER_RADIAN * abs(off), 1.0), off)


@kernel
def pivot(memory, ctrl):
    """One control tick of a round: write the PD targets ``ctrl`` (39,) [rad]."""
    clock, share = memory[MODE_CLOCK] % ROUND, abs(memory[PIVOT])
    postures = _ROUNDS[1 if memory[PIVOT] > 0.0 else 0]
    before, begun = 0.0, 2
    for k in range(3):
        if clock < _TIMES[k]:
            move(postures[begun], postures[k], (clock - before) / (_MOVES * (_TIMES[k] - before)), ctrl)
            break
        before, begun = _TIMES[k], k
    for j in range(39):
        ctrl[j] = SPREAD[j] + share * (ctrl[j] - SPREAD[j])
