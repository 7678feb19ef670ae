"""What it takes to swing a leg: two links in the plane of its motion (numba).

The thigh hangs from the hip; the rest hangs from the knee as one body with a fixed ankle: a double pendulum,
whose torques follow from Lagrange's equations. Angles are forward from straight down; the hip is taken to
move at constant velocity.
"""

import math

from locomotion.body.anatomy import MASS, SHANK, SIDE_SEGMENTS, THIGH, TOE_JOINT
from surefoot.kernels import kernel

__all__ = ["STRAIGHT_LEG", "leg_momentum", "swing_torques"]

_GRAVITY = 9.81
_THIGH, _SHANK, _FOOT, _TOES = (SIDE_SEGMENTS[part] for part in ("thigh", "shank", "foot", "toes"))


def _below_knee() -> tuple[float, float, float]:
    """Of shank, foot and toes: first and second moment of mass about the knee [kg m, kg m^2], and by how much
    [rad] their centre is ahead of the shank's line."""
    ahead = down = second = 0.0
    toes_ahead, _, toes_up = TOE_JOINT
    for part, x, z in ((_SHANK, 0.0, 0.0), (_FOOT, 0.0, SHANK), (_TOES, toes_ahead, SHANK - toes_up)):
        x, z, mass = x + part.com[0], z - part.com[2], part.mass * MASS
        ahead, down = ahead + mass * x, down + mass * z
        second += mass * (x * x + z * z + part.gyration[1] ** 2)
    return math.hypot(ahead, down), second, math.atan2(ahead, down)


_LOWER_FIRST, _LOWER, _AHEAD = _below_knee()
_LOWER_MASS = MASS * (_SHANK.mass + _FOOT.mass + _TOES.mass)
_UPPER_FIRST = MASS * _THIGH.mass * -_THIGH.com[2] + _LOWER_MASS * THIGH
_UPPER = MASS * _THIGH.mass * (_THIGH.com[2] ** 2 + _THIGH.gyration[1] ** 2) + _LOWER_MASS * THIGH**2
_COUPLING = _LOWER_FIRST * THIGH
STRAIGHT_LEG = _UPPER + _LOWER + 2.0 * _COUPLING
"""[kg m^2] about the hip of a straight leg."""


@kernel
def swing_torques(thigh, shank, thigh_rate, shank_rate, thigh_change, shank_change):
    """Torques [Nm] forward about the hip and about the knee, for angles [rad] of thigh and shank, their rates
    [rad/s] and the changes of those [rad/s^2]."""
    between = thigh - shank - _AHEAD
    along, across = _COUPLING * math.cos(between), _COUPLING * math.sin(between)
    knee = _LOWER * shank_change + along * thigh_change - across * thigh_rate * thigh_rate
    knee += _GRAVITY * _LOWER_FIRST * math.sin(shank + _AHEAD)
    hip = _UPPER * thigh_change + along * shank_change + across * shank_rate * shank_rate
    hip += _GRAVITY * _UPPER_FIRST * math.sin(thigh) + knee
    return hip, knee


@kernel
def leg_momentum(thigh, shank, thigh_rate, shank_rate):
    """Angular momentum [kg m^2/s] of a leg about its hip, forward. Arguments as of `swing_torques`."""
    along = _COUPLING * math.cos(thigh - shank - _AHEAD)
    return (_UPPER + along) * thigh_rate + (_LOWER + along) * shank_rate
