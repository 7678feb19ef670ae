"""How the trunk moves with the stride: the back flexes and bends, hips and shoulders rise and roll, the head
nods.

All of it follows from the phases of the four legs, so it needs no gait of its own. A pair of legs half a
stride apart (walk, trot) does the same twice a stride, a pair that is nearly together (gallop) does it once;
while a gait changes, one becomes the other. The shares of the two add up to one, so that in no order of the
legs the trunk moves farther than in the gaits. What the gait adds are the ranges.

θ is the phase of a leg from the middle of its stance. A back is hollow where the hind legs have pushed off
and rounded before they land (Schilling and Hackert, "Sagittal spine movements of small therian mammals during
asymmetrical gaits", 2006); in the trot it sags in the middle of each stance (Audigié and others, "Kinematics
of the equine back: flexion-extension movements in sound trotting horses", 1999). A hip is lowest just before
its foot lands, highest near the end of its stance (Schaub and others, "Three-dimensional kinematics of the
pelvis and caudal lumbar spine in German Shepherd dogs", 2021).
"""

from __future__ import annotations

import math

from locomotion.quadruped import layout as at
from locomotion.quadruped.back import bend_back
from locomotion.quadruped.gait import eased, leg_phase, stride_rate
from locomotion.quadruped.idle import live_on, weight_shift
from surefoot.kernels import kernel

__all__ = ["move_trunk"]

_FULL = 0.35  # of √(g · hip height): the speed from which the ranges are whole
_HIGHEST = 0.84 * math.pi  # [rad] of the stride after touchdown at which a hip is highest
_STEEP = 0.25  # slope on which one hardly bounces any more: on stairs, lifted feet need the room
_AS_LEGS = 0.5  # of the rate of other changes of gait: ranges grow as legs find their order
_RUNS = 0.04  # duty by which a gait has to be off one half to be all walk or all run
_ROUNDED = 0.2  # share of the flexion in a gallop by which the back is rounded on average: it hollows less
_BREATH_BACK, _BREATH_LIFT = math.radians(0.7), 0.006  # [rad]; share of the shoulders' height
_SWAY = 0.2  # of the distance of two feet, by which the weight is shifted at most
_LESS = 0.5  # of that and of the roll, at the shoulders


@kernel
def _ease_ranges(st, pr, gait, runs):
    speed = st[at.SPEED]
    share = min(speed / (_FULL * math.sqrt(9.81 * pr[at.HEIGHT_REAR])), 1.0)
    rate = _AS_LEGS * stride_rate(st)
    slope = (st[at.GROUND_FRONT] - st[at.GROUND_REAR]) / (_STEEP * pr[at.BONES] * pr[at.BONE])
    bounce = share * math.exp(-slope * slope)
    st[at.BOB_NOW] = eased(st[at.BOB_NOW], bounce * gait[at.BOB] * (1.0 - 2.0 * runs), rate)
    st[at.ROCK_NOW] = eased(st[at.ROCK_NOW], bounce * gait[at.ROCK], rate)
    flexion = gait[at.FLEXION] + gait[at.FLEXION_SLOPE] * speed
    st[at.FLEXION_NOW] = eased(st[at.FLEXION_NOW], share * flexion, rate)
    for k in range(5):  # the columns are in the same order
        st[at.UNDULATION_NOW + k] = eased(st[at.UNDULATION_NOW + k], share * gait[at.UNDULATION + k], rate)


@kernel
def _pair(st, leg, duty):
    """Of legs ``leg`` and the next: cos θ and sin θ of the pair, as far as the two are together; cos 2θ of
    the pair; differences, left less right, of cosines at touchdown and of heights of the hip; how much they
    are together, 0 to 1. A tenth of a stride apart is hardly less than together."""
    first, shift = math.pi * duty, 2.0 * math.pi
    a, b = shift * leg_phase(st, leg) - first, shift * leg_phase(st, leg + 1) - first
    ca, sa, cb, sb = math.cos(a), math.sin(a), math.cos(b), math.sin(b)
    c, s = 0.5 * (ca + cb), 0.5 * (sa + sb)
    near = math.sqrt(c * c + s * s)
    together = math.sin(0.5 * math.pi * near)
    once = together / max(near, 1e-9)
    dc, ds = 0.5 * (ca - cb), 0.5 * (sa - sb)
    cf, sf = math.cos(first), math.sin(first)
    ch, sh = math.cos(first - _HIGHEST), math.sin(first - _HIGHEST)
    return (
        once * c, once * s, ca * ca + cb * cb - 1.0, dc * cf - ds * sf, dc * ch - ds * sh, together,
    )  # fmt: skip


@kernel
def move_trunk(st, pr, gait):
    """One tick: write how the trunk is to be carried now."""
    rate = stride_rate(st)
    st[at.STANDS_FRONT] = eased(st[at.STANDS_FRONT], st[at.DUTY_FRONT_NOW], rate)
    st[at.STANDS_REAR] = eased(st[at.STANDS_REAR], st[at.DUTY_REAR_NOW], rate)
    off = (st[at.STANDS_FRONT] + st[at.STANDS_REAR] - 1.0) / (2.0 * _RUNS)
    runs = 0.5 - 0.5 * min(max(off, -1.0), 1.0)
    _ease_ranges(st, pr, gait, runs)
    live_on(st, pr)
    c, s, twice, ahead, high, together = _pair(st, 2, st[at.STANDS_REAR])
    fore_c, _, fore_twice, fore_ahead, fore_high, fore_together = _pair(st, 0, st[at.STANDS_FRONT])
    # a runner bounces as a whole, whatever its feet do; a walker vaults over each pair of legs by itself
    both, apart = 0.5 * (fore_twice + twice), 0.5 * (1.0 - runs) * (fore_twice - twice)
    bounce = st[at.BOB_NOW] * (1.0 - together) * (1.0 - fore_together)
    breath = st[at.IDLE] * math.sin(2.0 * math.pi * st[at.BREATH])
    rear, front = weight_shift(st, pr, False), weight_shift(st, pr, True)
    flexed = _ROUNDED * together - 0.5 * (s + (1.0 - together) * twice)
    st[at.BACK] = st[at.FLEXION_NOW] * flexed + _BREATH_BACK * breath
    st[at.SIDE_BEND] = 0.25 * st[at.UNDULATION_NOW] * (ahead - fore_ahead)
    st[at.ROLL_REAR] = 0.5 * st[at.HIP_ROLL_NOW] * high + pr[at.SWAY] * rear
    st[at.ROLL_FRONT] = 0.5 * st[at.SHOULDER_ROLL_NOW] * fore_high + _LESS * pr[at.SWAY] * front
    st[at.SWAY_REAR] = _SWAY * pr[at.WIDTH_REAR] * rear
    st[at.SWAY_FRONT] = _LESS * _SWAY * pr[at.WIDTH_FRONT] * front
    st[at.LIFT_REAR] = bounce * (both - apart) - st[at.ROCK_NOW] * c
    st[at.LIFT_FRONT] = bounce * (both + apart) - st[at.ROCK_NOW] * fore_c
    st[at.LIFT_FRONT] += _BREATH_LIFT * pr[at.HEIGHT_FRONT] * breath
    st[at.NECK_DIP] = st[at.LOWER_NOW] + 0.5 * st[at.NOD_NOW] * (fore_c + (1.0 - fore_together) * fore_twice)
    bend_back(st, pr)
