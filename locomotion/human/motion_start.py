"""Persons set in motion: put into the middle of a walk or a run anywhere.

A person cannot be started at an arbitrary pose: its controllers remember where its feet are and what they are
about to do. What can be gone on with is a moment of our own simulation, with all that the controllers
remembered then, carried to another place as a whole. `moments` are those of steady walks and runs on a plane,
made once in a process.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import JOINT_NAMES
from locomotion.errors import LocomotionError
from locomotion.gaits.run import layout as run
from locomotion.gaits.walk import layout as walk
from locomotion.human.human import Human
from locomotion.paths.tracking import new_track

__all__ = ["RUNS", "WALKS", "Moment", "moment_like", "moments", "moments_at", "set_in_motion"]

WALKS = (0.4, 0.65, 0.9, 1.1, 1.25)
"""[m/s] asked of the walks."""
RUNS = (2.6, 3.0, 3.5, 4.0, 4.5)
"""[m/s] asked of the runs."""
_WARM_UP, _NOTED, _EVERY = 220, 130, 2  # ticks: until steady, of which moments are kept, and of these each
_LEGS = np.array([k for k, name in enumerate(JOINT_NAMES) if "hip" in name or "knee" in name])
_AHEAD = 0.06  # [s] for which rates of joints count as much as their angles
_SPEEDS = 1.0  # [rad per m/s] what another speed counts
_TOO_FAST = 0.8  # [m/s] off all there are
_WAY = np.array([[0.0, 0.0, 0.0], [200.0, 0.0, 0.0]])


@dataclass(frozen=True, eq=False)
class Moment:
    """A moment of a steady walk or run along x, on the plane z = 0.

    Attributes:
        runs: or walks. speed: [m/s] of late. asked: [m/s] that its controller was asked for.
        qpos: (46,) of the person. qvel, warmstart: (45,). ctrl: (39,).
        control, walking: what the controllers remember (`locomotion.gaits.run.layout`, `.walk.layout`).
    """

    runs: bool
    speed: float
    asked: float
    qpos: NDArray[np.float64]
    qvel: NDArray[np.float64]
    warmstart: NDArray[np.float64]
    ctrl: NDArray[np.float64]
    control: NDArray[np.float64]
    walking: NDArray[np.float64]


@lru_cache(maxsize=1)
def moments() -> tuple[Moment, ...]:
    """Moments all along strides at `WALKS` and `RUNS`. Raises `LocomotionError` if the built-in gaits do not
    keep up their speeds."""
    found: list[Moment] = []
    human = Human(None, clearing=(), rehearsals=0)
    for runs, speeds in ((False, WALKS), (True, RUNS)):
        for speed in speeds:
            found += moments_at(human, runs, speed)
    return tuple(found)


@lru_cache(maxsize=1)
def _tables() -> tuple[NDArray[np.bool_], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Of all `moments`: whether they run, their speeds, angles and rates of the legs."""
    every = moments()
    return (
        np.array([each.runs for each in every]),
        np.array([each.speed for each in every]),
        np.array([each.qpos[7:][_LEGS] for each in every]),
        np.array([each.qvel[6:][_LEGS] for each in every]),
    )


def moment_like(
    runs: bool, speed: float, pose: NDArray[np.float64], rates: NDArray[np.float64]
) -> Moment | None:
    """The moment that is most like a body that runs, or walks, at ``speed`` [m/s] in ``pose`` (46,), whose
    joints turn at ``rates`` (39,) [rad/s]; None if there is none of about that speed."""
    run_moments, speeds, angles, turning = _tables()
    off = np.abs(speeds - speed)
    unlike = ((angles - pose[7:][_LEGS]) ** 2).sum(axis=1) + (_SPEEDS * off) ** 2
    unlike += _AHEAD**2 * ((turning - rates[_LEGS]) ** 2).sum(axis=1)
    unlike[(run_moments != runs) | (off > _TOO_FAST)] = np.inf
    best = int(np.argmin(unlike))
    return moments()[best] if np.isfinite(unlike[best]) else None


def moments_at(human: Human, runs: bool, speed: float) -> list[Moment]:
    """Those of one speed [m/s]; ``human`` is used up."""
    human.reset(_WAY[0], 0.0, speed if runs else 0.0)
    human.follow(_WAY, speed)
    made = []
    begun = 0.0
    for tick in range(_WARM_UP + _NOTED):
        human.tick()
        if tick == _WARM_UP:
            begun = float(human.com[0])
        if tick >= _WARM_UP and tick % _EVERY == 0:
            made.append(_moment(human, runs))
    if human.status != ("running" if runs else "walking") or human.on_feet.walks == runs:
        raise LocomotionError(f"people end {human.status} at {speed:g} m/s: train the gait again")
    mean = (float(human.com[0]) - begun) / (0.01 * (_NOTED - 1))
    return [Moment(runs, mean, speed, *arrays) for arrays in made]


def _moment(human: Human, runs: bool) -> tuple[NDArray[np.float64], ...]:
    data = human.data
    return (
        data.qpos.copy(), data.qvel.copy(), data.qacc_warmstart.copy(), data.ctrl.copy(),
        human.control.copy(), human.on_feet.walk.copy(),
    )  # fmt: skip


def set_in_motion(human: Human, moment: Moment, root: NDArray[np.float64], ground: float, yaw: float) -> None:
    """Put ``human`` into a ``moment`` of motion towards ``yaw`` [rad] over level ground at height ``ground``
    [m], with its pelvis above ``root`` (2,) [m]. It has then to be told where to go."""
    human.fours.leave()
    human.run_up.begin(())
    human.follower.forget()
    human.follower.memory[:] = new_track()
    carry = _Carry(moment.qpos[:2], root, ground, yaw)
    data, feet = human.data, human.on_feet
    mujoco.mj_resetData(human.model, data)
    data.qpos[:], data.qvel[:] = moment.qpos, moment.qvel
    data.qpos[:3] = carry.points(moment.qpos[:3])
    data.qpos[3:7] = carry.quaternion(moment.qpos[3:7])
    data.qvel[:3] = carry.vectors(moment.qvel[:3])
    data.qacc_warmstart[:], data.ctrl[:] = moment.warmstart, moment.ctrl
    data.qacc_warmstart[:3] = carry.vectors(moment.warmstart[:3])
    human.control[:] = _carried_control(moment.control, carry)
    feet.walk[:] = _carried_walk(moment.walking, carry)
    feet.stop_learned()
    feet.landing.forget()
    feet.slowing, feet.brakes, feet.hurries, feet.speed = 0.0, False, False, moment.asked
    human.command[:] = yaw, moment.asked, 0.0, 0.0
    human.status = "running" if moment.runs else "walking"
    mujoco.mj_kinematics(human.model, data)
    human.decider.predicted.forget()


class _Carry:
    """Turns about the vertical through ``centre`` (2,), and moves that to ``root`` (2,) and up."""

    def __init__(self, centre: NDArray[np.float64], root: NDArray[np.float64], up: float, yaw: float) -> None:
        c, s = math.cos(yaw), math.sin(yaw)
        self.turn, self.yaw, self.up = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]), yaw, up
        self._shift = np.array([*(root - self.turn[:2, :2] @ centre), up])

    def vectors(self, numbers: NDArray[np.float64]) -> NDArray[np.float64]:
        """(3 k,), k vectors."""
        return (numbers.reshape(-1, 3) @ self.turn.T).ravel()

    def points(self, numbers: NDArray[np.float64]) -> NDArray[np.float64]:
        """(3 k,), k points."""
        return (numbers.reshape(-1, 3) @ self.turn.T + self._shift).ravel()

    def plane_point(self, numbers: NDArray[np.float64]) -> NDArray[np.float64]:
        """(2,) a point from above."""
        return self.turn[:2, :2] @ numbers + self._shift[:2]

    def rotations(self, numbers: NDArray[np.float64]) -> NDArray[np.float64]:
        """(9 k,), k rotations, row by row."""
        return (self.turn @ numbers.reshape(-1, 3, 3)).ravel()

    def quaternion(self, numbers: NDArray[np.float64]) -> NDArray[np.float64]:
        """(4,)"""
        turn = np.array([math.cos(0.5 * self.yaw), 0.0, 0.0, math.sin(0.5 * self.yaw)])
        out = np.empty(4)
        mujoco.mju_mulQuat(out, turn, numbers)
        return out


def _carried_control(control: NDArray[np.float64], carry: _Carry) -> NDArray[np.float64]:
    out = control.copy()
    out[run.HEADING] += carry.yaw
    for part in (run.COM, run.FEET, run.PLANTED, run.COM_AT_SWITCH):
        out[part] = carry.points(control[part])
    out[run.COM_VELOCITY] = carry.vectors(control[run.COM_VELOCITY])
    return out


def _carried_walk(memory: NDArray[np.float64], carry: _Carry) -> NDArray[np.float64]:
    out = memory.copy()
    for part in (walk.WALK_HEADING, walk.FOOTHOLD_YAW, walk.LIFT_YAW, walk.TOLD):
        out[part] += carry.yaw
    for part in (walk.FOOTHOLD, walk.LIFT, walk.SEEN_SOLES, walk.SEEN_ANCHORS):
        out[part] = carry.points(memory[part])
    for part in (walk.FOOTHOLD_NORMAL, walk.LIFT_NORMAL, walk.SEEN_AXES, walk.ATTITUDES):
        out[part] = carry.vectors(memory[part])
    for part in (walk.SEEN_FEET, walk.SEEN_PELVIS):
        out[part] = carry.rotations(memory[part])
    out[walk.STEPPED_FROM] = carry.plane_point(memory[walk.STEPPED_FROM])
    out[walk.BODY_HEIGHT] += carry.up
    return out
