"""Ledges to roll off, and what happens when a person does."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from locomotion import MOVING, Ground, Human, ObstacleAhead
from locomotion.clearing import ClearingSkill
from locomotion.events import Cleared, TookOff
from locomotion.person import MASS

__all__ = ["AFTER", "DropAttempt", "drop_attempt", "ledge"]

AFTER = 15.0
"""[m] from the edge to the goal below."""
SPEED = 3.5
"""[m/s] asked for on the way."""
_LONGEST = 90.0  # [s] of a trial
_HALF = 6.0  # [m] of the ledge's length


@dataclass(frozen=True)
class DropAttempt:
    """One run-up, drop, roll and way on.

    distance: from the start to the edge [m]. ended: "arrived", or the status at the end; "fallen in the
    run-up", "fallen in the roll", "fallen afterwards". peak: highest reaction of the ground from the landing
    to the end of the roll, after a physics step [body weights]. head: time that the head touched the ground
    [s]. takeoff_error [m], speed_error [m/s]: as in `locomotion.events.TookOff`, NaN before it.
    """

    height: float
    distance: float
    ended: str
    peak: float
    head: float
    takeoff_error: float
    speed_error: float


def ledge(height: float, before: float = 40.0) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices and faces of a floor up to x = 0 and one ``height`` [m] below it behind."""
    h, s, end = height, _HALF, AFTER + 8.0
    corners, faces = [], []
    for quad in (
        [(-before, -s, 0), (0, -s, 0), (0, s, 0), (-before, s, 0)],
        [(0, -s, 0), (0, -s, -h), (0, s, -h), (0, s, 0)],
        [(0, -s, -h), (end, -s, -h), (end, s, -h), (0, s, -h)],
    ):
        first = len(corners)
        corners += quad
        faces += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return np.array(corners, dtype=np.float64), np.array(faces)


def drop_attempt(
    height: float,
    distance: float,
    clearing: list[ClearingSkill] | None = None,
    noise: NDArray[np.float64] | None = None,
    frames: list[NDArray[np.float64]] | None = None,
) -> DropAttempt:
    """Run up from ``distance`` [m], roll off a ledge of a level made of triangles, go on to the goal.

    noise: (45,) added to the velocities at the start. frames: collects qpos of each tick.
    """
    human = Human(Ground.from_arrays(*ledge(height, distance + 5.0)), clearing=clearing)
    human.reset((-distance, 0.0, 0.0), 0.0)
    if noise is not None:
        human.data.qvel[:] += noise
    ahead = ObstacleAhead(distance, "drop", height, np.zeros(3), np.array([-1.0, 0.0, 0.0]))
    way = [[-distance, 0, 0], [-1e-3, 0, 0], [1e-3, 0, -height], [AFTER, 0, -height]]
    human.follow(way, SPEED, [ahead])
    took_off = cleared = None
    peak, head = 0.0, 0
    while human.status in MOVING and human.time < _LONGEST:
        human.tick()
        if frames is not None:
            frames.append(human.qpos)
        for event in human.events[-2:]:
            took_off = event if isinstance(event, TookOff) else took_off
            cleared = event if isinstance(event, Cleared) else cleared
        if took_off is not None and cleared is None and human.com[0] > 0.0:
            force, touched = _contacts(human)
            peak, head = max(peak, force / (MASS * 9.81)), head + touched
    ended = human.status
    if ended == "fallen":
        ended += (
            " in the run-up" if took_off is None else " in the roll" if cleared is None else " afterwards"
        )
    errors = (np.nan, np.nan) if took_off is None else (took_off.takeoff_error, took_off.speed_error)
    return DropAttempt(height, distance, ended, peak, head * 0.01, *errors)


def _contacts(human: Human) -> tuple[float, bool]:
    """Sum of the normal forces of the ground [N], and whether the head touches it."""
    contact = human.data.contact
    pushes = contact.efc_address >= 0
    rows = contact.efc_address[pushes][:, None] + np.arange(4)
    head = human.model.geom_bodyid[contact.geom[pushes]] == human.index.head
    return float(human.data.efc_force[rows].sum()), bool(head.any())
