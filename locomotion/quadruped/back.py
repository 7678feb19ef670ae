"""The back seen from the side: bones that share its flexion, and where that leaves hips and shoulders.

The joint between pelvis and first bone takes the share ``sacral`` of the flexion. The joints between the
bones take the rest, less and less from the loin to the withers: where ribs are, a back hardly bends.
"""

from __future__ import annotations

import math

from locomotion.quadruped import layout as at
from surefoot.kernels import kernel

__all__ = ["bend_back", "bone_drop", "chord_pitch", "girdles", "pelvis_pitch"]


@kernel(forceinline=True)
def bone_drop(k, bones, sacral):
    """Share of the flexion between the first bone and bone ``k``, counted from 1."""
    return (1.0 - sacral) * (k - 1.0) * (2.0 * bones - k) / (bones * (bones - 1.0))


@kernel
def bend_back(st, pr):
    """Write CHORD and TILT of a back that is flexed by BACK."""
    along, up = 0.0, 0.0
    for k in range(1, int(pr[at.BONES]) + 1):
        drop = st[at.BACK] * bone_drop(k, pr[at.BONES], pr[at.SACRAL])
        along += math.cos(drop)
        up -= math.sin(drop)
    st[at.CHORD] = math.sqrt(along * along + up * up) / pr[at.BONES]
    st[at.TILT] = -math.atan2(up, along)


@kernel
def girdles(st, pr):
    """(x, y, direction) of the hips and (x, y, direction) of the shoulders.

    They stand over the middles of their feet, nearer to each other by as much as flexion shortens the back,
    moved by the sway, turned by the bend to the side."""
    dx, dy = st[at.FRONT_X] - st[at.X], st[at.FRONT_Y] - st[at.Y]
    far = max(math.sqrt(dx * dx + dy * dy), 1e-6)
    dx, dy = dx / far, dy / far
    shorter = 0.5 * far * (1.0 - st[at.CHORD])
    turn = (st[at.SWAY_FRONT] - st[at.SWAY_REAR]) / far
    bones = pr[at.BONES]
    each = st[at.SIDE_BEND] / bones
    return (
        st[at.X] + shorter * dx - st[at.SWAY_REAR] * dy,
        st[at.Y] + shorter * dy + st[at.SWAY_REAR] * dx,
        st[at.YAW] + turn - 0.5 * (bones + 1.0) * each,
        st[at.FRONT_X] - shorter * dx - st[at.SWAY_FRONT] * dy,
        st[at.FRONT_Y] - shorter * dy + st[at.SWAY_FRONT] * dx,
        st[at.CHEST] + turn + 0.5 * (bones - 1.0) * each,
    )


@kernel
def chord_pitch(st, pr):
    """[rad] of the line from the hips to the shoulders over the horizontal."""
    rise = (st[at.Z_FRONT] - st[at.Z_REAR]) / (st[at.CHORD] * pr[at.BONES] * pr[at.BONE])
    return math.asin(min(max(rise, -1.0), 1.0))


@kernel
def pelvis_pitch(st, pr):
    """[rad] of the pelvis over the horizontal."""
    return chord_pitch(st, pr) + st[at.TILT] + st[at.BACK] * pr[at.SACRAL]
