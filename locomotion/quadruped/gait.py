"""Which gait, and when each foot touches down in it."""

from __future__ import annotations

import math

from numba import njit

from locomotion.quadruped import layout as at
from locomotion.quadruped.motion import DT

__all__ = ["leg_phase", "step_gait"]

_HYSTERESIS = 0.12  # share of the speed of the change by which it must be missed to change back
_BLEND = math.exp(-DT * 0.69314718056 / 0.10)  # half of a change of gait in 0.10 s
_SHIFT = 0.5  # share of the clock's pace at which a touchdown moves within the stride at most
_SCRIPT_DUTY = 0.62
_FORESIGHT = (
    0.4  # [s] ahead for whose speed strides are quickened: a foot that stands now will be needed then
)
_SHORTER = 0.6  # [1/rad] of slope by which strides become shorter and quicker


@njit(cache=True, inline="always")
def _eased(now, goal):
    return goal + (now - goal) * _BLEND


@njit(cache=True)
def step_gait(st, pr, gaits, feet):
    """One tick: choose the gait by speed, ease its numbers into the row ``st``, turn the clock. When one gait
    gives way to another, a foot's touchdown moves within the stride only while that foot of ``feet`` (4,
    FOOT) stands: a paw ends its swing as it began it."""
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
    st[at.FREQUENCY_NOW] = _eased(st[at.FREQUENCY_NOW], frequency)
    st[at.DUTY_FRONT_NOW] = _eased(st[at.DUTY_FRONT_NOW], front)
    st[at.DUTY_REAR_NOW] = _eased(st[at.DUTY_REAR_NOW], rear)
    st[at.LIFT_NOW] = _eased(st[at.LIFT_NOW], gait[at.LIFT])
    st[at.BOB_NOW] = _eased(st[at.BOB_NOW], gait[at.BOB] * min(speed, 1.0))
    st[at.ROCK_NOW] = _eased(st[at.ROCK_NOW], gait[at.ROCK] * min(speed, 1.0))
    shift = _SHIFT * st[at.FREQUENCY_NOW] * DT
    for leg in range(4):
        if feet[leg, at.IN_SWING] == 0.0:
            k = at.TOUCHDOWN_NOW + leg
            off = gait[at.TOUCHDOWN + leg] - st[k]
            off -= math.floor(off + 0.5)
            st[k] += min(max(off, -shift), shift)
    if st[at.REST] == 0.0:
        st[at.CLOCK] += st[at.FREQUENCY_NOW] * DT
        st[at.CLOCK] -= math.floor(st[at.CLOCK])


@njit(cache=True, inline="always")
def leg_phase(st, leg):
    """Share of the stride since ``leg`` touched down, 0 to 1."""
    phase = st[at.CLOCK] - st[at.TOUCHDOWN_NOW + leg]
    return phase - math.floor(phase)
