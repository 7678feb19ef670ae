"""What a person on a path tells of its way, so that others can keep out of it."""

import numpy as np
from numpy.typing import NDArray

from locomotion import path_tracking
from locomotion.gaits import PERSON_RULES
from locomotion.giving_way import AT_ONCE, HORIZON, SPACING, Course
from locomotion.path_tracking import COME_TO_REST, PathTable, TrackingLimits

__all__ = ["course_on_path"]

_WALK_BEND, _RUN_BEND = 1.0, 0.1
"""[1/m] in which it goes out of somebody's way; in sharper bends than it has learned to slow down in, a
runner falls behind those it has met (`python -m benchmarks.giving_way --pairs runner-runner`)."""
_WALK_BEGINS, _RUN_BEGINS = 0.5, 1.0  # [m] ahead where it begins to
_SWAY = 0.07  # [m] that it is beside its path now and then


def course_on_path(
    path: PathTable,
    memory: NDArray[np.float64],
    limits: TrackingLimits,
    speed: float,
    walks: bool,
    aside: bool,
) -> Course:
    """The course of a person that has come as far along ``path`` as its tracker's ``memory`` says, at
    ``speed`` [m/s]; ``aside``: whether its path may be changed."""
    arc, step = float(memory[path_tracking.ARC]), path.length / (len(path.table) - 1)
    far = arc + 2.0 * HORIZON * limits.speeds[1]
    along = np.arange(arc, min(path.length, far) + 1e-9, SPACING)
    rows = np.empty((len(along), path.table.shape[1]))
    for k in range(rows.shape[1]):
        rows[:, k] = np.interp(along / step, np.arange(len(path.table)), path.table[:, k])
    return Course(
        points=rows[:, :3],
        speeds=np.minimum(rows[:, path_tracking.SPEED], limits.speeds[1]),
        speed=speed,
        pace=float(memory[path_tracking.PACE]),
        length=0.0,
        reach=0.0,
        radius=PERSON_RULES["radius"] + _SWAY,
        acceleration=limits.acceleration,
        braking=limits.deceleration,
        eagerness=AT_ONCE,
        slowest=0.0 if walks else limits.speeds[0],
        sharpest=_WALK_BEND if walks else _RUN_BEND,
        begins=_WALK_BEGINS if walks else _RUN_BEGINS,
        aside=aside,
        whole=path.length <= far,
        stops=COME_TO_REST if walks else COME_TO_REST + (speed * speed) / (2.0 * limits.slowing),
    )
