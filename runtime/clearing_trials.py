"""Walls to vault over, and what happens when a person does."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from locomotion import MOVING, Ground, Human, ObstacleAhead
from locomotion.clearing import ClearingSkill
from locomotion.events import Cleared, TookOff
from locomotion.hand_hold import holding

__all__ = ["AFTER", "VaultAttempt", "vault_attempt", "wall"]

AFTER = 12.0
"""[m] to run on behind the wall."""
SPEED = 3.5
"""[m/s] asked for on the way."""
_LONGEST = 60.0  # [s] of a trial
_HALF = 4.0  # [m] of the wall's length
_SOLES = 0.02  # [m] above the floor from which a contact is one with the wall


@dataclass(frozen=True)
class VaultAttempt:
    """One run-up and vault.

    distance: from the start to the wall [m]. ended: "arrived", or the status at the end; "fallen in the
    run-up", "fallen in the vault", "fallen afterwards". planted: where the hand held, as share of the
    thickness from the near edge, NaN if it did not. held: time that the hand held [s]. touched: whether
    anything but hands and forearms touched the wall. takeoff_error [m], speed_error [m/s]: as in
    `locomotion.events.TookOff`, NaN before it.
    """

    height: float
    depth: float
    distance: float
    ended: str
    planted: float
    held: float
    touched: bool
    takeoff_error: float
    speed_error: float

    @property
    def vaulted(self) -> bool:
        """Over the wall with a hand on it, and at the goal behind."""
        return self.ended == "arrived" and self.held > 0.0


def wall(height: float, depth: float, before: float = 40.0) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices and faces of a floor with a wall across it from x = 0 to ``depth`` [m], ``height`` [m]
    high."""
    h, d, s, end = height, depth, _HALF, AFTER + 8.0
    corners, faces = [], []
    for quad in (
        [(-before, -s, 0), (0, -s, 0), (0, s, 0), (-before, s, 0)],
        [(0, s, 0), (0, -s, 0), (0, -s, h), (0, s, h)],
        [(0, -s, h), (d, -s, h), (d, s, h), (0, s, h)],
        [(d, -s, 0), (d, s, 0), (d, s, h), (d, -s, h)],
        [(d, -s, 0), (end, -s, 0), (end, s, 0), (d, s, 0)],
    ):
        first = len(corners)
        corners += quad
        faces += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return np.array(corners, dtype=np.float64), np.array(faces)


def vault_attempt(
    height: float,
    depth: float,
    distance: float,
    clearing: list[ClearingSkill] | None = None,
    noise: NDArray[np.float64] | None = None,
    frames: list[NDArray[np.float64]] | None = None,
) -> VaultAttempt:
    """Run up from ``distance`` [m], vault over a wall of a level made of triangles, run on to the goal.

    noise: (45,) added to the velocities at the start. frames: collects qpos of each tick.
    """
    human = Human(Ground.from_arrays(*wall(height, depth, distance + 5.0)), clearing=clearing)
    human.reset((-distance, 0.0, 0.0), 0.0)
    if noise is not None:
        human.data.qvel[:] += noise
    edge, normal = np.array([0.0, 0.0, height]), np.array([-1.0, 0.0, 0.0])
    ahead = ObstacleAhead(distance, "vault", height, edge, normal, depth)
    human.follow([[-distance, 0, 0], [AFTER, 0, 0]], SPEED, [ahead])
    parts = ("left_hand", "left_forearm", "right_hand", "right_forearm")
    arms = {human.index.bodies[part] for part in parts}
    took_off = cleared = None
    planted, held, touched = np.nan, 0, False
    while human.status in MOVING and human.time < _LONGEST:
        human.tick()
        if frames is not None:
            frames.append(human.qpos)
        for event in human.events[-2:]:
            took_off = event if isinstance(event, TookOff) else took_off
            cleared = event if isinstance(event, Cleared) else cleared
        if took_off is None or cleared is not None:
            continue
        for each in (-1.0, 1.0):
            if holding(human.data, each):
                held += 1
                planted = float(human.data.mocap_pos[int(each > 0), 0]) / depth
        touched = touched or _touches(human, depth, arms)
    ended = human.status
    if ended == "fallen":
        ended += (
            " in the run-up" if took_off is None else " in the vault" if cleared is None else " afterwards"
        )
    errors = (np.nan, np.nan) if took_off is None else (took_off.takeoff_error, took_off.speed_error)
    return VaultAttempt(height, depth, distance, ended, planted, held * 0.01, touched, *errors)


def _touches(human: Human, depth: float, arms: set[int]) -> bool:
    """Whether anything but hands and forearms touches the wall."""
    data = human.data
    for k in range(data.ncon):
        contact = data.contact[k]
        if -0.05 < contact.pos[0] < depth + 0.05 and contact.pos[2] > _SOLES:
            bodies = {int(human.model.geom_bodyid[g]) for g in contact.geom} - {0}
            if not bodies & arms:
                return True
    return False
