"""What a falling person does so that the ground hurts it less (numba).

It holds its arms out to where it falls, and its head away from the ground; on its back it lands with bent
knees, the seat first. Which part of it will meet the ground follows from how the pelvis lies and turns. For
the front, the right side and the back there is a posture each, in between they are mixed. The servos are as
ever: an elbow gives way when more than its 80 Nm bears on it.

The postures were found by CMA-ES in falls of people who stood, walked and ran, for little force on head,
hands and trunk, and small jolts of the head, not too far from postures set by hand after J. Lo and J.
Ashton-Miller (2008), "Effect of Upper and Lower Extremity Control Strategies on Predicted Injury Risk During
Simulated Forward Falls", J. Biomech. Eng. 130(4), and E. Hsiao and S. Robinovitch (1998), "Common Protective
Movements Govern Unexpected Falls From Standing Height", J. Biomech. 31(1).
"""

import math

import numpy as np

from locomotion.recovery.layout import ROLL_SIDE, SEEN_TURN
from locomotion.recovery.postures import mirrored, posture
from surefoot.kernels import allocating_kernel

__all__ = ["begin_to_brace", "brace", "part_that_lands"]

_FORESIGHT = 0.2  # [s] ahead, about as long as it takes to the ground
_FRONT = posture(
    waist_pitch=18, chest_pitch=-20, neck_pitch=-31, clavicle_elevation=35, shoulder_flexion=120,
    shoulder_abduction=29, shoulder_rotation=13, elbow_flexion=43, hip_flexion=25, hip_abduction=22,
    hip_rotation=25, knee_flexion=8, ankle_flexion=2, neck_yaw=-69,
)  # fmt: skip
_RIGHT = posture(
    waist_pitch=-15, chest_pitch=34, neck_pitch=-36, right_clavicle_elevation=31,
    left_clavicle_elevation=35, right_shoulder_flexion=-2, left_shoulder_flexion=138,
    right_shoulder_abduction=50, left_shoulder_abduction=-30, right_shoulder_rotation=-28,
    left_shoulder_rotation=38, right_elbow_flexion=62, left_elbow_flexion=41, right_hip_flexion=47,
    left_hip_flexion=67, right_hip_abduction=19, left_hip_abduction=24, right_hip_rotation=25,
    left_hip_rotation=25, right_knee_flexion=78, left_knee_flexion=40, right_ankle_flexion=1,
    left_ankle_flexion=-16, waist_roll=-11, waist_yaw=-18, chest_roll=-20, chest_yaw=5, neck_roll=-40,
    neck_yaw=30,
)  # fmt: skip
_BACK = posture(
    waist_pitch=37, chest_pitch=40, neck_pitch=36, clavicle_elevation=-2, shoulder_flexion=-60,
    shoulder_abduction=8, shoulder_rotation=-9, elbow_flexion=31, hip_flexion=34, hip_abduction=25,
    hip_rotation=18, knee_flexion=122, ankle_flexion=30,
)  # fmt: skip
_POSTURES = np.array([[_FRONT, _RIGHT, _BACK], [mirrored(_FRONT), mirrored(_RIGHT), mirrored(_BACK)]])


@allocating_kernel
def part_that_lands(memory, qvel, out):
    """Where the ground will be in the pelvis's frame, seen from its middle: ``out`` (3,), forward, left, up,
    of length 1."""
    down, spin = -memory[SEEN_TURN][6:9], qvel[3:6]
    out[0] = down[0] + _FORESIGHT * (down[1] * spin[2] - down[2] * spin[1])
    out[1] = down[1] + _FORESIGHT * (down[2] * spin[0] - down[0] * spin[2])
    out[2] = down[2] + _FORESIGHT * (down[0] * spin[1] - down[1] * spin[0])
    out /= math.sqrt(out[0] ** 2 + out[1] ** 2 + out[2] ** 2)


@allocating_kernel
def begin_to_brace(memory, qvel):
    """The body has lost its balance; the side that comes down counts until it lies."""
    ground = np.empty(3)
    part_that_lands(memory, qvel, ground)
    memory[ROLL_SIDE] = 0.0 if ground[1] < 0.0 else 1.0


@allocating_kernel
def brace(memory, qvel, ctrl):
    """One control tick: write the PD targets ``ctrl`` (39,) [rad]."""
    ground = np.empty(3)
    part_that_lands(memory, qvel, ground)
    aside = ground[1] ** 2 / max(ground[0] ** 2 + ground[1] ** 2, 1e-9)
    postures = _POSTURES[int(memory[ROLL_SIDE])]
    along = postures[0] if ground[0] > 0.0 else postures[2]
    for j in range(39):
        ctrl[j] = along[j] + aside * (postures[1, j] - along[j])
