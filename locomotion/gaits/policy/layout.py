"""What a policy observes and decides, what it remembers, and where that lies in its arrays.

The policy sees the world from the person's commanded heading. In the second half of the cycle it sees and
moves the mirror image, so that left and right are exactly alike.
"""

import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import CONTROL_DT, JOINT_NAMES, MASS

__all__ = [
    "ACTION", "ACTIONS", "ANGLES", "ANKLES", "ANKLE_SOLE", "ARMS_ASIDE", "ARM_SWING", "ASKED", "ASKED_SPEED",
    "ASKED_TURN", "BODY_WEIGHT", "CHANGE", "CHANGE_SEEN", "CONTACTS", "FAST", "FAST_RATE", "FEET_AHEAD",
    "FEET_LEFT", "FEET_RISE", "FELT_SIZE", "FLOOR", "FORCES", "GRAVITY_UP", "HEADING", "HEAD_BEND",
    "HEELS_AND_BALLS", "HEIGHT_SEEN", "HIP_ROTATIONS", "INPUTS", "JOINTS", "LAGS", "LAG_AHEAD",
    "LAG_LEFT", "LEAD", "LEANING", "MIRROR_ACTION", "MIRROR_JOINT", "MIRROR_OBSERVED", "MOST_INPUT",
    "PHASE", "POLICY_DT", "RATES", "RATE_GAIN", "RESTED", "RUNNING", "SCALE", "SIGN_ACTION", "SIGN_JOINT",
    "SIGN_OBSERVED", "SLOW_RATE", "SOLES", "SOLE_POINTS", "SPEED", "SPIN", "SPREAD", "SPREADING",
    "STARTED", "STATE_SIZE", "STEP_RATE", "STYLE", "SWINGING", "TICKS_PER_DECISION", "TIMING", "TIP",
    "TOLD", "TRIM", "TRUNK_LEAN", "TURN_RATE", "VELOCITY", "YAW_SEEN",
]  # fmt: skip

TICKS_PER_DECISION = 2
"""Control ticks from one decision of the policy to the next."""
POLICY_DT = TICKS_PER_DECISION * CONTROL_DT
"""[s]"""
BODY_WEIGHT = MASS * 9.81

_HELD = (
    "chest_pitch", "chest_roll", "neck_pitch", "neck_roll", "neck_yaw", "clavicle_elevation",
    "shoulder_rotation", "forearm_twist", "wrist_flexion", "wrist_deviation",
)  # fmt: skip
JOINTS = tuple(name for name in JOINT_NAMES if name.removeprefix("right_").removeprefix("left_") not in _HELD)
"""The joints that the policy moves; the others are held straight."""
N = len(JOINTS)
ACTIONS = N + 1
"""Decisions: one change of its target per joint, and how fast the cycle goes on."""

ANKLE_SOLE = ((-0.032, 0.0, -0.064), (0.118, 0.0, -0.064))
"""Heel and ball under the sole, in the foot's frame [m]."""
TIP = (0.043, 0.0, -0.024)
"""Tip under the toes, in their frame [m]."""
SOLE_POINTS = ("right_heel", "right_ball", "right_tip", "left_heel", "left_ball", "left_tip")
HIP_ROTATIONS = [JOINTS.index(f"{side}_hip_rotation") for side in ("right", "left")]
"""Of `JOINTS`."""
SWINGING = [k for k, name in enumerate(JOINTS) if name.endswith(("shoulder_flexion", "elbow_flexion"))]
SPREADING = [k for k, name in enumerate(JOINTS) if name.endswith(("hip_abduction", "ankle_inversion"))]
ANKLES = [JOINTS.index(f"{side}_ankle_flexion") for side in ("right", "left")]
LEANING = JOINTS.index("waist_pitch")
ARMS_ASIDE = [k for k, name in enumerate(JOINTS) if name.endswith("shoulder_abduction")]
"""Of `JOINTS`: those with which arms swing, legs are spread while feet stay level, toes are raised, the trunk
leans, and arms are held aside."""
HEELS_AND_BALLS = [0, 1, 3, 4]
"""Of `SOLE_POINTS`."""

SOLES, FORCES, FELT_SIZE = slice(0, 18), slice(18, 22), 22
"""What is felt, (22,) float64: places of `SOLE_POINTS` [m]; normal forces under foot and toes, right and left
[N]."""

# ---- decisions
SCALE = np.array(
    [
        0.6 if name.endswith(("hip_flexion", "knee_flexion", "ankle_flexion", "hip_abduction")) else 0.35
        for name in JOINTS
    ]
)
"""Change of a joint's target [rad] per unit of its decision."""
LEAD = 0.1
"""[s] that targets are ahead of the reference: the servos' damping over their stiffness."""
RATE_GAIN, SLOW_RATE, FAST_RATE = 0.4, 0.6, 1.6
"""Change of the cycle's rate per unit of the last decision, and the shares of the usual rate that it keeps
to."""

# ---- observation
HEIGHT_SEEN, GRAVITY_UP, VELOCITY, SPIN, YAW_SEEN = 0, slice(1, 4), slice(4, 7), slice(7, 10), 10
LAGS = slice(11, 13)
ANGLES, RATES = slice(13, 13 + N), slice(13 + N, 13 + 2 * N)
_F = 13 + 2 * N
FEET_RISE, FEET_AHEAD, FEET_LEFT = slice(_F, _F + 6), slice(_F + 6, _F + 8), slice(_F + 8, _F + 10)
CONTACTS, TIMING = slice(_F + 10, _F + 14), slice(_F + 14, _F + 19)
ASKED = slice(_F + 19, _F + 21)
CHANGE_SEEN = _F + 21
INPUTS = _F + 22
"""Numbers observed: height of the root over the ground [m]; the world's up in the root's frame; velocity
ahead, left, up [m/s]; angular velocity [rad/s] in the root's frame; yaw from the heading [rad]; low-passed
errors of the speed ahead and to the left [m/s]; angles [rad] and a tenth of the rates [rad/s] of `JOINTS`;
heights of `SOLE_POINTS` over the root; both heels ahead, and left, of it [m]; contacts of foot and toes,
right and left, 0 to 1; sine and cosine of the cycle and of twice the cycle, whether it goes on; speed [m/s]
and turn rate [rad/s] asked for; how fast that speed changes [m/s^2]."""
MOST_INPUT = 8.0
"""Deviations from the mean by which an input counts at most."""

# ---- memory
PHASE, RUNNING, RESTED, HEADING, SPEED, TURN_RATE, LAG_AHEAD, LAG_LEFT, STARTED, TOLD, TRIM = range(11)
FLOOR, FAST, CHANGE = 11, 12, 13
STEP_RATE, ARM_SWING, SPREAD, TRUNK_LEAN, HEAD_BEND = range(14, 19)
STYLE = slice(14, 19)
_M = 19
ACTION = slice(_M, _M + ACTIONS)
STATE_SIZE = _M + ACTIONS
"""The memory of a policy: share of the cycle, 0 to 1, from the right heel's strike; whether it goes on; [s]
since it has nothing to do but to stand, below 0 while it sets off; heading [rad], speed [m/s] and turn rate
[rad/s] that it keeps to; low-passed errors of the speed; whether it has decided before; speed [m/s] that
follows the one asked for, and what it adds to that because it is too slow or too fast; height of the ground
under it [m], which whoever moves it over a ground keeps up to date; whether it runs, or has not slowed down
from a run to a walk yet; how fast the speed that it follows changes, low-passed [m/s^2]; its style
(`locomotion.gaits.policy.style`), all 0 in the usual one; and its last decisions, in the person's own left
and right."""
ASKED_SPEED, ASKED_TURN = 0, 1
"""What a caller asks for: speed [m/s] and turn rate [rad/s]."""


def _other_side(name: str) -> str:
    for side, other in (("right_", "left_"), ("left_", "right_")):
        if name.startswith(side):
            return other + name.removeprefix(side)
    return name


MIRROR_JOINT = np.array([JOINTS.index(_other_side(name)) for name in JOINTS])
SIGN_JOINT = np.array([-1.0 if name.endswith(("waist_roll", "_yaw")) else 1.0 for name in JOINTS])
"""The mirror image of joint values: ``values[MIRROR_JOINT] * SIGN_JOINT``; the same for the others."""
MIRROR_ACTION = np.append(MIRROR_JOINT, N)
SIGN_ACTION = np.append(SIGN_JOINT, 1.0)


def _mirror_observed() -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    order, sign = np.arange(INPUTS), np.ones(INPUTS)
    for k in (GRAVITY_UP.start + 1, VELOCITY.start + 1, SPIN.start, SPIN.start + 2, YAW_SEEN, LAGS.start + 1):
        sign[k] = -1.0
    sign[ASKED.start + 1] = -1.0
    for part in (ANGLES, RATES):
        order[part], sign[part] = part.start + MIRROR_JOINT, SIGN_JOINT
    order[FEET_RISE] = FEET_RISE.start + np.array([3, 4, 5, 0, 1, 2])
    order[FEET_AHEAD], order[FEET_LEFT] = (
        FEET_AHEAD.start + np.array([1, 0]),
        FEET_LEFT.start + np.array([1, 0]),
    )
    order[CONTACTS] = CONTACTS.start + np.array([2, 3, 0, 1])
    sign[FEET_LEFT] = -1.0
    return order, sign


MIRROR_OBSERVED, SIGN_OBSERVED = _mirror_observed()
