"""Predicted places of an animal's discs while it cannot or will not change its motion, for bodies around
it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from locomotion.avoidance.yielding import COUNT, STEP
from locomotion.quadruped import layout as at
from locomotion.quadruped.body import Body
from locomotion.quadruped.body_on_path import front_of, wanted_pose
from locomotion.quadruped.footprint import fronts
from locomotion.quadruped.motion import travel
from locomotion.quadruped.script import Script
from surefoot.kernels import allocating_kernel, kernel

__all__ = [
    "DISCS",
    "between_feet",
    "cover_with_discs",
    "disc_radius",
    "foretell_motion",
    "foretell_script",
    "nobody",
]

_X, _Y, _Z, _VX, _VY, _RADIUS = range(6)  # places in the row of a disc
DISCS = 3
"""Number of discs that cover an animal on the ground: at the rear feet, the middle and the front feet."""
_SHARES = np.linspace(0.0, 1.0, DISCS)[:, None]


def disc_radius(body: Body) -> float:
    """[m] of each of them."""
    return max(body.radius, 0.25 * body.spine.length)


def between_feet(rear: NDArray[np.float64], front: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, DISCS, 2) [m] the discs' centres, from the feet's midpoints (n, 2)."""
    return rear[:, None] + _SHARES * (front - rear)[:, None]


@kernel
def cover_with_discs(states, radii, rows):
    """The discs that cover animals on the ground, `DISCS` for each, into ``rows`` (DISCS n, 6): x, y, z [m],
    velocity of the root in x and y [m/s], radius [m]. states: (n, ROW) of a herd; radii: (n,) [m]."""
    for k in range(len(states)):
        st = states[k]
        for disc in range(DISCS):
            row, share = rows[DISCS * k + disc], _SHARES[disc, 0]
            row[_X] = st[at.X] + share * (st[at.FRONT_X] - st[at.X])
            row[_Y] = st[at.Y] + share * (st[at.FRONT_Y] - st[at.Y])
            row[_Z], row[_VX], row[_VY] = st[at.HEIGHT], st[at.RATE], st[at.RATE + 1]
            row[_RADIUS] = radii[k]


@allocating_kernel
def foretell_motion(st, pr, pool, feet):
    """Write the midpoints of rear and front feet every `STEP` from now on into ``feet`` (COUNT, 2, 2), if
    an animal of the herd's row ``st`` goes on with the stop, trail or script that it plays."""
    for k in range(feet.shape[0]):
        arc = st[at.ARC]
        if st[at.MODE] == at.ON_TRAIL:
            arc += st[at.WAY] * travel(st, pr, k * STEP)
        time = min(st[at.SCRIPT_TIME] + k * STEP, st[at.SCRIPT_LENGTH])
        x, y, _, yaw, bend, _ = wanted_pose(st, pr, pool, arc, time)
        feet[k, 0, 0], feet[k, 0, 1] = x, y
        feet[k, 1, 0], feet[k, 1, 1] = front_of(x, y, yaw, bend, pr[at.BONES], pr[at.BONE])


def foretell_script(script: Script, body: Body) -> NDArray[np.float64]:
    """(COUNT, DISCS, 2) [m] every `STEP`, if it is played from now on."""
    rows = np.clip(STEP * np.arange(COUNT) / script.seconds, 0.0, 1.0) * (len(script.rows) - 1)
    known = np.arange(len(script.rows))
    columns = (at.SX, at.SY, at.SZ, at.SYAW, at.SBEND)
    places = np.stack([np.interp(rows, known, script.rows[:, column]) for column in columns], axis=1)
    return between_feet(places[:, :2], fronts(places, body))


def nobody() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The surroundings of an animal that is alone."""
    return np.empty((COUNT, 0, 2)), np.empty(0)
