"""From hands and feet to a stand (numba).

First the feet step forward under the body, with the ordinary gait and home positions of their own (`gather`);
then hands push the body back over them, and hips and trunk rise over the soles together (`rise_tick`).
"""

import math

import numpy as np

from locomotion.body.person import CONTROL_DT, JOINT_NAMES
from locomotion.gaits.walk.layout import clamp
from locomotion.recovery.layout import (
    ALL_DOWN,
    BEGUN_FROM,
    BORNE,
    CENTRE,
    FACING,
    GATHERING,
    GATHERS,
    HOMES,
    LOADS,
    MODE,
    MODE_CLOCK,
    PHASE,
    RISEN,
    RISING,
    SEEN_BASE,
    SEEN_COM,
    SEEN_FORCES,
    SEEN_LIMBS,
    SEEN_TURN,
    SEEN_VELOCITY,
    STANCE,
)  # fmt: skip
from locomotion.recovery.limbs import (
    GRAVITY,
    LEGS,
    STIFFNESS,
    WAIST_CHEST_NECK,
    attitude,
    bear,
    leg_angles,
    turned,
)
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["begin_to_rise", "gather", "ready_to_rise", "rise_tick", "stands"]

_GATHERED = {
    "foot_behind": -0.10,
    "foot_slope": 0.0,
    "hand_ahead": 0.27,
    "height": 0.40,
    "foot_out": 0.08,
    "curve": 0.4,
    "arm": 0.6,
    "pause": 0.03,
}
_HOMES = np.array(list(HOMES.values()))
_CLOSE = np.array([_GATHERED.get(name, value) for name, value in HOMES.items()])
_SHIFT_TIME, _RISES_AFTER, _RISE_TIME = 0.15, 0.05, 0.9  # [s]
_HANDED_OVER = 0.95  # share of that after which the walk takes over
_BEHIND, _AT_REST = -0.33, 0.5  # [m] of the feet ahead of the body, [m/s]: hands can push it over them
_ROUND = 9.0  # [s] after which feet that do not come under the body try again
_SHIFTS = 2.0  # [s] in which the weight comes over the feet, or they step again
_OVER = 0.05  # [m] of the centre of mass ahead of the balls, below which the hands let go
_COASTS = 0.15  # [s] that it goes on at its speed when the hands let go
_GOES_OVER = 0.1  # share of the way to over the feet by which its wanted place moves in a tick
_PUSH, _PUSH_DAMP, _PUSH_MOST = 40.0, 10.0, 4.0  # [1/s2], [1/s], [m/s2] with which it is pushed there
_HIPS, _LEAN = 0.80, 0.12  # [m] of the hips above the soles, [rad] at the end
_SOLE_BACK = 0.03  # [m] from the ball back to where the weight is to be
_WAIST, _CHEST, _ = WAIST_CHEST_NECK
_R_HIP, _L_HIP = LEGS
_ABDUCTIONS = np.array([JOINT_NAMES.index(f"{s}_shoulder_abduction") for s in ("right", "left")])
_ELBOWS = np.array([JOINT_NAMES.index(f"{s}_elbow_flexion") for s in ("right", "left")])


@allocating_kernel
def gather(memory, to_rise):
    """Where the limbs are at home from now on: close before rising, or apart for scrambling. Returns whether
    close. Feet that do not come under the body where it is are given up after a while: it scrambles on a bit
    before it tries again."""
    memory[GATHERING] = (memory[GATHERING] + CONTROL_DT) % _ROUND if to_rise else 0.0
    close = to_rise and memory[GATHERING] < GATHERS
    memory[STANCE] = _CLOSE if close else _HOMES
    return close


@allocating_kernel
def ready_to_rise(memory):
    """Whether the feet are under the body and it is at rest."""
    seen, com, v = memory[SEEN_LIMBS].reshape(4, 3), memory[SEEN_COM], memory[SEEN_VELOCITY]
    if memory[PHASE] != ALL_DOWN or memory[RISEN] < 1.0 or math.hypot(v[0], v[1]) > _AT_REST:
        return False
    ch, sh = math.cos(memory[FACING]), math.sin(memory[FACING])
    ahead = ch * (seen[2:, 0] - com[0]) + sh * (seen[2:, 1] - com[1])
    if ahead.min() < _BEHIND or memory[SEEN_FORCES][2:].min() < 20.0:
        return False
    return True


@allocating_kernel
def begin_to_rise(memory, qpos):
    memory[MODE], memory[MODE_CLOCK], memory[GATHERING] = RISING, 0.0, 0.0
    memory[BEGUN_FROM] = qpos[7:]
    turn, seen = memory[SEEN_TURN], memory[SEEN_LIMBS].reshape(4, 3)
    ch, sh = math.cos(memory[FACING]), math.sin(memory[FACING])
    # lean and height of the hips now
    memory[BEGUN_FROM.start] = math.atan2(ch * turn[2] + sh * turn[5], turn[8])
    memory[BEGUN_FROM.start + 1] = memory[SEEN_BASE.start + 2] - 0.5 * (seen[2, 2] + seen[3, 2])


@allocating_kernel
def rise_tick(memory, qpos, ctrl):
    """One control tick: write the PD targets ``ctrl`` (39,) [rad]."""
    seen, com, base, v = (
        memory[SEEN_LIMBS].reshape(4, 3),
        memory[SEEN_COM],
        memory[SEEN_BASE],
        memory[SEEN_VELOCITY],
    )
    ch, sh = math.cos(memory[FACING]), math.sin(memory[FACING])
    # the weight goes over to the feet first
    over = ch * (com[0] - 0.5 * (seen[2, 0] + seen[3, 0])) + sh * (com[1] - 0.5 * (seen[2, 1] + seen[3, 1]))
    over += _COASTS * (ch * v[0] + sh * v[1])
    if memory[MODE_CLOCK] > 0.0 or over < _OVER:
        memory[MODE_CLOCK] += CONTROL_DT
    else:
        memory[GATHERING] += CONTROL_DT
        if memory[GATHERING] >= _SHIFTS:  # the weight does not come over the feet
            memory[MODE] = BORNE
    shift = clamp(memory[MODE_CLOCK] / _SHIFT_TIME, 0.0, 1.0)
    up = clamp((memory[MODE_CLOCK] - _RISES_AFTER) / _RISE_TIME, 0.0, 1.0)
    up = up * up * (3.0 - 2.0 * up)
    for k in range(2):
        memory[LOADS.start + k] = 1.0 - shift
        memory[LOADS.start + 2 + k] = 1.0
    qref = np.zeros(qpos.shape[0])
    lean = memory[BEGUN_FROM.start] + up * (_LEAN - memory[BEGUN_FROM.start])
    height = memory[BEGUN_FROM.start + 1] + up * (_HIPS - memory[BEGUN_FROM.start + 1])
    # over the balls while the heels are up, over the soles when they are down
    heel = memory[BEGUN_FROM.start + 2]
    back = _SOLE_BACK * (1.0 - min(heel / 0.3, 1.0)) - 0.01
    mx, my = 0.5 * (seen[2, 0] + seen[3, 0]) - back * ch, 0.5 * (seen[2, 1] + seen[3, 1]) - back * sh
    memory[CENTRE.start] += _GOES_OVER * (mx - memory[CENTRE.start])
    memory[CENTRE.start + 1] += _GOES_OVER * (my - memory[CENTRE.start + 1])
    attitude(memory[FACING], lean, 0.0, qref)
    pelvis, angles, torques = np.empty((3, 3)), np.empty(7), np.empty(39)
    turned(qref[3:7], pelvis)
    turn = memory[SEEN_TURN].reshape(3, 3)
    off = turn.T @ (com - base)
    for i in range(2):
        lever = pelvis[i, 0] * off[0] + pelvis[i, 1] * off[1] + pelvis[i, 2] * off[2]
        qref[i] = memory[CENTRE.start + i] - lever - 0.1 * v[i]
    qref[2] = 0.5 * (seen[2, 2] + seen[3, 2]) + height
    # hands and soles push the body over the feet
    limbs, push = seen.copy(), np.array([mx - com[0], my - com[1]])
    for i in range(2):
        push[i] = clamp(_PUSH * push[i] - _PUSH_DAMP * v[i], -_PUSH_MOST, _PUSH_MOST)
    bx, by = 0.5 * (seen[2, 0] + seen[3, 0]), 0.5 * (seen[2, 1] + seen[3, 1])
    lever = (com[2] - seen[2, 2]) / GRAVITY
    along = ch * (com[0] - lever * push[0] - bx) + sh * (com[1] - lever * push[1] - by)
    along = clamp(along, -0.11 * (1.0 - min(heel / 0.2, 1.0)), 0.04)
    for k in range(2, 4):
        limbs[k, 0] += along * ch
        limbs[k, 1] += along * sh
    bear(memory, limbs, push, torques)
    ctrl[:] = memory[BEGUN_FROM] * (1.0 - up)
    ctrl[:9] = 0.0
    for j in (_WAIST, _CHEST):
        ctrl[j] = (1.0 - up) * _CLOSE[-1]
    for k in range(2):
        ctrl[_ABDUCTIONS[k]] += up * 0.12
        ctrl[_ELBOWS[k]] += up * 0.35
    for k in range(2, 4):
        side = -1.0 if k == 2 else 1.0
        first = _R_HIP if k == 2 else _L_HIP
        leg_angles(qref, pelvis, seen[k], memory[FACING] + 0.1 * side, 0.0, side, angles)
        ctrl[first : first + 7] = angles
        memory[BEGUN_FROM.start + 2] = angles[6]
    for j in range(39):
        ctrl[j] += torques[j] / STIFFNESS[j]


@kernel
def stands(memory):
    """Whether the body has come up."""
    return memory[MODE_CLOCK] > _RISES_AFTER + _HANDED_OVER * _RISE_TIME
