"""What the odds of clearing an obstacle depend on, from the physical state at a moment of a run-up.

Everything sideways is mirrored, so that the stance foot is the left one: a body and its mirror image have the
same odds.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from locomotion.gaits.run import layout
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.preconditions.moments import Moment
from navmesh.obstacles.kinds import kind_of
from surefoot.kernels import kernel

__all__ = [
    "BEFORE", "FEATURES", "MOST_ROOM", "SITE", "before_run_up", "describe", "describe_moment", "site_of",
]  # fmt: skip

SITE = ("x", "y", "top", "ahead x", "ahead y", "size", "depth", "grip")
"""What is told of an obstacle: a point of its edge [m], the unit direction of the approach, its size and its
thickness [m] (0 of what one does not get over), the ground's coefficient of friction."""
FEATURES = (
    "size", "depth", "grip", "farther", "faster", "steps left", "early", "missing speed", "planned change",
    "speed ahead", "speed sideways", "speed up", "heading", "beside", "steps made", "trim",
    "foot distance", "height over edge",
    *(f"error of {name}" for name in layout.SENSORS),
)  # fmt: skip
"""Of a moment: size and thickness [m], friction; variation of the run-up [m, m/s]; steps left; [m] that the
last foothold is before its mark; [m/s] that the last step was slower than the entry; [m/s] that the next one
is to be faster; velocity of the centre of mass [m/s], ahead less the entry speed; direction of the run off
the approach [rad]; [m] off the path; steps made, up to 8; correction of the speed [m/s]; [m] from the stance
foot to the edge; [m] of the centre of mass over the edge; and how far the sensors of the run are off their
reference."""
BEFORE = ("size", "depth", "grip", "room")
"""Of an obstacle before the run-up: its first three, and [m] of way before it."""
MOST_ROOM = 16.0
"""[m]: a longer way before an obstacle counts as this."""
_MOST_STEPS = 8.0
_SENSORS = len(layout.SENSORS)


def site_of(obstacle: ObstacleAhead, grip: float) -> NDArray[np.float64]:
    """(8,) what `SITE` names, of an obstacle on ground with this friction."""
    x, y, z = obstacle.position
    kind = kind_of(obstacle.affordance)
    depth = obstacle.depth if kind.has_depth else 0.0
    return np.array([x, y, z, -obstacle.normal[0], -obstacle.normal[1], obstacle.size, depth, grip])


def before_run_up(site: NDArray[np.float64], room: float) -> NDArray[np.float64]:
    """(4,) what `BEFORE` names; ``room``: [m] of way before the obstacle."""
    return np.array([*site[5:8], min(room, MOST_ROOM)])


def describe_moment(moment: Moment, site: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) `FEATURES` of a moment."""
    out = np.empty(len(FEATURES))
    farther, faster = float(moment.variation[0]), float(moment.variation[1])
    describe(moment.state, moment.plan, farther, faster, moment.beside, site, out)
    return out


@kernel
def describe(state, plan, farther, faster, beside, site, out):
    """`FEATURES` of a moment into ``out``; arguments as of `moments.Moment`, ``site`` (8,) of `site_of`."""
    side = state[layout.STANCE]
    ax, ay = site[3], site[4]
    vx, vy = state[layout.VELOCITY_X], state[layout.VELOCITY_Y]
    foot = layout.LEFT_PLANTED if side > 0 else layout.RIGHT_PLANTED
    askew = state[layout.HEADING] - math.atan2(ay, ax)
    askew = math.atan2(math.sin(askew), math.cos(askew))
    out[0], out[1], out[2] = site[5], site[6], site[7]
    out[3], out[4] = farther, faster
    out[5], out[6] = plan[0], plan[1]
    out[7] = plan[3] - state[layout.STEP_SPEED]
    out[8] = plan[2] - state[layout.STEP_SPEED]
    out[9] = vx * ax + vy * ay - plan[3]
    out[10] = side * (vy * ax - vx * ay)
    out[11] = state[layout.VELOCITY_Z]
    out[12] = side * askew
    out[13] = side * beside
    out[14] = min(state[layout.STEPS], _MOST_STEPS)
    out[15] = state[layout.TRIM]
    out[16] = (site[0] - state[foot]) * ax + (site[1] - state[foot + 1]) * ay
    out[17] = state[layout.COM_Z] - site[2]
    for k in range(_SENSORS):
        out[18 + k] = state[layout.FIRST_SENSOR + k]
