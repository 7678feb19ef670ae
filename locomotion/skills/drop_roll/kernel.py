"""Rolling off a drop: the control law from the last step on the ledge to the rise after the roll (numba).

Phases, as in "Terrain Runner" (Liu and others, 2012), section 3:

    `TAKE_OFF`  the run goes on until no foot touches the ground and the centre of mass is past the edge
    `FALL`      legs are aimed at the ground below, by the time that is left to the touchdown
    `ROLL`      from the touchdown of a foot until the feet carry the body again behind the roll
    `RISE`      the legs straighten while the momentum carries the body over its feet

The reference pose is not played against time but against how far the body is: in the fall against the time
to the touchdown, on the ground against the angle by which the pelvis has turned forward. A roll that is
slower or faster than the reference stays in step with it by itself. On top of the clip comes

    a_hat(u, h) + M_ap M_sp,k (s - s_ref(u))                                    (rank 3; k: fall, roll, rise)

with ``a_hat`` at knots over the share u for the actions `ACTIONS`, and ``s`` (`SENSORS`) in the frame of the
approach. Everything is mirrored when the roll is over the left shoulder: then the right foot took off.
"""

import math

import numpy as np

from locomotion.body.person import CONTROL_DT, JOINT_NAMES
from locomotion.gaits.run import layout
from surefoot.kernels import allocating_kernel, kernel

__all__ = [
    "ACTIONS", "ACTIVE", "AHEAD_X", "AHEAD_Y", "ANGLE",
    "BINS", "EDGE_X", "EDGE_Y", "ENDED", "FALL", "KNOTS", "LOW", "MEMORY_SIZE", "MOST_OFF",
    "PARAMETERS", "PHASE", "PHASE_TICKS", "RANK", "RATE", "RISE", "ROLL", "SENSED", "SENSORS", "SHARE",
    "SHARE_RATE", "SIDE", "SLIPPERY", "TAKE_OFF", "drop_roll_tick", "parameter_slices",
    "start_drop_roll",
]  # fmt: skip

TAKE_OFF, FALL, ROLL, RISE = 0.0, 1.0, 2.0, 3.0
RANK, KNOTS, BINS = 3, 11, 11
ACTIONS = (
    "hips", "knees", "ankles", "trunk_pitch", "shoulders", "hip_split", "trunk_roll", "trunk_yaw",
    "legs_side",
)  # fmt: skip
"""Both hips, knees, ankles and shoulders; waist and chest; right hip forward and left one back; trunk; right
leg out and left leg in [rad]."""
SENSORS = (
    "rate", "vx", "vz", "height", "feet_ahead", "feet_below", "tilt", "tilt_rate", "yaw", "yaw_rate", "vy",
    "aside",
)  # fmt: skip
"""Turning forward [rad/s]; velocity and height [m] of the centre of mass above the lower ground; the feet's
middle relative to it; then the lateral ones: rise of the pelvis's left side, its rate, turn of the pelvis's
axis, its rate, sideways velocity, feet to the left."""
_S_RATE, _S_VX, _S_VZ, _S_HEIGHT, _S_FEET_AHEAD, _S_FEET_BELOW = range(6)
_S_TILT, _S_TILT_RATE, _S_YAW, _S_YAW_RATE, _S_VY, _S_ASIDE = range(6, 12)  # places in `SENSORS`
_HIPS, _KNEES, _ANKLES, _TRUNK_PITCH, _SHOULDERS, _HIP_SPLIT, _TRUNK_ROLL, _TRUNK_YAW, _LEGS_SIDE = range(9)
# places in `ACTIONS`
_N_ACTIONS, _N_SENSORS = len(ACTIONS), len(SENSORS)

PARAMETERS: dict[str, int] = {
    "pose": KNOTS * _N_ACTIONS,  # (11, 9) a_hat over the share [rad]
    "landing": 7,  # see `_aim_legs`
    "timing": 4,  # lead [s], least rate of the share [1/s], how far it may be ahead, blend from the run [s]
    "rise": 3,  # angle [rad], height [m] and capture point ahead of the feet [m] at which the rise begins
    "mark": 2,  # distance of the stance foot to the edge at the start [m]; entry speed [m/s]
    "m_sp": 3 * RANK * _N_SENSORS,  # (3, 3, 12) for fall, roll, rise
    "m_ap": _N_ACTIONS * RANK,  # (9, 3)
}
"""Blocks of a parameter vector, in order, with their lengths."""


def parameter_slices() -> dict[str, slice]:
    """Where each block of `PARAMETERS` lies in a parameter vector."""
    result, start = {}, 0
    for name, size in PARAMETERS.items():
        result[name] = slice(start, start + size)
        start += size
    return result


_SP = parameter_slices()
_POSE, _LANDING, _TIMING, _RISE, _MARK, _M_SP, _M_AP = (_SP[k].start for k in PARAMETERS)

# --- what a roll remembers
ACTIVE, PHASE, ANGLE, RATE, SHARE, SHARE_RATE, SIDE, LOW, PHASE_TICKS, ENDED = range(10)
"""1 while it goes on; its phase; angle [rad] by which the pelvis has turned forward and its rate; share of
the clip and its rate [1/s]; +1 over the right shoulder, -1 the left; height [m] of the lower ground; ticks in
this phase; 1 when it ended on its feet."""
EDGE_X, EDGE_Y, AHEAD_X, AHEAD_Y = range(10, 14)
"""A point of the edge (x, y) [m] and the unit direction of the approach (x, y)."""
_FROM = 14  # (39,) targets [rad] of the run with which it began to fall
_N = len(JOINT_NAMES)
SENSED = slice(_FROM + _N, _FROM + _N + _N_SENSORS)
SLIPPERY = SENSED.stop
"""How much it rolls as on slippery ground, 0 to 1."""
MEMORY_SIZE = SLIPPERY + 1
_SENSED = SENSED.start

_HIP, _LEFT_HIP = (JOINT_NAMES.index(f"{side}_hip_flexion") for side in ("right", "left"))
_SHOULDER, _LEFT_SHOULDER = (JOINT_NAMES.index(f"{side}_shoulder_flexion") for side in ("right", "left"))
_WAIST, _CHEST = JOINT_NAMES.index("waist_pitch"), JOINT_NAMES.index("chest_pitch")
_GRAVITY = 9.81
_TOUCH = 50.0  # [N] of a foot that has landed
_PITCH = 0.7  # [rad] of the pelvis at a usual touchdown
_REACH = 0.3  # [s] before the touchdown in which the legs are aimed
_FALL_SHARE, _TURN = 0.2, 0.8 / (2.0 * math.pi)  # share at the touchdown; per [rad] of turning
_LONGEST = 300.0  # ticks on the ground after which it has failed
_ANKLE = 0.064  # [m] of the ankle above the sole
MOST_OFF = np.array([6.0, 1.5, 2.0, 0.3, 0.4, 0.3, 0.6, 5.0, 0.8, 5.0, 1.0, 0.3])
"""Deviations of the sensors beyond which they count no more."""


@allocating_kernel
def start_drop_roll(memory, side, low, edge_x, edge_y, ahead_x, ahead_y):
    """Begin at the stance switch that has just been made (its tick's `drop_roll_tick` comes next).

    memory (MEMORY_SIZE,). side: +1 to roll over the right shoulder, -1 the left. low: height
    of the lower ground [m]. edge: a point of the edge [m]; ahead: unit vector of the approach.
    """
    memory[:] = 0.0
    memory[ACTIVE] = 1.0
    memory[SIDE], memory[LOW] = side, low
    memory[EDGE_X], memory[EDGE_Y], memory[AHEAD_X], memory[AHEAD_Y] = edge_x, edge_y, ahead_x, ahead_y


@kernel
def _sense(memory, state, qpos, qvel):
    """Turn of the pelvis and the sensors into ``memory``."""
    w, x, y, z = qpos[3], qpos[4], qpos[5], qpos[6]
    ax, ay, side = memory[AHEAD_X], memory[AHEAD_Y], memory[SIDE]
    r00, r10, r20 = 1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)
    r01, r11, r21 = 2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)
    r02, r12, r22 = 2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)
    gx = r00 * qvel[3] + r01 * qvel[4] + r02 * qvel[5]
    gy = r10 * qvel[3] + r11 * qvel[4] + r12 * qvel[5]
    gz = r20 * qvel[3] + r21 * qvel[4] + r22 * qvel[5]
    turned = math.atan2(r02 * ax + r12 * ay, r22) - memory[ANGLE]
    turned = (turned + math.pi) % (2.0 * math.pi) - math.pi
    memory[ANGLE] += turned
    memory[RATE] = -gx * ay + gy * ax
    out = memory[_SENSED : _SENSED + _N_SENSORS]
    fx = 0.5 * (state[layout.RIGHT_FOOT] + state[layout.LEFT_FOOT]) - state[layout.COM_X]
    fy = 0.5 * (state[layout.RIGHT_FOOT + 1] + state[layout.LEFT_FOOT + 1]) - state[layout.COM_Y]
    out[_S_RATE] = memory[RATE]
    out[_S_VX] = state[layout.VELOCITY_X] * ax + state[layout.VELOCITY_Y] * ay
    out[_S_VZ] = state[layout.VELOCITY_Z]
    out[_S_HEIGHT] = state[layout.COM_Z] - memory[LOW]
    out[_S_FEET_AHEAD] = fx * ax + fy * ay
    out[_S_FEET_BELOW] = (
        0.5 * (state[layout.RIGHT_FOOT + 2] + state[layout.LEFT_FOOT + 2]) - state[layout.COM_Z]
    )
    out[_S_TILT] = side * r21
    out[_S_TILT_RATE] = side * (gx * ax + gy * ay)
    out[_S_YAW] = side * (r01 * ax + r11 * ay)
    out[_S_YAW_RATE] = side * gz
    out[_S_VY] = side * (-state[layout.VELOCITY_X] * ay + state[layout.VELOCITY_Y] * ax)
    out[_S_ASIDE] = side * (-fx * ay + fy * ax)


@kernel
def _time_to_touchdown(memory, state):
    """[s] until the lower foot is on the lower ground."""
    above = max(min(state[layout.RIGHT_FOOT + 2], state[layout.LEFT_FOOT + 2]) - _ANKLE - memory[LOW], 0.0)
    vz = state[layout.VELOCITY_Z]
    return (vz + math.sqrt(vz * vz + 2.0 * _GRAVITY * above)) / _GRAVITY


@kernel
def _go_on(p, memory, state):
    """Phases and the share of the clip."""
    phase = memory[PHASE]
    memory[PHASE_TICKS] += 1.0
    sensed = memory[_SENSED : _SENSED + _N_SENSORS]
    contact = state[layout.RIGHT_CONTACT] + state[layout.LEFT_CONTACT]
    if phase == TAKE_OFF:
        past = (state[layout.COM_X] - memory[EDGE_X]) * memory[AHEAD_X] + (
            state[layout.COM_Y] - memory[EDGE_Y]
        ) * memory[AHEAD_Y]
        if past > 0.0 and contact < 1.0:
            memory[PHASE], memory[PHASE_TICKS] = FALL, 0.0
        return
    old = memory[SHARE]
    if phase == FALL:
        low = min(state[layout.RIGHT_FOOT + 2], state[layout.LEFT_FOOT + 2]) - memory[LOW]
        if contact > _TOUCH and low < 0.25:
            memory[PHASE], memory[PHASE_TICKS] = ROLL, 0.0
        left = _time_to_touchdown(memory, state)
        memory[SHARE] = max(old, _FALL_SHARE * min(max(1.0 - (left - 0.02) / (_REACH + 0.05), 0.0), 1.0))
    else:
        wanted = _FALL_SHARE + _TURN * memory[ANGLE]
        slow = old + max(p[_TIMING + 1], 0.0) * CONTROL_DT
        memory[SHARE] = min(max(old, min(max(slow, wanted), wanted + p[_TIMING + 2])), 1.0)
        if phase == ROLL:
            over = memory[ANGLE] > p[_RISE] and sensed[_S_HEIGHT] > p[_RISE + 1] and contact > _TOUCH
            if over and 0.25 * sensed[_S_VX] - sensed[_S_FEET_AHEAD] > p[_RISE + 2]:
                memory[PHASE], memory[ENDED], memory[ACTIVE] = RISE, 1.0, 0.0
            elif memory[PHASE_TICKS] > _LONGEST:
                memory[ACTIVE] = 0.0
    memory[SHARE_RATE] += 0.3 * ((memory[SHARE] - old) / CONTROL_DT - memory[SHARE_RATE])


@kernel
def _aim_legs(p, memory, state, pose):
    """In the fall: hips and ankles so that the legs are at the wanted angle to the vertical at the touchdown.

    p[_LANDING:] = angle of the legs ahead [rad], its change per forward speed above 3 m/s and per turning
    rate, how far the toes hang [rad], how far the right leg is ahead of the left one [rad], knees [rad], and
    the angle's change per pitch at the touchdown [rad/rad].
    """
    left = _time_to_touchdown(memory, state)
    share = min(max(1.0 - (left - 0.05) / _REACH, 0.0), 1.0)
    pitch = memory[ANGLE] + min(max(memory[RATE], -2.0), 3.0) * left
    sensed = memory[_SENSED : _SENSED + _N_SENSORS]
    ahead = p[_LANDING] + p[_LANDING + 1] * (sensed[_S_VX] - 3.0) + p[_LANDING + 2] * memory[RATE]
    ahead += p[_LANDING + 6] * (pitch - _PITCH)
    for leg in range(2):
        hip = _HIP if leg == 0 else _LEFT_HIP
        split = p[_LANDING + 4] if leg == 0 else -p[_LANDING + 4]
        knee = pose[hip + 3] + p[_LANDING + 5]
        flexion = ahead + split + 0.5 * knee + pitch
        level = pitch - flexion + knee - p[_LANDING + 3]
        pose[hip] += share * (flexion - pose[hip])
        pose[hip + 3] += share * (knee - pose[hip + 3])
        pose[hip + 4] += share * (level - pose[hip + 4])


@allocating_kernel
def drop_roll_tick(p, clip, reference, mirror, sign, memory, state, qpos, qvel, ctrl):
    """One tick, after `run_tick` and before the physics: overwrites ``ctrl`` (39,) once it falls.

    p: parameters at this height. clip (n, 39): poses by the share [rad]. reference (11, 12): expected sensors
    by the share. mirror, sign (39,). memory (MEMORY_SIZE,), state: changed.
    """
    if memory[ACTIVE] == 0.0:
        return
    _sense(memory, state, qpos, qvel)
    before = memory[PHASE]
    _go_on(p, memory, state)
    phase = memory[PHASE]
    if phase == TAKE_OFF:
        return
    if before == TAKE_OFF:
        for j in range(_N):
            memory[_FROM + j] = ctrl[j]
    share = memory[SHARE]
    # servos lag behind their targets: ask for the pose of a little later
    at = min(max(share + p[_TIMING] * memory[SHARE_RATE], 0.0), 1.0) * (clip.shape[0] - 1)
    low = min(int(at), clip.shape[0] - 2)
    weight = at - low
    pose = np.empty(_N)
    for j in range(_N):
        pose[j] = (1.0 - weight) * clip[low, j] + weight * clip[low + 1, j]
    action = np.empty(_N_ACTIONS)
    at = share * (KNOTS - 1)
    low = min(int(at), KNOTS - 2)
    weight = at - low
    for i in range(_N_ACTIONS):
        knot = _POSE + low * _N_ACTIONS + i
        action[i] = (1.0 - weight) * p[knot] + weight * p[knot + _N_ACTIONS]
    stage = 0 if phase == FALL else (1 if share < 0.75 else 2)
    for r in range(RANK):
        latent = 0.0
        for j in range(_N_SENSORS):
            expected = (1.0 - weight) * reference[low, j] + weight * reference[low + 1, j]
            off = min(max(memory[_SENSED + j] - expected, -MOST_OFF[j]), MOST_OFF[j])
            latent += p[_M_SP + (stage * RANK + r) * _N_SENSORS + j] * off
        latent = min(max(latent, -1.0), 1.0)
        for i in range(_N_ACTIONS):
            action[i] += p[_M_AP + i * RANK + r] * latent
    for leg in range(2):
        hip = _HIP if leg == 0 else _LEFT_HIP
        right = 1.0 if leg == 0 else -1.0
        pose[hip] += action[_HIPS] + right * action[_HIP_SPLIT]
        pose[hip + 1] += right * action[_LEGS_SIDE]
        pose[hip + 3] += action[_KNEES]
        pose[hip + 4] += action[_ANKLES]
        pose[_SHOULDER if leg == 0 else _LEFT_SHOULDER] += action[_SHOULDERS]
    for part in (_WAIST, _CHEST):
        pose[part] += action[_TRUNK_PITCH]
        pose[part + 1] += action[_TRUNK_ROLL]
        pose[part + 2] += action[_TRUNK_YAW]
    if phase == FALL:
        _aim_legs(p, memory, state, pose)
    keep = 0.0
    if phase == FALL:
        keep = max(1.0 - memory[PHASE_TICKS] * CONTROL_DT / max(p[_TIMING + 3], CONTROL_DT), 0.0)
    for j in range(_N):
        if memory[SIDE] > 0.0:
            ctrl[j] = pose[j]
        else:
            ctrl[mirror[j]] = sign[j] * pose[j]
    for j in range(_N):
        ctrl[j] += keep * (memory[_FROM + j] - ctrl[j])
        state[layout.LAST_TARGET.start + j] = ctrl[j]
