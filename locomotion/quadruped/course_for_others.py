"""The course of a quadruped on a trail, for others, and trails shifted to one side."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from locomotion.avoidance.yielding import HORIZON, SPACING, Course
from locomotion.quadruped import layout as at
from locomotion.quadruped.body import Body
from locomotion.quadruped.motion import SLACKEN, stop_length
from locomotion.quadruped.predicted_discs import disc_radius
from locomotion.quadruped.trail import Trail

__all__ = ["course_back", "course_on", "head_length", "shifted_points"]

_BEND = 1.0  # radius of the curve with which it steps aside, in body lengths
_BEGINS = 0.1  # [m] before the front feet


def course_on(trail: Trail, state: NDArray[np.float64], body: Body) -> Course:
    """The course of a body whose row of the herd's state is ``state`` (STATE,)."""
    arc, fastest = float(state[at.ARC]), float(min(state[at.WISH], body.top_speed))
    far = arc + 2.0 * HORIZON * fastest + body.length
    along = np.arange(arc, max(min(trail.length, far), arc + SPACING) + 1e-9, SPACING)
    rows = np.minimum(along / trail.step, len(trail.rows) - 1.0)
    known = np.arange(len(trail.rows))
    points = np.stack([np.interp(rows, known, trail.rows[:, c]) for c in (at.PX, at.PY, at.PZ)], axis=1)
    return Course(
        points=points,
        speeds=np.minimum(np.interp(rows, known, trail.rows[:, at.PSPEED]), fastest),
        speed=float(state[at.SPEED]),
        pace=float(state[at.PACE]),
        length=head_length(body),
        reach=head_length(body) - body.spine.length if trail.length <= far else 0.0,
        radius=disc_radius(body),
        acceleration=body.movement.acceleration,
        braking=body.movement.braking,
        eagerness=SLACKEN,
        slowest=0.0,
        sharpest=1.0 / (_BEND * body.length),
        begins=body.spine.length + _BEGINS,
        aside=True,
        whole=trail.length <= far,
        stops=float(stop_length(state[at.SPEED], body.movement.braking)),
        nose=head_length(body) - body.spine.length,
    )


def course_back(rows: NDArray[np.float64], state: NDArray[np.float64], body: Body) -> Course:
    """The course of a body that backs up along a trail of ``rows`` (n, ROW): it begins at its front feet."""
    arc, end = float(state[at.ARC]), float(state[at.ARC_END])
    along = np.arange(arc + body.spine.length, min(end, arc - SPACING) - 1e-9, -SPACING)
    known = state[at.ROW_STEP] * np.arange(len(rows))
    points = np.stack([np.interp(along, known, rows[:, c]) for c in (at.PX, at.PY, at.PZ)], axis=1)
    return Course(
        points=points,
        speeds=np.full(len(points), float(state[at.WISH])),
        speed=float(state[at.SPEED]),
        pace=float(state[at.PACE]),
        length=body.spine.length,
        reach=0.0,
        radius=disc_radius(body),
        acceleration=body.movement.acceleration,
        braking=body.movement.braking,
        eagerness=SLACKEN,
        slowest=0.0,
        sharpest=1.0 / (_BEND * body.length),
        begins=0.0,
        aside=False,
        whole=False,
        stops=float(stop_length(state[at.SPEED], body.movement.braking)),
    )


def head_length(body: Body) -> float:
    """[m] from between its rear feet to its nose."""
    return body.length - body.trunk.loin


def shifted_points(trail: Trail, arc: float, shift: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 3) [m] the points of ``trail``, those behind ``arc`` [m] moved by ``shift`` (k, 2) [m], one row for
    every 0.1 m."""
    points = trail.points.copy()
    along, given = trail.step * np.arange(len(points)) - arc, SPACING * np.arange(len(shift))
    for axis in range(2):
        points[:, axis] += np.interp(along, given, shift[:, axis], left=0.0, right=0.0)
    return points
