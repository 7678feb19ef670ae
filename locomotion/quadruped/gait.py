"""The present gait, and when each foot touches down in it."""

from __future__ import annotations

import math

from locomotion.quadruped import layout as at
from locomotion.quadruped.motion import DT
from surefoot.kernels import kernel

__all__ = ["eased", "leg_phase", "seconds_for", "step_gait", "stride_rate", "swing_tempo"]

_HYSTERESIS = 0.12  # share of the speed of the change by which it must be missed to change back
_FADE = 0.25 / 0.69314718056  # strides: half of a change of the strides' frequency in a quarter of one
_HURRY = 0.5  # greatest share by which a standing foot runs ahead of the clock
_SOONER = 0.62  # of the stride: a foot that would have to come down later by more comes down sooner instead
_QUICKEST, _SLOWEST = 0.65, 1.6  # shares of its gait's own swing that a swing takes at least and at most
_SETS_OUT = 0.05  # of √(g · hip height): the speed up to which one sets out
_SCRIPT_DUTY = 0.62
_FORESIGHT = (
    0.4  # [s] ahead for whose speed strides are quickened: a foot that stands now will be needed then
)
_SHORTER = 0.6  # [1/rad] of slope by which strides become shorter and quicker


@kernel(forceinline=True)
def eased(now, goal, rate):
    """``now`` one tick nearer to ``goal``."""
    return goal + (now - goal) * math.exp(-rate * DT)


@kernel(forceinline=True)
def stride_rate(st):
    """[1/s] at which what belongs to a gait is eased into what belongs to the next."""
    return st[at.FREQUENCY_WISH] / _FADE


@kernel
def step_gait(st, pr, gaits, feet):
    """One tick: choose the gait by speed, ease its numbers into the row ``st``, turn the clock.

    When one gait gives way to another, each foot of ``feet`` (4, FOOT) finds its new place in the stride on
    its own. One that is to come down later takes longer for its swings; it never stands longer for that, as
    the trunk goes on over it. One that is to come down sooner stands shorter. Within a swing its tempo is
    even: a paw ends its swing as it began it."""
    speed = st[at.SPEED]
    now = int(st[at.GAIT_NOW])
    if st[at.GAIT_WISH] >= 0.0:
        now = int(st[at.GAIT_WISH])
    else:
        now = min(now, int(pr[at.AUTOMATIC]) - 1)
        while now + 1 < pr[at.AUTOMATIC] and speed > gaits[now, at.UP_TO]:
            now += 1
        while now > 0 and speed < (1.0 - _HYSTERESIS) * gaits[now - 1, at.UP_TO]:
            now -= 1
    st[at.GAIT_NOW] = now
    gait = gaits[now]
    on_the_spot = st[at.MODE] != at.ON_TRAIL or speed < 1e-3
    soon = speed + _FORESIGHT * max(st[at.PUSH], 0.0)
    frequency = gait[at.FREQUENCY] + gait[at.FREQUENCY_SLOPE] * soon
    front = gait[at.DUTY_FRONT] + gait[at.DUTY_FRONT_SLOPE] * speed
    rear = gait[at.DUTY_REAR] + gait[at.DUTY_REAR_SLOPE] * speed
    frequency *= 1.0 + _SHORTER * abs(st[at.PITCH])
    if on_the_spot:
        frequency, front, rear = pr[at.STEP_FREQUENCY], _SCRIPT_DUTY, _SCRIPT_DUTY
    st[at.FREQUENCY_WISH] = frequency
    rate = stride_rate(st)
    st[at.FREQUENCY_NOW] = eased(st[at.FREQUENCY_NOW], frequency, rate)
    st[at.DUTY_FRONT_NOW], st[at.DUTY_REAR_NOW] = front, rear
    st[at.LIFT_NOW] = eased(st[at.LIFT_NOW], gait[at.LIFT], rate)
    turn = st[at.FREQUENCY_NOW] * DT
    for leg in range(4):
        tempo = feet[leg, at.TEMPO]
        if feet[leg, at.IN_SWING] == 0.0:
            sooner = 1.0 - _late(st, gait, leg)
            tempo = 1.0 + min(_HURRY, sooner / turn) if sooner < 1.0 - _SOONER else 1.0
            if st[at.REST] > 0.0:
                feet[leg, at.STANCE] = st[at.DUTY_FRONT_NOW] if leg < 2 else st[at.DUTY_REAR_NOW]
        st[at.TOUCHDOWN_NOW + leg] += (1.0 - tempo) * turn
    if st[at.REST] == 0.0:
        st[at.CLOCK] += st[at.FREQUENCY_NOW] * DT
        st[at.CLOCK] -= math.floor(st[at.CLOCK])


@kernel(forceinline=True)
def leg_phase(st, leg):
    """Share of the stride since ``leg`` touched down, 0 to 1."""
    phase = st[at.CLOCK] - st[at.TOUCHDOWN_NOW + leg]
    return phase - math.floor(phase)


@kernel(forceinline=True)
def _late(st, gait, leg):
    """Share of the stride, 0 to 1, by which ``leg`` should come down later to be in the gait's order."""
    off = gait[at.TOUCHDOWN + leg] - st[at.TOUCHDOWN_NOW + leg]
    return off - math.floor(off)


@kernel
def swing_tempo(st, pr, gait, leg, duty):
    """How fast ``leg``, which leaves the ground now, goes on through its stride, against the clock: so that
    it comes down in its gait's order, or as near to that as a swing can be quick or slow. One that sets out
    is in no hurry."""
    left, late = 1.0 - leg_phase(st, leg), _late(st, gait, leg)
    wanted = left + late if late <= _SOONER else left + late - 1.0
    whole = 1.0 - duty
    sets_out = st[at.SPEED] < _SETS_OUT * math.sqrt(9.81 * pr[at.HEIGHT_REAR])
    return left / min(max(wanted, (1.0 if sets_out else _QUICKEST) * whole), _SLOWEST * whole)


@kernel
def seconds_for(st, strides):
    """[s] that the clock takes for ``strides``, while its frequency comes to what is wished."""
    now, wish = st[at.FREQUENCY_NOW], st[at.FREQUENCY_WISH]
    seconds = strides / wish
    for _ in range(4):
        faded = math.exp(-seconds * wish / _FADE)
        turned = wish * seconds + (now - wish) * (_FADE / wish) * (1.0 - faded)
        seconds += (strides - turned) / (wish + (now - wish) * faded)
    return seconds
