"""Cycles of walking and running, from the simulation: averaged over strides, and the same on both sides."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import CONTROL_DT
from locomotion.clips.motion import lowest_points
from locomotion.errors import LocomotionError
from locomotion.gaits.policy.layout import FORCES
from locomotion.gaits.policy.skill import load_policy
from locomotion.gaits.run.controller import CONTACT
from locomotion.human.human import Human
from locomotion.recorded.motion_set import Clip
from locomotion.recorded.takes.take import RATE, Take, Told, mirrored, spread
from locomotion.training.policies.trial import PolicyTrial

__all__ = ["RUNS", "WALKS", "averaged", "run_cycles", "walk_cycles"]

WALKS = (0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0)
"""[m/s] asked of the learned walk; it is a little slower."""
RUNS = (2.5, 3.0, 3.5, 4.0, 4.5, 5.0)
"""[m/s] asked of the run."""
_STANDS, _WARM_UP, _NOTED = 1.0, 5.0, 12.0  # [s]
_BEARS = 30.0  # [N] on a foot that bears
_FINE = 240  # moments of a cycle that strides are averaged at


@dataclass(frozen=True)
class _Course:
    """What a simulation did: ``qpos`` (n, 46) and ``forces`` (n, 2) [N] under the right and left foot, per
    control tick."""

    qpos: NDArray[np.float64]
    forces: NDArray[np.float64]


def walk_cycles(told: Told) -> list[Take]:
    """The learned walk at `WALKS`."""
    skill, takes = load_policy(), []
    for k, asked in enumerate(WALKS):
        told(k / len(WALKS), f"walk at {asked:g} m/s")
        trial = PolicyTrial(skill)
        trial.go(_STANDS)
        trial.asked[0] = asked
        held, qpos, forces = trial.go(_WARM_UP), [], []
        for _ in range(round(_NOTED / CONTROL_DT)):
            trial.tick()
            qpos.append(trial.data.qpos[:46].copy())
            forces.append(trial.felt[FORCES].reshape(2, 2).sum(axis=1))
        if not held or trial.fallen:
            raise LocomotionError(f"the learned walk fell at {asked:g} m/s; nothing was recorded")
        origin = f"simulation of the learned walk (walk_policy.npz), asked for {asked:g} m/s"
        takes.append(averaged("walk", np.array(qpos), np.array(forces), origin))
    return takes


def run_cycles(told: Told) -> list[Take]:
    """The run at `RUNS`."""
    takes = []
    for k, asked in enumerate(RUNS):
        told(k / len(RUNS), f"run at {asked:g} m/s")
        human = Human(None, clearing=(), rehearsals=0)
        human.reset(np.zeros(3), 0.0, asked)
        human.follow(np.array([[0.0, 0.0, 0.0], [1000.0, 0.0, 0.0]]), asked)
        qpos, forces = [], []
        for tick in range(round((_WARM_UP + _NOTED) / CONTROL_DT)):
            human.tick()
            if tick >= _WARM_UP / CONTROL_DT:
                qpos.append(human.qpos)
                forces.append(human.control[CONTACT].copy())
        if human.status != "running" or human.gait_now != "run":
            raise LocomotionError(f"the run at {asked:g} m/s ended: {human.status}; nothing was recorded")
        origin = f"simulation of the run (run.npz), asked for {asked:g} m/s"
        takes.append(averaged("run", np.array(qpos), np.array(forces), origin))
    return takes


def averaged(gait: str, qpos: NDArray[np.float64], forces: NDArray[np.float64], origin: str) -> Take:
    """One cycle of a steady gait along x, from ticks ``qpos`` (n, 46) with the ``forces`` (n, 2) under the
    right and the left foot: the mean of its strides and their mirror images. It begins with the strike of
    the right foot."""
    strikes = _strikes(forces[:, 0] > _BEARS)
    if len(strikes) < 4:
        raise LocomotionError(f"{gait}: {len(strikes)} strikes of the right foot, expected at least 4")
    strides = len(strikes) - 1
    seconds = (strikes[-1] - strikes[0]) / strides * CONTROL_DT
    ticks = np.interp(np.arange(strides * _FINE) / _FINE, np.arange(len(strikes)), strikes)
    rows = spread(qpos, ticks / (len(qpos) - 1), cyclic=False)
    length = (qpos[strikes[-1], 0] - qpos[strikes[0], 0]) / strides
    rows[:, 0] -= length * np.arange(len(rows)) / _FINE
    rows[:, :2] -= rows[:, :2].mean(axis=0)
    mean = rows.reshape(strides, _FINE, -1).mean(axis=0)
    mean = 0.5 * (mean + np.roll(mirrored(mean), _FINE // 2, axis=0))
    mean[:, 3:7] /= np.linalg.norm(mean[:, 3:7], axis=1, keepdims=True)
    bears = np.array([np.interp(ticks, np.arange(len(forces)), side) for side in forces.T])
    bears = bears.reshape(2, strides, _FINE).mean(axis=1)
    bears = 0.5 * (bears + np.roll(bears[::-1], _FINE // 2, axis=1))
    mean[:, 2] -= np.quantile(lowest_points(mean), 0.1)
    shares = np.arange(max(round(seconds * RATE), 8)) / max(round(seconds * RATE), 8)
    stance = np.array([np.interp(shares, np.arange(_FINE) / _FINE, side) > _BEARS for side in bears]).T
    speed = round(float(length / seconds), 3)
    clip = Clip(
        name=f"{gait} {speed:.2f}", kind="cycle", gait=gait, origin=origin, seconds=seconds, speed=speed,
        travel=(speed * seconds, 0.0, 0.0), rest="stand" if gait == "walk" else "",
    )  # fmt: skip
    return Take(clip, spread(mean, shares, cyclic=True), stance)


def _strikes(bears: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Ticks at which a foot begins to bear after it did not for 0.1 s."""
    pause = round(0.1 / CONTROL_DT)
    began = np.flatnonzero(bears[1:] & ~bears[:-1]) + 1
    return np.array([k for k in began if k >= pause and not bears[k - pause : k].any()], np.int64)
