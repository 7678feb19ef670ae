"""A residual policy, compiled: what it observes, and how it moves the targets of the gait that it corrects.

`observe` reads the memory of the running controller ``state`` (its `OBSERVED` also while the person walks),
that of the walk, and the body.
"""

import math

import numpy as np

from locomotion.body.person import JOINT_NAMES
from locomotion.gaits.policy.evaluation import evaluate
from locomotion.gaits.policy.layout import BODY_WEIGHT, JOINTS, MIRROR_JOINT, SIGN_JOINT
from locomotion.gaits.residual import layout as at
from locomotion.gaits.run import layout as run
from locomotion.gaits.walk import layout as walking
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["add_to", "decide", "observe"]

_N = len(JOINTS)
_COLUMNS = np.array([JOINT_NAMES.index(name) for name in JOINTS])
_UP, _VELOCITY, _SPIN, _FEET = at.GRAVITY_UP.start, at.VELOCITY.start, at.SPIN.start, at.FEET.start
_CONTACTS, _ANGLES, _RATES = at.CONTACTS.start, at.ANGLES.start, at.RATES.start
_TIMING, _BEFORE, _DECIDED = at.TIMING.start, at.BEFORE.start, at.DECIDED.start


@allocating_kernel
def observe(memory, state, walk, qpos, qvel, out):
    """What the policy observes into ``out`` (INPUTS,), mirrored where the left foot is the stance foot; gives
    whether it is."""
    walks = walk[walking.WALKS] > 0.0
    heading = walk[walking.WALK_HEADING] if walks else state[run.HEADING]
    stance = walk[walking.WALK_STANCE] if walks else state[run.STANCE]
    seen = np.empty(at.INPUTS)
    c, s = math.cos(heading), math.sin(heading)
    w, x, y, z = qpos[3], qpos[4], qpos[5], qpos[6]
    seen[at.HEIGHT] = state[run.COM_Z] - min(state[run.RIGHT_FOOT + 2], state[run.LEFT_FOOT + 2])
    seen[_UP] = 2 * (x * z - w * y)
    seen[_UP + 1] = 2 * (y * z + w * x)
    seen[_UP + 2] = 1 - 2 * (x * x + y * y)
    seen[_VELOCITY] = c * state[run.VELOCITY_X] + s * state[run.VELOCITY_Y]
    seen[_VELOCITY + 1] = c * state[run.VELOCITY_Y] - s * state[run.VELOCITY_X]
    seen[_VELOCITY + 2] = state[run.VELOCITY_Z]
    for k in range(3):
        seen[_SPIN + k] = qvel[3 + k]
    yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) - heading
    seen[at.YAW] = (yaw + math.pi) % (2.0 * math.pi) - math.pi
    for side in range(2):
        foot = run.RIGHT_FOOT if side == 0 else run.LEFT_FOOT
        dx, dy = state[foot] - state[run.COM_X], state[foot + 1] - state[run.COM_Y]
        seen[_FEET + 3 * side] = c * dx + s * dy
        seen[_FEET + 3 * side + 1] = c * dy - s * dx
        seen[_FEET + 3 * side + 2] = state[foot + 2] - state[run.COM_Z]
        force = state[run.RIGHT_CONTACT if side == 0 else run.LEFT_CONTACT]
        seen[_CONTACTS + side] = math.tanh(2.0 / BODY_WEIGHT * force)
    for k in range(_N):
        seen[_ANGLES + k] = qpos[7 + _COLUMNS[k]]
        seen[_RATES + k] = 0.1 * qvel[6 + _COLUMNS[k]]
        seen[_BEFORE + k] = memory[_DECIDED + k]
    seen[_TIMING] = 0.0 if walks else 1.0
    seen[_TIMING + 1] = 1.0 if walks and walk[walking.PHASE] != walking.SINGLE else 0.0
    seen[_TIMING + 2] = 0.0 if walks else state[run.PHASE]
    seen[_TIMING + 3] = walk[walking.CLOCK] if walks else state[run.STEP_TIME]
    seen[at.ASKED] = walk[walking.WALK_SPEED] if walks else state[run.SPEED]
    left = stance > 0.0
    for k in range(at.INPUTS):
        out[k] = seen[at.MIRROR_OBSERVED[k]] * at.SIGN_OBSERVED[k] if left else seen[k]
    return left


@allocating_kernel
def decide(network, observed, left, memory):
    """What the ``network`` decides from ``observed`` (INPUTS,), into ``memory`` (MEMORY_SIZE,); ``left``:
    whether that is the mirror image."""
    decided = np.empty(at.ACTIONS, np.float32)
    evaluate(network, observed, decided)
    for k in range(at.ACTIONS):
        memory[_DECIDED + k] = decided[MIRROR_JOINT[k]] * SIGN_JOINT[k] if left else decided[k]


@kernel
def add_to(memory, ctrl):
    """Move the targets ``ctrl`` (39,) [rad] as was decided."""
    for k in range(_N):
        ctrl[_COLUMNS[k]] += at.SCALE * memory[_DECIDED + k]
