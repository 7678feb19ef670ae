"""Trials of the walk and run that networks control: at all speeds, pushed from all sides, and with orders
that change."""

import math
from functools import partial

import numpy as np
from numpy.typing import NDArray

from locomotion.body.traits import by_chance
from locomotion.gaits.policy.skill import PolicySkill, load_policy
from locomotion.training.policies.trial import PolicyTrial
from runtime.evaluation.evaluation import Attempt, Trial

__all__ = ["walk_policy_trials"]

SPEEDS, RUNS, TURN = (0.4, 2.0), (2.5, 5.0), 0.8
"""[m/s] of the walk and the run, and [rad/s] of the walk, that are asked for."""
PUSH = 300.0
"""[N] at the waist for 0.1 s."""
_STANDS, _WALKS, _ON, _SCRIPT = 1.0, 8.0, 5.0, 60.0  # [s]
_SIDEWAYS = 1.2  # [m/s^2] in a bend of a run
_CHANGE = (1.5, 5.0)  # [s] between orders
_STANDING, _ON_THE_SPOT = 0.15, 0.1  # shares of the orders that are to stand, and to turn on the spot


def walk_policy_trials(trials: int, seed: int) -> list[Trial]:
    """Seven tests of ``trials`` each: from a stand to a speed and on, with a turn; the same with a push of
    `PUSH` from any side at any moment; a minute of orders to walk, turn, also on the spot, stop and start;
    the same three of the run, whose orders are to walk or run; and the last one by people who differ.
    """
    tried: list[Trial] = []
    rng, skill = np.random.default_rng(seed), load_policy()
    for k in range(trials):
        speed, turn = float(rng.uniform(*SPEEDS)), float(rng.uniform(-TURN, TURN))
        angle, moment = float(rng.uniform(0.0, 2.0 * math.pi)), float(rng.uniform(0.0, 1.2))
        tried.append(partial(_walk, skill, "walk", speed, turn, moment))
        tried.append(partial(_walk, skill, f"pushed with {PUSH:.0f} N", speed, 0.0, moment, angle))
        tried.append(partial(_script, skill, "start, stop, turn", SPEEDS, (seed, k)))
        speed = float(rng.uniform(*RUNS))
        turn = float(rng.uniform(-1.0, 1.0)) * _SIDEWAYS / speed
        tried.append(partial(_walk, skill, "run", speed, turn, moment))
        tried.append(partial(_walk, skill, f"run, pushed with {PUSH:.0f} N", speed, 0.0, moment, angle))
        tried.append(partial(_script, skill, "run, walk, stop, turn", (SPEEDS[0], RUNS[1]), (seed, k, 1)))
        own = by_chance(seed * trials + k)
        tried.append(partial(_script, skill, "the same, anybody", (SPEEDS[0], RUNS[1]), (seed, k, 2), own))
    return tried


def _walk(
    skill: PolicySkill, test: str, speed: float, turn: float, moment: float, angle: float | None = None
) -> Attempt:
    trial = PolicyTrial(skill)
    trial.go(_STANDS)
    trial.asked[:] = speed, turn
    held = trial.go(_WALKS + moment)
    if angle is not None:
        trial.push(PUSH, angle)
    held = held and trial.go(_ON)
    what = (
        f"{speed:.2f} m/s, {turn:+.2f} rad/s"
        if angle is None
        else f"{speed:.2f} m/s, from {math.degrees(angle):.0f} degrees"
    )
    return Attempt(test, what, "walks" if held else "fallen", held)


def _script(
    skill: PolicySkill,
    test: str,
    speeds: tuple[float, float],
    seed: tuple[int, ...],
    traits: NDArray[np.float64] | None = None,
) -> Attempt:
    rng = np.random.default_rng(seed)
    trial, passed, held = PolicyTrial(skill, traits), 0.0, True
    while held and passed < _SCRIPT:
        kind, speed, turn = rng.random(), rng.uniform(*speeds), rng.uniform(-TURN, TURN)
        if speed > SPEEDS[1]:
            turn *= _SIDEWAYS / (speed * TURN)
        stays, stands = kind < _STANDING + _ON_THE_SPOT, kind < _STANDING
        trial.asked[:] = 0.0 if stays else speed, 0.0 if stands else turn
        lasts = float(rng.uniform(*_CHANGE))
        held, passed = trial.go(lasts), passed + lasts
    return Attempt(test, f"a minute, {passed:.0f} s of it", "walks" if held else "fallen", held)
