"""Getting up after a fall, as far as hands and feet (numba).

Each tick of 10 ms calls `get_up_tick` while `MODE` is below `BORNE`; from then on `scrambling.scramble_tick`
supports the body. The figure protects itself as it falls (`bracing`), rolls onto its front over the nearer
side, reaches out with its arms, draws its legs up, and pushes itself up. One that sinks down from hands and
feet goes limp until it lies still. No posture is assumed: each phase ends when its result is observed, and a
body that does not get onto its front goes limp, too, and tries the other side. Where it is steep, one on its
front first turns its head uphill (`pivoting`).
"""

import math

import numpy as np

from locomotion.body.person import CONTROL_DT
from locomotion.recovery.bracing import begin_to_brace, brace
from locomotion.recovery.layout import (
    ALL_DOWN,
    BEGUN_FROM,
    BORNE,
    BRACING,
    CLOCK,
    DOWN,
    FACING,
    LIMP,
    LOADS,
    MODE,
    MODE_CLOCK,
    PHASE,
    PIVOTING,
    REACHING,
    RISEN,
    ROLL_SIDE,
    ROLLING,
    SEEN_COM,
    SEEN_FORCES,
    SEEN_LIMBS,
    SEEN_TURN,
    SEEN_VELOCITY,
    TICKS,
    TRIES,
    TUCKING,
    TURNING,
)  # fmt: skip
from locomotion.recovery.pivoting import PIVOTS, ROUND, SPREAD, begin_round, off_uphill, pivot
from locomotion.recovery.postures import mirrored, move, posture
from locomotion.recovery.scrambling import lie_of
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["bear_on", "begin_getting_up", "begin_to_fall", "get_up_tick", "lies_on_front", "rise_on"]

_TURN_MOST = 5.0  # [s] after which it gets up as it lies
_STILL, _LIMP_LEAST, _LIMP_MOST = 0.4, 0.2, 1.5  # [m/s], [s]
_SLIDES_MOST = 4.0  # [s] for which it waits, spread out, until it does not slide any more
_LIES, _BRACE_LEAST = 1.0, 0.4  # [m/s], [s] for a body that braces: it may roll over while it still slides
_GATHER_TIME, _SWING_TIME, _FOLLOW_TIME = 0.2, 0.33, 0.4  # [s]
_REACH_TIME, _SETTLE_TIME, _TUCK_TIME, _RISE_TIME = 0.35, 0.1, 0.7, 0.7  # [s]
_ROLLS, _SPREAD_TIME = 0.4, 0.3  # slope on which a limp body rolls down; [s]
_STEADY, _BEARS, _STEADY_MOST = 0.15, 20.0, 8.0  # [m/s], [N] of each limb: it has come to rest on them; [s]
_LOOKS = 4.0  # ticks after which it looks again whether it has tipped over
_NEARLY = 0.98  # share of its height to which it comes before that
_SUNK = 0.3  # [m] of the centre of mass above a foot, below which it does not rise any more
_ON_FRONT, _OFF_FRONT = (
    -0.5,
    0.1,
)  # upward share of the body's forward axis: lies on its front; does not any more


# over the right side: arched, arms overhead, the left leg swings across; then the left arm follows
_SWING_OVER = posture(
    waist_pitch=-25, waist_roll=-25, waist_yaw=3, chest_pitch=-18, chest_roll=-20, chest_yaw=35,
    right_shoulder_flexion=171, right_shoulder_abduction=-24, right_shoulder_rotation=-39,
    right_elbow_flexion=7, left_shoulder_flexion=179, left_shoulder_abduction=10,
    left_shoulder_rotation=-29, left_elbow_flexion=9, right_hip_flexion=-24, right_hip_abduction=-30,
    right_hip_rotation=-40, right_knee_flexion=92, right_ankle_flexion=30, left_hip_flexion=125,
    left_hip_abduction=-30, left_hip_rotation=26, left_knee_flexion=-2, left_ankle_flexion=-40,
)  # fmt: skip
_FOLLOW_OVER = posture(
    waist_pitch=-24, waist_roll=7, waist_yaw=-30, chest_pitch=-20, chest_roll=6, chest_yaw=-33,
    right_shoulder_flexion=180, right_shoulder_abduction=6, right_shoulder_rotation=-49,
    right_elbow_flexion=4, left_shoulder_flexion=67, left_shoulder_abduction=-22, left_shoulder_rotation=41,
    left_elbow_flexion=2, right_hip_flexion=-22, right_hip_abduction=-3, right_hip_rotation=45,
    right_knee_flexion=92, right_ankle_flexion=-50, left_hip_flexion=14, left_hip_abduction=45,
    left_hip_rotation=-23, left_knee_flexion=146, left_ankle_flexion=-9,
)  # fmt: skip
# the same where it is steep: it does not roll on, and down
_SWING_STEEP = posture(
    waist_pitch=2, waist_roll=-25, waist_yaw=-30, chest_pitch=-20, chest_roll=-20, chest_yaw=35,
    right_shoulder_flexion=180, right_shoulder_abduction=-30, right_shoulder_rotation=-44,
    left_shoulder_flexion=180, left_shoulder_abduction=-3, left_shoulder_rotation=-49,
    left_elbow_flexion=41, right_hip_flexion=-26, right_hip_abduction=-30, right_hip_rotation=-40,
    right_knee_flexion=5, right_ankle_flexion=30, left_hip_flexion=125, left_hip_abduction=-14,
    left_hip_rotation=45, left_knee_flexion=-2, left_ankle_flexion=-40,
)  # fmt: skip
_FOLLOW_STEEP = posture(
    waist_pitch=-25, waist_roll=25, waist_yaw=17, chest_pitch=-20, chest_roll=-7, chest_yaw=-35,
    right_shoulder_flexion=180, right_shoulder_abduction=11, right_shoulder_rotation=-35,
    right_elbow_flexion=60, left_shoulder_flexion=60, left_shoulder_abduction=23,
    left_shoulder_rotation=-56, left_elbow_flexion=11, right_hip_flexion=-2, right_hip_abduction=-30,
    right_hip_rotation=45, right_knee_flexion=28, right_ankle_flexion=-50, left_hip_flexion=21,
    left_hip_abduction=45, left_hip_rotation=-40, left_knee_flexion=79, left_ankle_flexion=-9,
)  # fmt: skip
_GATHERED = posture(
    waist_pitch=9, chest_pitch=3, shoulder_flexion=-1, shoulder_abduction=11, shoulder_rotation=1,
    elbow_flexion=10, hip_flexion=6, hip_abduction=-3, hip_rotation=-12, knee_flexion=-2, ankle_flexion=-1,
)  # fmt: skip
_TUCK = posture(
    shoulder_flexion=0, shoulder_abduction=65, shoulder_rotation=-20, elbow_flexion=105, hip_flexion=115,
    hip_abduction=40, knee_flexion=135, ankle_flexion=20, toe_extension=40, neck_pitch=-20,
)  # fmt: skip
_TUCK_STEEP = posture(
    shoulder_flexion=20, shoulder_abduction=65, shoulder_rotation=-20, elbow_flexion=105, hip_flexion=60,
    hip_abduction=40, knee_flexion=90, ankle_flexion=20, toe_extension=40, neck_pitch=-20,
)  # fmt: skip


_OVER = np.array(
    [
        [[swing, follow], [mirrored(swing), mirrored(follow)]]
        for swing, follow in ((_SWING_OVER, _FOLLOW_OVER), (_SWING_STEEP, _FOLLOW_STEEP))
    ]
)


@allocating_kernel
def lies_on_front(ground, memory):
    """How far the body's forward axis points away from the ground, -1 (on its front) to 1 (on its back), and
    how far its left side does."""
    com = memory[SEEN_COM]
    gradient = np.empty(2)
    lie_of(ground, com[0], com[1], com[2] - 0.2, gradient)
    n = math.sqrt(1.0 + gradient[0] ** 2 + gradient[1] ** 2)
    turn = memory[SEEN_TURN]
    front = (turn[6] - gradient[0] * turn[0] - gradient[1] * turn[3]) / n
    left = (turn[7] - gradient[0] * turn[1] - gradient[1] * turn[4]) / n
    return front, left


@allocating_kernel
def steepness(ground, memory):
    """Slope [rise over run] of the ground around the body."""
    com, gradient = memory[SEEN_COM], np.empty(2)
    lie_of(ground, com[0], com[1], com[2] - 0.2, gradient)
    return math.hypot(gradient[0], gradient[1])


@allocating_kernel
def begin_to_fall(memory, qpos, qvel):
    """The body falls out of a stand, a walk or a run."""
    begin_getting_up(memory, qpos)
    memory[MODE] = BRACING
    begin_to_brace(memory, qvel)


@allocating_kernel
def begin_getting_up(memory, qpos):
    """The body has sunk down."""
    memory[BEGUN_FROM] = qpos[7:]
    memory[MODE], memory[MODE_CLOCK], memory[TRIES] = LIMP, 0.0, 0.0
    memory[RISEN] = 0.0


@allocating_kernel
def _go_on(memory, mode, angles):
    memory[MODE], memory[MODE_CLOCK] = mode, 0.0
    memory[BEGUN_FROM] = angles


@allocating_kernel
def get_up_tick(ground, memory, qpos, qvel, ctrl):
    """One control tick: advance ``memory``, write the PD targets ``ctrl`` (39,) [rad]."""
    memory[MODE_CLOCK] += CONTROL_DT
    clock, mode, begun = memory[MODE_CLOCK], memory[MODE], memory[BEGUN_FROM]
    v, steep = memory[SEEN_VELOCITY], steepness(ground, memory) > _ROLLS
    speed = math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    if mode <= LIMP:
        braces = mode == BRACING and not steep
        if braces:
            brace(memory, qvel, ctrl)
        elif steep:  # a body that spreads out does not roll down
            move(begun, SPREAD, clock / _SPREAD_TIME, ctrl)
        else:
            ctrl[:] = qpos[7:]
        least, still = (_BRACE_LEAST, _LIES) if braces else (_LIMP_LEAST, _STILL)
        if (speed < still and clock > least) or clock > (_SLIDES_MOST if steep else _LIMP_MOST):
            front, left = lies_on_front(ground, memory)
            # over the side that is down already; if that failed, over the other
            memory[ROLL_SIDE] = (
                (0.0 if left >= 0.0 else 1.0) if memory[TRIES] % 2.0 == 0.0 else 1.0 - memory[ROLL_SIDE]
            )
            _go_on(memory, REACHING if front < _ON_FRONT else ROLLING, qpos[7:])
    elif mode == ROLLING:
        # in a notch nobody gets over who does not dare to roll on: after a try to both sides it does
        tries = memory[TRIES] % 6.0
        careful = steep and tries < 2.0
        gathered = _TUCK if tries >= 4.0 else _GATHERED  # feet that are caught come free
        over = _OVER[1 if careful else 0, int(memory[ROLL_SIDE])]
        # arms and legs that are spread or bent keep it from rolling; where it is steep, from rolling down
        if not careful:
            clock -= _GATHER_TIME
        if clock <= 0.0:
            move(begun, gathered, 1.0 + clock / _GATHER_TIME, ctrl)
        elif clock <= _SWING_TIME:
            move(begun if careful else gathered, over[0], clock / _SWING_TIME, ctrl)
        else:
            move(over[0], over[1], (clock - _SWING_TIME) / _FOLLOW_TIME, ctrl)
        # on a steep slope the roll ends once the body lies on its front; it would go on downhill otherwise
        comes_over = steep and lies_on_front(ground, memory)[0] < _ON_FRONT
        if clock > _SWING_TIME + _FOLLOW_TIME or (comes_over and clock > _SWING_TIME):
            _go_on(memory, REACHING, ctrl)
    elif mode == REACHING:
        move(begun, SPREAD, clock / _REACH_TIME, ctrl)
        settles = steep and speed > _STILL and clock < _SLIDES_MOST
        if clock > _REACH_TIME + _SETTLE_TIME and not settles:
            if lies_on_front(ground, memory)[0] > _ON_FRONT:
                memory[TRIES] += 1.0
                _go_on(memory, LIMP, qpos[7:])
            else:
                _turn_or_tuck(ground, memory, steep, 0.0)
    elif mode == PIVOTING:
        pivot(memory, ctrl)
        if lies_on_front(ground, memory)[0] > _OFF_FRONT:
            _go_on(memory, LIMP, qpos[7:])
        elif clock > CONTROL_DT and clock % ROUND < CONTROL_DT:
            _turn_or_tuck(ground, memory, steep, clock)
    else:
        # where it is steep, knees that come far up tip it over
        tuck = _TUCK_STEEP if steep else _TUCK
        move(begun, tuck, clock / _TUCK_TIME, ctrl)
        if lies_on_front(ground, memory)[0] > _OFF_FRONT:
            _go_on(memory, LIMP, qpos[7:])
        elif clock > _TUCK_TIME:
            _go_on(memory, BORNE, tuck)
            bear_on(memory, 0.0)


@allocating_kernel
def _turn_or_tuck(ground, memory, steep, turned):
    """The body lies on its front, arms and legs spread, where it is ``steep`` or not, and has ``turned`` for
    so many seconds."""
    off = off_uphill(ground, memory)
    if not steep or abs(off) < PIVOTS or turned > _TURN_MOST:
        _go_on(memory, TUCKING, SPREAD)
        return
    begin_round(memory, off)
    if turned == 0.0:
        _go_on(memory, PIVOTING, SPREAD)


@kernel
def bear_on(memory, risen):
    """From the next tick on hands and feet bear the body, where they are; ``risen``: share of its height."""
    turn = memory[SEEN_TURN]
    memory[MODE], memory[MODE_CLOCK], memory[RISEN] = BORNE, 0.0, risen
    memory[FACING] = math.atan2(turn[3] + turn[5], turn[0] + turn[2])
    memory[TURNING] = memory[TICKS] = memory[CLOCK] = 0.0
    memory[PHASE] = ALL_DOWN
    memory[DOWN] = 1.0
    memory[LOADS] = risen


@kernel
def rise_on(ground, memory, qpos, to_stand):
    """Every tick of a body that hands or feet bear, after what was observed: the trunk comes up; a body that
    has tipped over, or sunk while it rose, begins anew. One that goes on on hands and feet, and does not rise
    ``to_stand``, first comes to rest on all four: else every third falls again at once."""
    if memory[MODE] == BORNE:
        memory[MODE_CLOCK] += CONTROL_DT
        v = memory[SEEN_VELOCITY]
        steady = memory[PHASE] == ALL_DOWN and math.hypot(v[0], v[1]) < _STEADY
        for k in range(4):
            steady = steady and memory[SEEN_FORCES.start + k] > _BEARS
        most = 1.0 if to_stand or steady or memory[MODE_CLOCK] > _STEADY_MOST else _NEARLY
        memory[RISEN] = max(memory[RISEN], min(memory[RISEN] + CONTROL_DT / _RISE_TIME, most))
        looks = memory[TICKS] % _LOOKS == 0.0
        if looks and lies_on_front(ground, memory)[0] > _OFF_FRONT:
            begin_getting_up(memory, qpos)
    elif memory[SEEN_COM.start + 2] - memory[SEEN_LIMBS.start + 8] < _SUNK:
        begin_getting_up(memory, qpos)
