"""The tail: three bones, each on a damped spring behind the one before, the first behind the pelvis."""

from __future__ import annotations

import math

from locomotion.quadruped import layout as at
from locomotion.quadruped.body_on_path import wrap
from locomotion.quadruped.idle import tail_sway
from locomotion.quadruped.motion import DT
from surefoot.kernels import kernel

__all__ = ["hang_tail", "swing_tail"]

_CURVE = 0.18  # [rad] by which each bone points higher than the one before
_ALONG = 0.6  # of the angle between two spine bones, by which each bone goes on with a bend
_STIFF, _DAMPING = 2.2, 0.35  # frequency, relative to that of a weight on a string as long; share of critical
_HELD, _HELD_DAMPING = 6.6, 0.6  # the same up and down, where it is held: in a gallop it goes with the pelvis


@kernel
def hang_tail(st, pr):
    """Put the tail where it comes to rest."""
    up = pr[at.TAIL_RISE] - st[at.PITCH]
    for k in range(3):
        up += _CURVE
        st[at.TAIL_YAW + k], st[at.TAIL_UP + k] = _ALONG * (k + 1.0) * st[at.BEND], up
        st[at.TAIL_YAW + 3 + k], st[at.TAIL_UP + 3 + k] = 0.0, 0.0
    st[at.PELVIS_YAW] = st[at.YAW]


@kernel
def swing_tail(st, pr, yaw, pitch):
    """One tick behind a pelvis of direction ``yaw`` and tilt ``pitch`` [rad]."""
    swings = math.sqrt(9.81 / (3.0 * pr[at.TAIL]))
    turned = wrap(yaw - st[at.PELVIS_YAW])
    st[at.PELVIS_YAW] = yaw
    aside, up = tail_sway(st, pr), pr[at.TAIL_RISE] - pitch
    for k in range(3):
        aside, up = aside + _ALONG * st[at.BEND], up + _CURVE
        own = at.TAIL_YAW + k
        st[own] -= turned
        st[own], st[own + 3] = _pulled(st[own], st[own + 3], aside, _STIFF * swings, _DAMPING)
        aside = st[own]
        own = at.TAIL_UP + k
        st[own], st[own + 3] = _pulled(st[own], st[own + 3], up, _HELD * swings, _HELD_DAMPING)
        up = st[own]


@kernel(forceinline=True)
def _pulled(angle, rate, to, stiff, damping):
    rate += DT * stiff * (stiff * (to - angle) - 2.0 * damping * rate)
    return angle + DT * rate, rate
