"""Scrambling on hands and feet over steep ground (numba).

Each control tick of 10 ms: `scramble_tick`, physics, `observe_scramble`.

The body faces uphill where it is steep and ahead where it is not, and moves in any direction at a trot: one
hand and the opposite foot swing while the others carry. No posture is played back or remembered: each tick,
the wanted place of the trunk follows from where hands and feet are (`_posture`); limbs that carry get the
angles that would put the trunk there, plus the torques of vertical forces under hands and feet that carry the
weight (`bear`). A hand that slips is simply somewhere else at the next tick. The trunk may touch the ground.
"""

import math

import mujoco
import numpy as np

from locomotion.body.arm_reach import reach
from locomotion.body.person import CONTROL_DT
from locomotion.gaits.walk.footholds import ground_at
from locomotion.gaits.walk.layout import clamp, wrap
from locomotion.ground.ground import height_below
from locomotion.paths.command import ALONG_ASKED, HEADING_ASKED, SPEED_ASKED
from locomotion.recovery.layout import (
    AIR,
    ALL_DOWN,
    CENTRE,
    CLOCK,
    DOWN,
    FACING,
    GATHERING,
    GATHERS,
    HOLDS,
    LIE_AHEAD,
    LIE_HERE,
    LIFT,
    LOADS,
    PAIR,
    PHASE,
    RISEN,
    SEEN_BASE,
    SEEN_COM,
    SEEN_FORCES,
    SEEN_LIMBS,
    SEEN_TURN,
    SEEN_VELOCITY,
    SPOT,
    STANCE,
    SWINGING,
    TICKS,
    TURNING,
    new_scramble,
)  # fmt: skip
from locomotion.recovery.limbs import (
    ARMS,
    HIGHEST,
    LEGS,
    LOWEST,
    STIFFNESS,
    SWIVEL,
    WAIST_CHEST_NECK,
    attitude,
    bear,
    leg_angles,
    turned,
)  # fmt: skip
from locomotion.recovery.senses import Parts, observe_scramble
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["crouch", "scramble_tick", "steeper"]

_HAND_AHEAD, _HAND_OUT, _FOOT_BEHIND, _FOOT_SLOPE, _FOOT_OUT, _HEIGHT, _HEIGHT_SLOPE, _ARM = range(8)
_SWING, _PAUSE, _CLEARANCE, _BRAKE, _TIPPING, _ROLL, _CURVE = range(8, 15)
_R_HIP, _L_HIP = LEGS
_R_ARM, _L_ARM = ARMS
_WAIST, _CHEST, _NECK = WAIST_CHEST_NECK
_RADIUS = np.array([0.028, 0.028, 0.024, 0.024])  # [m] of the limbs' ends
_SHOULDER_OUT, _TRUNK = 0.17, 0.485  # [m] from the middle; from the hips to the shoulders
_BELOW = 1.2  # share of the spine's bend by which the pelvis leans less than the trunk as a whole
_UPHILL = 0.12  # slope that counts as much as the way in where to face
_COMING = 0.3  # [m] ahead where it looks how the ground lies, too
_LOOKS = 5.0  # ticks after which it does so again: less than 1 cm later
_TURN_RATE = 0.7  # [rad/s]
_NEARER = (1.0, 0.7, 0.4)  # of its way out, tried in turn for a limb that finds no ground
_AROUND = 0.6  # [m] around the body that tells how the ground lies
_RING = _AROUND * np.stack([np.cos(0.25 * np.pi * np.arange(4)), np.sin(0.25 * np.pi * np.arange(4))], axis=1)
_LEAD = 0.1  # [s] servo damping per stiffness
_LONGEST_LEG = 0.80  # [m]
_AIM_AHEAD, _ACROSS = 0.05, 0.75  # [s] by which swings lead; share of a swing after which only height changes
_UNLOAD = 0.05  # [s] before it is lifted in which a limb is unloaded
_LOST = 0.015  # [s] off the ground after which a limb counts as in the air
_FEEL, _FEEL_MOST = 0.4, 0.12  # [m/s], [m] at which and how far such a limb reaches down
_TURNS = 0.05  # [rad/s] from which on its limbs step even where it does not go on
_GOES_ON, _TURNS_FIRST = 0.3, 0.8  # [rad] off where it is to face, up to which it goes on, and does at all
_FALLS = 0.18  # [s] in which a body tips over as far as its speed takes it
_OVER, _OVER_TURNING, _TIPS = 0.08, 0.05, 0.2
# [m] beside the line between hand and foot: they bear it for a swing; the same while it turns; it tips over
_SHIFT, _WAITS = 0.4, 0.4  # [m/s] at which it comes over that line; [s] for which it tries
_STRAY = 0.08  # [m] that the centre of mass may be from where it is to be


@kernel
def _height_at(ground, x, y, z):
    """Height of the ground at (x, y), about ``z``; NaN where there is none."""
    rows, cell_start, cell_triangles, grid, shape, origin = ground
    px, py, pz = x - origin[0], y - origin[1], z + 1.0 - origin[2]
    h = height_below(rows, cell_start, cell_triangles, grid, shape, px, py, pz)[0] + origin[2]
    return h if abs(h - z) < 1.5 else np.nan


@allocating_kernel
def lie_of(ground, x, y, z, out):
    """Gradient (2,) of the ground around (x, y, z)."""
    out[:] = 0.0
    n = 0
    for k in range(4):
        dx, dy, apart = _RING[k, 0], _RING[k, 1], 2.0 * _AROUND
        h, o = _height_at(ground, x + dx, y + dy, z), _height_at(ground, x - dx, y - dy, z)
        if h != h or o != o:  # beside a rim one side counts, or the ground would seem to fall along the rim
            middle, apart = _height_at(ground, x, y, z), _AROUND
            if h == h:
                o = middle
            else:
                h = middle
        if h == h and o == o:
            out[0] += (h - o) * dx / (apart * _AROUND)
            out[1] += (h - o) * dy / (apart * _AROUND)
            n += 1
    if n > 0:
        out *= 2.0 / n


@allocating_kernel
def steeper(ground, points, slope):
    """Whether the ground around any of ``points`` (n, 3) is steeper than ``slope`` [rise over run]."""
    gradient = np.empty(2)
    for p in range(points.shape[0]):
        lie_of(ground, points[p, 0], points[p, 1], points[p, 2], gradient)
        if math.hypot(gradient[0], gradient[1]) > slope:
            return True
    return False


@kernel
def _home(ground, p, k, x, y, z, facing, slope, out):
    """Where limb ``k`` is at home under a centre of mass over (x, y): ``out`` (3,). It comes nearer to the
    body where there is no ground."""
    side = -1.0 if k % 2 == 0 else 1.0
    if k < 2:
        u, v = p[_HAND_AHEAD], side * p[_HAND_OUT]
    else:
        u, v = -p[_FOOT_BEHIND] + p[_FOOT_SLOPE] * clamp(slope, 0.0, 1.0), side * p[_FOOT_OUT]
    ch, sh = math.cos(facing), math.sin(facing)
    for share in _NEARER:
        out[0], out[1] = x + share * (ch * u - sh * v), y + share * (sh * u + ch * v)
        if _settle(ground, k, z, out):
            break


@kernel
def _settle(ground, k, z, out):
    """Lower limb ``k`` at ``out`` (3,) onto the ground, or to about ``z`` where there is none; return whether
    there is."""
    h, _, _, n2 = ground_at(ground, out[0], out[1], z + 1.0)
    there = h == h and abs(h - z) < 1.2
    out[2] = (h if there else z) + _RADIUS[k] / max(n2, 0.4)
    return there


@kernel
def _comes_over(memory, hand, foot, vx, vy):
    """Whether the body is over the line between the ``hand`` and the ``foot`` (3,) that are to bear it for a
    swing, so that it does not tip over meanwhile, or must not wait any longer. Else moves its wanted place
    there. (vx, vy) [m/s]: of its way."""
    com, velocity, half = memory[SEEN_COM], memory[SEEN_VELOCITY], 0.5 * memory[STANCE.start + _SWING]
    nx, ny = foot[1] - hand[1], hand[0] - foot[0]
    length = max(math.hypot(nx, ny), 0.1)
    nx, ny = nx / length, ny / length
    x = com[0] + half * vx + _FALLS * (velocity[0] - vx) - hand[0]
    y = com[1] + half * vy + _FALLS * (velocity[1] - vy) - hand[1]
    off = nx * x + ny * y
    over = abs(off) < (_OVER_TURNING if abs(memory[TURNING]) > _TURNS else _OVER)
    if over or abs(off) > _TIPS or memory[CLOCK] > _WAITS:
        return True
    move = clamp(off, -_SHIFT * CONTROL_DT, _SHIFT * CONTROL_DT)
    memory[CENTRE.start] -= move * nx
    memory[CENTRE.start + 1] -= move * ny
    return False


@allocating_kernel
def _gait(ground, memory, command, gradient, slope):
    """Which limbs are in the air, and where they are to land."""
    p = memory[STANCE]
    memory[CLOCK] += CONTROL_DT
    seen, lift, spot = (
        memory[SEEN_LIMBS].reshape(4, 3),
        memory[LIFT].reshape(4, 3),
        memory[SPOT].reshape(4, 3),
    )
    com, velocity, facing = memory[SEEN_COM], memory[SEEN_VELOCITY], memory[FACING]
    low = seen[:, 2].mean()
    vx, vy = (
        command[SPEED_ASKED] * math.cos(command[HEADING_ASKED]),
        command[SPEED_ASKED] * math.sin(command[HEADING_ASKED]),
    )
    period = p[_SWING] + p[_PAUSE]
    home = np.empty(3)
    lifting = -1
    # hands stay where they are while the feet come under the body
    first = 2 if 0.0 < memory[GATHERING] < GATHERS else 0
    if memory[PHASE] == ALL_DOWN:
        late = abs(command[SPEED_ASKED]) > 0.02
        for k in range(first, 4):
            _home(ground, p, k, memory[CENTRE.start], memory[CENTRE.start + 1], low, facing, slope, home)
            late = late or math.hypot(home[0] - seen[k, 0], home[1] - seen[k, 1]) > 0.12
        late = (late or abs(memory[TURNING]) > _TURNS) and memory[RISEN] > 0.6
        a = int(1.0 - memory[PAIR])
        balances = late and first == 0 and memory[RISEN] >= 1.0
        over = not balances or _comes_over(memory, seen[1 - a], seen[2 + a], vx, vy)
        if late and over and memory[CLOCK] >= p[_PAUSE] - _UNLOAD:
            lifting = a
        if lifting >= 0 and memory[LOADS.start + (a if first == 0 else 3 - a)] < 0.3:
            memory[PHASE], memory[CLOCK], memory[PAIR] = SWINGING, 0.0, a
            for k in (a, 3 - a):
                if k >= first:
                    memory[DOWN.start + k] = 0.0
                    lift[k] = seen[k]
    if memory[PHASE] == SWINGING:
        a = int(memory[PAIR])
        left = max(p[_SWING] - memory[CLOCK], 0.0)
        down = True
        for k in (a, 3 - a):
            if memory[DOWN.start + k] > 0.0:
                continue
            if memory[CLOCK] < 0.8 * p[_SWING]:
                # where the body is half a stance later, and further where it is too fast
                x = com[0] + velocity[0] * left + 0.5 * period * vx + p[_TIPPING] * (velocity[0] - vx)
                y = com[1] + velocity[1] * left + 0.5 * period * vy + p[_TIPPING] * (velocity[1] - vy)
                _home(ground, p, k, x, y, low, facing + 0.5 * period * memory[TURNING], slope, home)
                spot[k] = home
            if memory[CLOCK] > _ACROSS * p[_SWING] and memory[SEEN_FORCES.start + k] > 10.0:
                memory[DOWN.start + k] = 1.0
            else:
                down = False
        if down or memory[CLOCK] > p[_SWING] + 0.25:
            memory[DOWN] = 1.0
            memory[PHASE], memory[CLOCK] = ALL_DOWN, 0.0
    for k in range(4):
        want = memory[DOWN.start + k]
        if memory[AIR.start + k] > _LOST or (
            lifting >= 0 and k >= first and (k == lifting or k == 3 - lifting)
        ):
            want = 0.0
        memory[LOADS.start + k] += clamp(want - memory[LOADS.start + k], -0.2, 0.15)


@kernel
def _posture(memory, slope, across, command, limbs, qref):
    """Where the trunk is to be: writes the place and rotation of the pelvis into ``qref`` (46,).

    limbs (4, 3): where hands and feet are, those in the air on the straight line to their spots."""
    p = memory[STANCE]
    com, base, velocity = memory[SEEN_COM], memory[SEEN_BASE], memory[SEEN_VELOCITY]
    ch, sh = math.cos(memory[FACING]), math.sin(memory[FACING])
    vx, vy = (
        command[SPEED_ASKED] * math.cos(command[HEADING_ASKED]),
        command[SPEED_ASKED] * math.sin(command[HEADING_ASKED]),
    )
    x = memory[CENTRE.start] - (com[0] - base[0]) + _LEAD * vx + p[_BRAKE] * (vx - velocity[0])
    y = memory[CENTRE.start + 1] - (com[1] - base[1]) + _LEAD * vy + p[_BRAKE] * (vy - velocity[1])
    steep = clamp(slope, 0.0, 1.0)
    height = p[_HEIGHT] + p[_HEIGHT_SLOPE] * steep
    z = 0.5 * (limbs[2, 2] + limbs[3, 2]) + height
    for k in range(2, 4):
        away = (limbs[k, 0] - x) ** 2 + (limbs[k, 1] - y) ** 2
        z = min(z, limbs[k, 2] + math.sqrt(max(_LONGEST_LEG**2 - away, 0.01)))
    z = base[2] + memory[RISEN] * (z - base[2])
    # the shoulders at arm's length from the hands
    hx = 0.5 * (limbs[0, 0] + limbs[1, 0]) - x
    hy = 0.5 * (limbs[0, 1] + limbs[1, 1]) - y
    ahead, up = ch * hx + sh * hy, 0.5 * (limbs[0, 2] + limbs[1, 2]) - z
    d = max(math.hypot(ahead, up), 0.1)
    wide = 0.5 * abs(-sh * (limbs[1, 0] - limbs[0, 0]) + ch * (limbs[1, 1] - limbs[0, 1]))
    out = clamp(wide - _SHOULDER_OUT, 0.0, 0.4)  # hands are farther apart than shoulders
    arm = math.sqrt(p[_ARM] ** 2 - out * out)
    between = (_TRUNK**2 + d * d - arm * arm) / (2.0 * _TRUNK * d)
    lean = math.atan2(ahead, up) - math.acos(clamp(between, -1.0, 1.0))
    lean = clamp(lean, -0.1, 1.75) - _BELOW * p[_CURVE]
    roll = clamp(-p[_ROLL] * across, -0.3, 0.3)
    # a body that is still rising begins from where it is
    turn, rest = memory[SEEN_TURN], 1.0 - memory[RISEN]
    if rest > 0.0:
        lean += rest * (math.atan2(ch * turn[2] + sh * turn[5], turn[8]) - lean)
        roll += rest * (math.asin(clamp(turn[7], -1.0, 1.0)) - roll)
    qref[0], qref[1], qref[2] = x, y, z
    attitude(memory[FACING], lean, roll, qref)


@allocating_kernel
def scramble_tick(ground, memory, command, qpos, qvel, ctrl):
    """One control tick: advance ``memory`` (SCRAMBLE_SIZE,), write the PD targets ``ctrl`` (39,) [rad].

    ground as in `footholds.ground_at`; command (4,): direction [rad] and speed [m/s] of the way, least
    weight of the way (a slope) in where to face; all float64.
    """
    p = memory[STANCE]
    seen, lift, spot = (
        memory[SEEN_LIMBS].reshape(4, 3),
        memory[LIFT].reshape(4, 3),
        memory[SPOT].reshape(4, 3),
    )
    com = memory[SEEN_COM]
    gradient, ahead = memory[LIE_HERE], memory[LIE_AHEAD]
    wx, wy = math.cos(command[HEADING_ASKED]), math.sin(command[HEADING_ASKED])
    if memory[TICKS] % _LOOKS == 0.0:
        look = _COMING if command[SPEED_ASKED] > 0.0 else 0.0
        lie_of(ground, com[0], com[1], com[2] - 0.4, gradient)
        lie_of(ground, com[0] + look * wx, com[1] + look * wy, com[2] - 0.4, ahead)
    # where to face: by the ground that it is on and that it comes to
    along = max(_UPHILL, command[ALONG_ASKED])
    fx, fy = 0.5 * (gradient[0] + ahead[0]) + along * wx, 0.5 * (gradient[1] + ahead[1]) + along * wy
    off = wrap(math.atan2(fy, fx) - memory[FACING])
    if abs(off) > 2.6 and memory[TURNING] * off < 0.0:
        off = -off
    rate = clamp(1.5 * off, -_TURN_RATE, _TURN_RATE)
    memory[TURNING] += clamp(rate - memory[TURNING], -0.03, 0.03)
    # no further than the body follows
    turn = memory[SEEN_TURN].reshape(3, 3)
    ahead_x, ahead_y = turn[0, 0] + turn[0, 2], turn[1, 0] + turn[1, 2]
    behind = wrap(memory[FACING] - math.atan2(ahead_y, ahead_x))
    if not (abs(behind) > 0.4 and behind * memory[TURNING] > 0.0):
        memory[FACING] = wrap(memory[FACING] + memory[TURNING] * CONTROL_DT)
    ch, sh = math.cos(memory[FACING]), math.sin(memory[FACING])
    slope, across = gradient[0] * ch + gradient[1] * sh, -gradient[0] * sh + gradient[1] * ch
    # it turns before it goes on
    command = command.copy()
    command[SPEED_ASKED] *= clamp((_TURNS_FIRST - abs(off)) / (_TURNS_FIRST - _GOES_ON), 0.0, 1.0)
    vx, vy = (
        command[SPEED_ASKED] * math.cos(command[HEADING_ASKED]),
        command[SPEED_ASKED] * math.sin(command[HEADING_ASKED]),
    )
    memory[CENTRE.start] += vx * CONTROL_DT
    memory[CENTRE.start + 1] += vy * CONTROL_DT
    ox, oy = memory[CENTRE.start] - com[0], memory[CENTRE.start + 1] - com[1]
    o = math.hypot(ox, oy)
    if o > _STRAY or memory[TICKS] == 0.0:
        keep = _STRAY / max(o, _STRAY) if memory[TICKS] > 0.0 else 0.0
        memory[CENTRE.start], memory[CENTRE.start + 1] = com[0] + keep * ox, com[1] + keep * oy
    memory[TICKS] += 1.0
    holds = memory[HOLDS].reshape(4, 3)
    for k in range(4):
        if memory[SEEN_FORCES.start + k] > 2.0 or memory[TICKS] == 1.0:
            memory[AIR.start + k] = 0.0
            holds[k] = seen[k]
        else:
            memory[AIR.start + k] += CONTROL_DT
    _gait(ground, memory, command, gradient, slope)

    now = min(memory[CLOCK] / p[_SWING], 1.0)
    limbs = seen.copy()
    for k in range(4):
        if memory[DOWN.start + k] == 0.0:
            limbs[k] = lift[k] + now * (spot[k] - lift[k])
    qref = np.zeros(qpos.shape[0])
    _posture(memory, slope, across, command, limbs, qref)
    qref[7 + _WAIST] = qref[7 + _CHEST] = p[_CURVE]
    pelvis, angles, four = np.empty((3, 3)), np.empty(7), np.empty(4)
    turned(qref[3:7], pelvis)
    actual = np.empty((3, 3))
    turned(qpos[3:7], actual)
    torques = np.empty(39)
    bear(memory, limbs, np.zeros(2), torques)
    target = np.zeros(39)
    target[_WAIST] = target[_CHEST] = p[_CURVE]
    lean = math.atan2(ch * actual[0, 2] + sh * actual[1, 2], actual[2, 2])
    target[_NECK] = clamp(0.3 - lean, -0.8, 0.5)
    aim = np.empty(3)
    for k in range(4):
        side = -1.0 if k % 2 == 0 else 1.0
        flying = memory[DOWN.start + k] == 0.0
        if flying:
            # across first, then down
            u = min((memory[CLOCK] + _AIM_AHEAD) / p[_SWING], 1.0)
            w = min(u / _ACROSS, 1.0)
            move = w * w * (3.0 - 2.0 * w)
            bump = p[_CLEARANCE] * math.sin(math.pi * u)
            down = 0.01 * u + 0.5 * max(memory[CLOCK] - p[_SWING], 0.0)
            for i in range(3):
                aim[i] = lift[k, i] + move * (spot[k, i] - lift[k, i])
            aim[0] -= 0.7 * bump * gradient[0]
            aim[1] -= 0.7 * bump * gradient[1]
            aim[2] += bump - down
        else:
            # one that has lost the ground feels for it
            aim[:] = holds[k]
            aim[2] -= min(_FEEL * memory[AIR.start + k], _FEEL_MOST)
            flying = memory[AIR.start + k] > _LOST
        # a limb in the air is aimed from where the trunk is, one that bears moves the trunk
        frame = actual if flying else pelvis
        q = qpos if flying else qref
        if k < 2:
            reach(q, side, aim, SWIVEL, four)
            first = _R_ARM if k == 0 else _L_ARM
            target[first : first + 4] = four
        else:
            first = _R_HIP if k == 2 else _L_HIP
            pitch = -math.atan(clamp(slope, -0.8, 0.8))
            leg_angles(q, frame, aim, memory[FACING] + 0.1 * side, pitch, side, angles)
            target[first : first + 7] = angles
    for j in range(39):
        ctrl[j] = clamp(target[j], LOWEST[j], HIGHEST[j]) + torques[j] / STIFFNESS[j]


def crouch(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    parts: Parts,
    ground: tuple[np.ndarray, ...],
    memory: np.ndarray,
    position: np.ndarray,
    way: float,
) -> None:
    """Put the person on hands and feet over the ground point ``position`` (3,), about to go towards ``way``
    [rad]; fills ``memory``."""
    gradient = np.empty(2)
    lie_of(ground, *position, gradient)
    facing = math.atan2(gradient[1] + _UPHILL * math.sin(way), gradient[0] + _UPHILL * math.cos(way))
    memory[:] = new_scramble(facing)
    slope = gradient[0] * math.cos(facing) + gradient[1] * math.sin(facing)
    limbs = memory[SEEN_LIMBS].reshape(4, 3)
    mujoco.mj_resetData(model, data)
    data.qpos[:3] = position + np.array([0.0, 0.0, 0.6])
    data.qpos[3:7] = [math.cos(0.5 * facing), 0.0, 0.0, math.sin(0.5 * facing)]
    memory[CENTRE] = position[:2]
    for _ in range(8):
        mujoco.mj_forward(model, data)
        observe_scramble(parts, data, memory)
        for k in range(4):
            _home(ground, memory[STANCE], k, *position, facing, slope, limbs[k])
        _posture(memory, slope, 0.0, np.zeros(4), limbs, data.qpos)
        pelvis, angles, four = np.empty((3, 3)), np.empty(7), np.empty(4)
        turned(data.qpos[3:7], pelvis)
        for k, first in enumerate((_R_ARM, _L_ARM, _R_HIP, _L_HIP)):
            side = -1.0 if k % 2 == 0 else 1.0
            if k < 2:
                reach(data.qpos, side, limbs[k], SWIVEL, four)
                data.qpos[7 + first : 11 + first] = four
            else:
                leg_angles(data.qpos, pelvis, limbs[k], facing + 0.1 * side, -math.atan(slope), side, angles)
                data.qpos[7 + first : 14 + first] = angles
        data.qpos[7:] = np.clip(data.qpos[7:], LOWEST, HIGHEST)
    mujoco.mj_forward(model, data)
    observe_scramble(parts, data, memory)
