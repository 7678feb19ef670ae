"""What a residual policy observes, decides and remembers, and where that lies in its arrays.

It sees the world from the heading of the gait that it corrects. While the left foot is the stance foot, it
sees and moves the mirror image.
"""

import numpy as np
from numpy.typing import NDArray

from locomotion.gaits.policy.layout import JOINTS, MIRROR_JOINT, SIGN_JOINT
from navmesh.obstacles.kinds import CROSSINGS

__all__ = [
    "ACTIONS", "ANGLES", "ASKED", "BEFORE", "CLEARS", "CONTACTS", "CROSSING", "DECIDED", "FEET",
    "GRAVITY_UP", "HEIGHT", "INPUTS", "LANDED", "LANDING_INPUTS", "MEMORY_SIZE", "MIRROR_OBSERVED", "RATES",
    "SCALE", "SIGN_OBSERVED", "SINCE", "SPIN", "TIMING", "VELOCITY", "YAW",
]  # fmt: skip

ACTIONS = len(JOINTS)
"""Decisions: a change of the target of each of `locomotion.gaits.policy.layout.JOINTS`."""
SCALE = 0.25
"""[rad] of such a change per unit of a decision."""

_N = ACTIONS
HEIGHT, GRAVITY_UP, VELOCITY, SPIN, YAW = 0, slice(1, 4), slice(4, 7), slice(7, 10), 10
FEET, CONTACTS = slice(11, 17), slice(17, 19)
ANGLES, RATES = slice(19, 19 + _N), slice(19 + _N, 19 + 2 * _N)
_T = 19 + 2 * _N
TIMING, ASKED = slice(_T, _T + 4), _T + 4
BEFORE = slice(_T + 5, _T + 5 + _N)
INPUTS = _T + 5 + _N
"""Numbers observed: height [m] of the centre of mass over the lower foot; the world's up in the root's frame;
velocity of the centre of mass ahead, left, up [m/s]; angular velocity [rad/s] in the root's frame; yaw from
the heading [rad]; right and left ankle from the centre of mass, ahead, left, up [m]; weight on each,
0 to 1; angles [rad] and a tenth of the rates [rad/s] of the joints; whether it runs, whether both feet bear
a walk, share of the running step, [s] since the step began; speed [m/s] of the gait's reference; the
decisions before."""

LANDED, CLEARS = INPUTS, INPUTS + 1
CROSSING = slice(INPUTS + 2, INPUTS + 2 + len(CROSSINGS))
LANDING_INPUTS = CROSSING.stop
"""Numbers observed after a landing: the same, and share of its time since the landing; whether the skill is
still at work; how the obstacle is crossed, one number for each of `navmesh.obstacles.kinds.CROSSINGS`. The
mirror image has the same."""

SINCE = 0
DECIDED = slice(1, 1 + _N)
MEMORY_SIZE = 1 + _N
"""What is remembered: ticks since it began; the last decisions, in the person's own left and right."""


def _mirror() -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    order, sign = np.arange(INPUTS), np.ones(INPUTS)
    for k in (GRAVITY_UP.start + 1, VELOCITY.start + 1, SPIN.start, SPIN.start + 2, YAW):
        sign[k] = -1.0
    order[FEET] = FEET.start + np.array([3, 4, 5, 0, 1, 2])
    sign[[FEET.start + 1, FEET.start + 4]] = -1.0
    order[CONTACTS] = CONTACTS.start + np.array([1, 0])
    for part in (ANGLES, RATES, BEFORE):
        order[part], sign[part] = part.start + MIRROR_JOINT, SIGN_JOINT
    return order, sign


MIRROR_OBSERVED, SIGN_OBSERVED = _mirror()
"""The mirror image of what is observed: ``observed[MIRROR_OBSERVED] * SIGN_OBSERVED``."""
