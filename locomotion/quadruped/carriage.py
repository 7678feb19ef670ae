"""How high hips and shoulders are carried: above the ground as the feet feel it, low enough for the legs."""

from __future__ import annotations

import math

from locomotion.quadruped import layout as at
from locomotion.quadruped.following import front_of, spring
from surefoot.kernels import kernel

__all__ = ["carry"]

_HEIGHT_HALF_LIFE = 0.07  # [s]
_STRETCH, _TAUT = 0.90, 0.95  # shares of its length to which a standing leg should, and can, be stretched
_SWUNG = 0.97  # greatest share of a leg's length in the middle of a swing
_SOFT = 0.03  # share of a length over which a limit starts to pull the trunk down
_FAR = math.log1p(math.exp(-4.0))  # so that nothing pulls four times as far from it
_CROUCH = 0.25  # [1/rad²] lowering of the body with slope
_STEEPEST = 0.75  # height difference of hips and shoulders, relative to the spine; the higher ones come down
# for it, so that no foot leaves the ground
_NEAR = 0.5  # distance of front and rear feet, relative to the spine, from which they tell a slope


@kernel
def _highest(feet, joint_x, joint_y, direction, width, first, reach, most):
    """Height [m] at which both legs of a pair, ``first`` and the next, still reach their feet: stretched to
    ``reach`` [m], and to ``most`` in the middle of a swing. Nothing jumps when they come down."""
    highest = math.inf
    for k in range(2):
        foot = feet[first + k]
        side = 0.5 * width if k == 0 else -0.5 * width
        dx = foot[at.FX] - (joint_x - side * math.sin(direction))
        dy = foot[at.FY] - (joint_y + side * math.cos(direction))
        far = reach
        if foot[at.IN_SWING] > 0.0:
            far += foot[at.HUMP] * max(most - reach, 0.0)
        left = far * far - dx * dx - dy * dy
        highest = min(highest, foot[at.FZ] + math.sqrt(max(left, 0.01 * reach * reach)))
    return highest


@kernel
def _feel_ground(st, pr, feet):
    """Heights of the ground under hips and shoulders, as the feet feel it: on the line through the middle of
    the rear feet and that of the front feet, wherever under the body these are."""
    length = pr[at.BONES] * pr[at.BONE]
    ax, ay = st[at.FRONT_X] - st[at.X], st[at.FRONT_Y] - st[at.Y]
    far = max(math.sqrt(ax * ax + ay * ay), 1e-6)
    ax, ay = ax / far, ay / far
    x, y = 0.5 * (feet[0, at.FX] + feet[1, at.FX]), 0.5 * (feet[0, at.FY] + feet[1, at.FY])
    front, front_z = ax * (x - st[at.X]) + ay * (y - st[at.Y]), 0.5 * (feet[0, at.BASE] + feet[1, at.BASE])
    x, y = 0.5 * (feet[2, at.FX] + feet[3, at.FX]), 0.5 * (feet[2, at.FY] + feet[3, at.FY])
    rear, rear_z = ax * (x - st[at.X]) + ay * (y - st[at.Y]), 0.5 * (feet[2, at.BASE] + feet[3, at.BASE])
    slope = (front_z - rear_z) / max(front - rear, _NEAR * length)
    st[at.GROUND_REAR] = rear_z - slope * rear
    st[at.GROUND_FRONT] = front_z + slope * (far - front)


@kernel
def carry(st, pr, feet):
    """Heights of hips and shoulders: over the ground as the feet feel it, and low enough for them."""
    twice = 4.0 * math.pi * st[at.CLOCK]
    bob = st[at.BOB_NOW] * math.cos(twice)
    rock = st[at.ROCK_NOW] * math.cos(0.5 * twice)
    _feel_ground(st, pr, feet)
    crouch = 1.0 - _CROUCH * st[at.PITCH] * st[at.PITCH]
    for front in range(2):
        z = at.Z_FRONT if front else at.Z_REAR
        leg = 0 if front else 2
        height = pr[at.HEIGHT_FRONT] if front else pr[at.HEIGHT_REAR]
        sizes = at.UPPER_FRONT if front else at.UPPER_REAR
        wanted = (
            st[at.GROUND_FRONT if front else at.GROUND_REAR]
            + crouch * height
            + bob
            + (rock if front else -rock)
        )
        reach = pr[sizes] + pr[sizes + 1] + pr[sizes + 2]
        if front:
            x, y, direction, width = st[at.FRONT_X], st[at.FRONT_Y], st[at.CHEST], pr[at.WIDTH_FRONT]
        else:
            x, y, direction, width = st[at.X], st[at.Y], st[at.YAW], pr[at.WIDTH_REAR]
        wanted = min(wanted, _highest(feet, x, y, direction, width, leg, _STRETCH * reach, _SWUNG * reach))
        off, st[z + 1] = spring(st[z] - wanted, st[z + 1], _HEIGHT_HALF_LIFE)
        st[z] = _below(
            wanted + off, _highest(feet, x, y, direction, width, leg, _TAUT * reach, _SWUNG * reach), reach
        )
    # the trunk tilts about the hips and moves the shoulders, perhaps too high for their feet
    reach = pr[at.UPPER_FRONT] + pr[at.LOWER_FRONT] + pr[at.FOOT_FRONT]
    wanted = st[at.Z_FRONT]
    for _ in range(2):
        _tilt(st, pr)
        highest = _highest(
            feet,
            st[at.FRONT_X],
            st[at.FRONT_Y],
            st[at.CHEST],
            pr[at.WIDTH_FRONT],
            0,
            _TAUT * reach,
            _SWUNG * reach,
        )
        st[at.Z_FRONT] = _below(wanted, highest, reach)
    _tilt(st, pr)


@kernel(inline="always")
def _below(height, limit, size):
    """``height`` [m] kept under a limit, without a kink where it comes near it; ``size`` [m] of the body."""
    soft = _SOFT * size
    over = (height - limit) / soft
    down = math.log1p(math.exp(over)) if over < 30.0 else over
    return height - soft * max(down - _FAR, 0.0)


@kernel
def _tilt(st, pr):
    """Pitch of the trunk from the heights of hips and shoulders, and the place of the front under it."""
    length = pr[at.BONES] * pr[at.BONE]
    st[at.Z_FRONT] = _below(st[at.Z_FRONT], st[at.Z_REAR] + _STEEPEST * length, length)
    st[at.Z_REAR] = _below(st[at.Z_REAR], st[at.Z_FRONT] + _STEEPEST * length, length)
    st[at.PITCH] = math.asin((st[at.Z_FRONT] - st[at.Z_REAR]) / length)
    st[at.FRONT_X], st[at.FRONT_Y] = front_of(
        st[at.X], st[at.Y], st[at.YAW], st[at.BEND], pr[at.BONES], pr[at.BONE] * math.cos(st[at.PITCH])
    )
