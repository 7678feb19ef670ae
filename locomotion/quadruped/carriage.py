"""How high hips and shoulders are carried: above the ground as the feet feel it, low enough for the legs."""

from __future__ import annotations

import math

from locomotion.quadruped import layout as at
from locomotion.quadruped.back import girdles
from locomotion.quadruped.body_on_path import front_of, spring
from locomotion.quadruped.motion import DT
from surefoot.kernels import kernel

__all__ = ["carry"]

_HEIGHT_HALF_LIFE = 0.07  # [s]
_STRETCH, _TAUT = 0.90, 0.95  # shares of its length to which a standing leg should, and can, be stretched
_SWUNG = 1.02  # the same in the middle of a swing: a toe in the air may fall short of its way
_SOFT = 0.03  # share of a length over which a limit starts to pull the trunk down
_FAR = math.log1p(math.exp(-4.0))  # so that nothing pulls four times as far from it
_CROUCH = 0.25  # [1/rad²] lowering of the body with slope
_STEEPEST = 0.75  # height difference of hips and shoulders, relative to the spine; the higher ones come down
# for it, so that no foot leaves the ground
_NEAR, _FAR_ENOUGH = 0.5, 0.8  # distances of front and rear feet, relative to the spine: from the first they
# begin to tell a slope, from the second on they tell it; nearer ones leave it as it was
_FEELING = 0.25  # [s] in which they learn it


@kernel
def _highest(feet, joint_x, joint_y, direction, width, roll, first, reach, most):
    """Height [m] at which both legs of a pair, ``first`` and the next, still reach their feet: stretched to
    ``reach`` [m], and to ``most`` in the middle of a swing. Nothing jumps when they come down."""
    highest, rise = math.inf, math.sin(roll)
    for k in range(2):
        foot = feet[first + k]
        side = 0.5 * width if k == 0 else -0.5 * width
        dx = foot[at.FX] - (joint_x - side * math.sin(direction))
        dy = foot[at.FY] - (joint_y + side * math.cos(direction))
        far = reach
        if foot[at.IN_SWING] > 0.0:
            far += foot[at.HUMP] * max(most - reach, 0.0)
        left = far * far - dx * dx - dy * dy
        highest = min(highest, foot[at.FZ] + math.sqrt(max(left, 0.01 * reach * reach)) - side * rise)
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
    felt = (front_z - rear_z) / max(front - rear, _NEAR * length)
    trust = min(max(((front - rear) / length - _NEAR) / (_FAR_ENOUGH - _NEAR), 0.0), 1.0)
    slope = trust * felt + (1.0 - trust) * st[at.SLOPE]
    st[at.SLOPE] += trust * DT / _FEELING * (felt - st[at.SLOPE])
    st[at.GROUND_REAR] = rear_z - slope * rear
    st[at.GROUND_FRONT] = front_z + slope * (far - front)
    # what is carried follows the ground by a spring, and on an even slope it would lag behind all the time
    climb = slope * (ax * st[at.RATE] + ay * st[at.RATE + 1]) * DT
    st[at.CARRIED_REAR] += climb
    st[at.CARRIED_FRONT] += climb


@kernel
def carry(st, pr, feet):
    """Heights of hips and shoulders: over the ground as the feet feel it, with what the stride adds, and low
    enough for the legs. The limits look at where the stride takes them, too, but only what is carried follows
    the limits by a spring."""
    _feel_ground(st, pr, feet)
    crouch = 1.0 - _CROUCH * st[at.PITCH] * st[at.PITCH]
    rear_x, rear_y, rear, front_x, front_y, front = girdles(st, pr)
    reach = pr[at.UPPER_REAR] + pr[at.LOWER_REAR] + pr[at.FOOT_REAR]
    _carry_pair(
        st, feet, at.CARRIED_REAR, at.Z_REAR, st[at.GROUND_REAR] + crouch * pr[at.HEIGHT_REAR],
        st[at.LIFT_REAR], rear_x, rear_y, rear, pr[at.WIDTH_REAR], st[at.ROLL_REAR], 2, reach,
    )  # fmt: skip
    reach = pr[at.UPPER_FRONT] + pr[at.LOWER_FRONT] + pr[at.FOOT_FRONT]
    _carry_pair(
        st, feet, at.CARRIED_FRONT, at.Z_FRONT, st[at.GROUND_FRONT] + crouch * pr[at.HEIGHT_FRONT],
        st[at.LIFT_FRONT], front_x, front_y, front, pr[at.WIDTH_FRONT], st[at.ROLL_FRONT], 0, reach,
    )  # fmt: skip
    # the trunk tilts about the hips and moves the shoulders, perhaps too high for their feet
    wanted = st[at.Z_FRONT]
    for _ in range(2):
        _tilt(st, pr)
        _, _, _, front_x, front_y, front = girdles(st, pr)
        highest = _highest(
            feet, front_x, front_y, front, pr[at.WIDTH_FRONT], st[at.ROLL_FRONT], 0, _TAUT * reach,
            _SWUNG * reach,
        )  # fmt: skip
        st[at.Z_FRONT] = _below(wanted, highest, reach)
    _tilt(st, pr)


@kernel
def _carry_pair(st, feet, carried, z, wanted, lift, x, y, direction, width, roll, first, reach):
    """Write the columns ``carried``, ``z`` and the rate after it of the pair of legs from ``first`` on."""
    easy = _highest(feet, x, y, direction, width, roll, first, _STRETCH * reach, _SWUNG * reach)
    taut = _highest(feet, x, y, direction, width, roll, first, _TAUT * reach, _SWUNG * reach)
    wanted = min(wanted, easy)
    off, st[z + 1] = spring(st[carried] - wanted, st[z + 1], _HEIGHT_HALF_LIFE)
    st[carried] = _below(wanted + off, taut, reach)
    st[z] = _below(wanted + off + lift, taut, reach)


@kernel(forceinline=True)
def _below(height, limit, size):
    """``height`` [m] kept under a limit, without a kink where it comes near it; ``size`` [m] of the body."""
    soft = _SOFT * size
    over = (height - limit) / soft
    down = math.log1p(math.exp(over)) if over < 30.0 else over
    return height - soft * max(down - _FAR, 0.0)


@kernel
def _tilt(st, pr):
    """Pitch of the trunk from the heights of hips and shoulders as they are carried, and the place of the
    front under it: neither moves with the stride or the breath."""
    length = pr[at.BONES] * pr[at.BONE]
    for rear, front in ((at.CARRIED_REAR, at.CARRIED_FRONT), (at.Z_REAR, at.Z_FRONT)):
        st[front] = _below(st[front], st[rear] + _STEEPEST * length, length)
        st[rear] = _below(st[rear], st[front] + _STEEPEST * length, length)
    st[at.PITCH] = math.asin((st[at.CARRIED_FRONT] - st[at.CARRIED_REAR]) / length)
    st[at.FRONT_X], st[at.FRONT_Y] = front_of(
        st[at.X], st[at.Y], st[at.YAW], st[at.BEND], pr[at.BONES], pr[at.BONE] * math.cos(st[at.PITCH])
    )
