"""Cycles of walking and running, from the simulation: averaged over strides, and the same on both sides."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import CONTROL_DT
from locomotion.clips.motion import lowest_points
from locomotion.errors import LocomotionError
from locomotion.gaits.policy.layout import FORCES, PHASE
from locomotion.gaits.policy.skill import load_policy
from locomotion.gaits.run.controller import CONTACT
from locomotion.human.human import Human
from locomotion.recorded.motion_set import Clip
from locomotion.recorded.takes.take import RATE, Take, Told, mirrored, spread
from locomotion.training.policies.trial import PolicyTrial

__all__ = ["RUNS", "WALKS", "averaged", "run_cycles", "walk_cycles"]

WALKS = (0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0)
"""[m/s] asked of the learned walk."""
RUNS = (2.5, 3.0, 3.5, 4.0, 4.5, 5.0)
"""[m/s] asked of the run."""
_STANDS, _WARM_UP, _NOTED = 1.0, 5.0, 12.0  # [s]
_STRUCK = 30.0  # [N] on a foot that has struck
_BEARS = 100.0  # [N] on a foot that bears, in the mean of strides
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
        held, qpos, forces, phases = trial.go(_WARM_UP), [], [], []
        for _ in range(round(_NOTED / CONTROL_DT)):
            trial.tick()
            qpos.append(trial.data.qpos[:46].copy())
            forces.append(trial.felt[FORCES].reshape(2, 2).sum(axis=1))
            phases.append(trial.memory[PHASE])
        if not held or trial.fallen:
            raise LocomotionError(f"the learned walk fell at {asked:g} m/s; nothing was recorded")
        origin = f"simulation of the learned walk (walk_policy.npz), asked for {asked:g} m/s"
        takes.append(averaged(f"walk {asked:g}", np.array(qpos), np.array(forces), _steady(phases), origin))
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
        pressed = np.array(forces)
        takes.append(
            averaged(f"run {asked:g}", np.array(qpos), pressed, _phases(pressed[:, 0] > _STRUCK), origin)
        )
    return takes


def averaged(
    name: str,
    qpos: NDArray[np.float64],
    forces: NDArray[np.float64],
    phases: NDArray[np.float64],
    origin: str,
) -> Take:
    """One cycle of a steady gait along x: the mean of its strides and their mirror images. The first word
    of its ``name`` is the gait.

    From ticks: ``qpos`` (n, 46), ``forces`` (n, 2) under the right and the left foot [N], and ``phases``
    (n,), which grow by 1 with each cycle. The cycle begins with the strike of the right foot. Raises
    `LocomotionError` for fewer than three cycles, and if no foot bears.
    """
    strides = int(phases[-1] - phases[0])
    if strides < 3:
        raise LocomotionError(f"{name}: {strides} strides, expected at least 3")
    moments = phases[0] + np.arange(strides * _FINE + 1) / _FINE
    ticks = np.interp(moments, phases, np.arange(len(phases)))
    seconds = (ticks[-1] - ticks[0]) / strides * CONTROL_DT
    rows = spread(qpos, ticks / (len(qpos) - 1), cyclic=False)
    length = (rows[-1, 0] - rows[0, 0]) / strides
    rows[:, 0] -= length * np.arange(len(rows)) / _FINE
    rows[:, :2] -= rows[:-1, :2].mean(axis=0)
    mean = rows[:-1].reshape(strides, _FINE, -1).mean(axis=0)
    mean = 0.5 * (mean + np.roll(mirrored(mean), _FINE // 2, axis=0))
    mean[:, 3:7] /= np.linalg.norm(mean[:, 3:7], axis=1, keepdims=True)
    pressed = np.array([np.interp(ticks[:-1], np.arange(len(forces)), side) for side in forces.T])
    pressed = pressed.reshape(2, strides, _FINE).mean(axis=1)
    strike, bears = _longest(0.5 * (pressed[0] + np.roll(pressed[1], _FINE // 2)) > _BEARS)
    if bears == 0:
        raise LocomotionError(f"{name}: its feet do not bear")
    mean = np.roll(mean, -strike, axis=0)
    mean[:, 2] -= np.quantile(lowest_points(mean), 0.1)
    count = max(round(seconds * RATE), 8)
    shares = np.arange(count) / count
    stance = np.array([(shares - begin) % 1.0 < bears / _FINE for begin in (0.0, 0.5)]).T
    speed = round(float(length / seconds), 3)
    gait = name.split()[0]
    clip = Clip(
        name=name, kind="cycle", gait=gait, origin=origin, seconds=seconds, speed=speed,
        travel=(speed * seconds, 0.0, 0.0), rest="stand" if gait == "walk" else "", bears=bears / _FINE,
    )  # fmt: skip
    return Take(clip, spread(mean, shares, cyclic=True), stance)


def _steady(phases: list[float]) -> NDArray[np.float64]:
    """Phases (n,) that go on from cycle to cycle, of ticks that hold them for some ticks at a time."""
    whole = np.unwrap(phases, period=1.0)
    known = np.flatnonzero(np.diff(whole, prepend=whole[0] - 1.0) > 0.0)
    rate = (whole[known[-1]] - whole[known[0]]) / (known[-1] - known[0])
    ticks = np.arange(len(whole))
    within = np.interp(ticks, known, whole[known])
    return within + rate * (np.minimum(ticks - known[0], 0) + np.maximum(ticks - known[-1], 0))


def _longest(bears: NDArray[np.bool_]) -> tuple[int, int]:
    """Begin and length of the longest stretch of a cycle, which may go on from its end to its beginning."""
    best = (0, 0)
    for begin in np.flatnonzero(bears & ~np.roll(bears, 1)).tolist():
        length = int(np.argmin(np.append(np.roll(bears, -begin), False)))
        best = max(best, (begin, length), key=lambda each: each[1])
    return best


def _phases(bears: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Phases (n,) of ticks: whole numbers where a foot begins to bear after it did not for 0.1 s."""
    pause = round(0.1 / CONTROL_DT)
    began = np.flatnonzero(bears[1:] & ~bears[:-1]) + 1
    strikes = np.array([k for k in began if k >= pause and not bears[k - pause : k].any()])
    if len(strikes) < 2:
        raise LocomotionError(f"{len(strikes)} strikes of a foot, expected at least 2")
    numbers, rate = np.arange(len(strikes)), (len(strikes) - 1) / (strikes[-1] - strikes[0])
    ticks = np.arange(len(bears))
    within = np.interp(ticks, strikes, numbers)
    return within + rate * (np.minimum(ticks - strikes[0], 0) + np.maximum(ticks - strikes[-1], 0))
