"""Starts from which a clearing skill is tried: usual ones, and ones that are hard or hopeless."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from locomotion.body.person import CONTROL_DT
from locomotion.ground.ground import FRICTION
from locomotion.preconditions.changes import BRAKE, END_RUN, SLOW_DOWN, WALK_TO_RUN
from locomotion.skills.jump.kind import JUMP
from locomotion.skills.kind import SkillKind
from locomotion.training.skills.vault import DEPTHS

__all__ = ["Start", "draw_change", "draw_slow_down", "draw_start"]

DISTANCES = (5.0, 16.0)
"""[m] from the start to the edge."""
_WALKED, _RUN = (2.5, 6.0), (3.0, 10.0)  # [m] to a change of gait, walking and running
_PUSHED_BEFORE = 2.5  # [m] before a change at most
_AHEAD = 0.5  # [m/s] by which a run's reference begins faster than the walk at most
_HARD, _HARD_PUSHES = 0.8, (200.0, 1000.0)  # share of those who are pushed before a run ends as learned; [N]
_HARDER = (0.9, 2.8)  # times the learned deceleration of braking
_BEYOND, _LOWER = 0.25, 0.3  # share of sizes out of the range; of these, below it
_STANDING, _PUSHED, _OTHER_GROUND, _SHAKEN, _VARIED = 0.65, 0.3, 0.4, 0.4, 0.7
# shares of starts: from a stand; pushed; on other than usual ground; with more than usual noise; with a
# run-up that is varied
_SPEEDS, _RUNNING = (2.8, 4.2), (2.2, 4.4)  # [m/s] asked for; at the start
_LEAST_GRIP, _MOST_GRIP = 0.7, 2.0
_USUAL_NOISE, _NOISE = 0.02, 0.2  # [m/s, rad/s]
_BESIDE, _ASKEW = 0.4, 0.2  # [m] and [rad] that a runner is off its path at the start
_FORCES, _PUSH_TIME, _PUSH_AT = (50.0, 300.0), 0.1, (1.5, 8.0)  # [N], [s], [m] before the edge
_MARKS, _ENTRIES, _STEPS = 0.12, 0.3, 4
# [m] and [m/s] by which a run-up is varied at most, from which of its first steps on
_DECELERATIONS, _LAST_STEP = (0.6, 3.0), 8  # [m/s²] tried; of the run-up to a stair, steps before which


@dataclass(frozen=True)
class Start:
    """A start.

    size, depth [m]: of the obstacle. distance [m] to its edge, or to a change of gait. speed [m/s] asked
    for. friction: of the ground. running: speed [m/s] at the start, 0 from a stand. beside [m], askew [rad]:
    off its path. noise [m/s, rad/s]: standard deviation of the velocities. push_at: [m] before the edge,
    push: [N] forward and to the left for ``push_ticks``. variation: farther mark [m] and faster entry [m/s],
    from that step of the run-up on; or deceleration [m/s²] with which it slows down there, and 0; or what
    else a change chooses (`preconditions.changes.CHANGE_FEATURES`).
    """

    size: float
    depth: float
    distance: float
    speed: float
    friction: float
    running: float
    beside: float
    askew: float
    noise: float
    push_at: float
    push: tuple[float, float]
    push_ticks: int
    variation: tuple[float, float]
    from_step: int


def draw_start(kind: SkillKind, rng: np.random.Generator) -> Start:
    """Draw a start. A quarter of the sizes are beyond those that people are to clear, by up to their
    span."""
    low, high = kind.sizes
    chance = rng.random(6)
    within, beyond = rng.uniform(low, high), rng.random()
    size = within
    if chance[0] < _BEYOND:
        below = chance[0] < _BEYOND * _LOWER
        size = low * (0.4 + 0.6 * beyond) if below else high + (high - low) * beyond
    standing = bool(chance[1] < _STANDING)
    grip, noise = rng.uniform(-1.0, 1.0), rng.uniform(_USUAL_NOISE, _NOISE)
    friction = FRICTION + (grip * (_MOST_GRIP - FRICTION) if grip > 0.0 else grip * (FRICTION - _LEAST_GRIP))
    force, side = rng.uniform(*_FORCES), rng.uniform(-math.pi, math.pi)
    variation, pushed = rng.uniform(-1.0, 1.0, 2), bool(chance[2] < _PUSHED)
    running, beside, askew = rng.uniform(*_RUNNING), rng.normal() * _BESIDE / 2.0, rng.normal() * _ASKEW / 2.0
    varied = bool(chance[5] < _VARIED)
    return Start(
        size=round(float(size), 3),
        depth=round(float(rng.uniform(*DEPTHS)), 3),
        distance=round(float(rng.uniform(*DISTANCES)), 3),
        speed=round(float(rng.uniform(*_SPEEDS)), 2),
        friction=round(float(friction), 3) if chance[3] < _OTHER_GROUND else FRICTION,
        running=0.0 if standing else round(float(running), 2),
        beside=0.0 if standing else round(float(beside), 3),
        askew=0.0 if standing else round(float(askew), 3),
        noise=round(float(noise), 3) if chance[4] < _SHAKEN else _USUAL_NOISE,
        push_at=float(rng.uniform(*_PUSH_AT)),
        push=(float(force * math.cos(side)), float(force * math.sin(side))) if pushed else (0.0, 0.0),
        push_ticks=round(_PUSH_TIME / CONTROL_DT) if pushed else 0,
        variation=(_MARKS * float(variation[0]), _ENTRIES * float(variation[1])) if varied else (0.0, 0.0),
        from_step=int(rng.integers(0, _STEPS)) if varied else 0,
    )


def draw_slow_down(rng: np.random.Generator) -> Start:
    """Draw a start of a run-up that is broken off."""
    start = draw_start(JUMP, rng)
    step, deceleration = int(rng.integers(0, _LAST_STEP)), float(rng.uniform(*_DECELERATIONS))
    return replace(start, size=JUMP.usual, variation=(deceleration, 0.0), from_step=step)


def draw_change(name: str, rng: np.random.Generator) -> Start:
    """Draw a start of a change on level ground, one of `preconditions.changes.CHANGES`."""
    start = draw_start(JUMP, rng)
    spread, running, way = rng.random(2), rng.uniform(*_RUNNING), rng.random()
    walks = name == WALK_TO_RUN
    low, high = _WALKED if walks else _RUN
    choice, push, pushed = (0.0, 0.0), start.push, start.push_ticks > 0
    if walks:
        choice = (float(spread[0] < 0.5), round(max(_AHEAD * (2.0 * float(spread[1]) - 1.0), 0.0), 3))
    elif name in (SLOW_DOWN, BRAKE):
        least, most = _DECELERATIONS if name == SLOW_DOWN else _HARDER
        choice = (round(least + (most - least) * float(spread[0]), 3), 0.0)
    elif name == END_RUN:  # what ends it holds nearly always, unless it is pushed hard
        force, side, pushed = rng.uniform(*_HARD_PUSHES), rng.uniform(-math.pi, math.pi), spread[0] < _HARD
        push = (float(force * math.cos(side)), float(force * math.sin(side))) if pushed else (0.0, 0.0)
    return replace(
        start, size=JUMP.usual, distance=round(low + (high - low) * float(way), 3), variation=choice,
        running=0.0 if walks else round(float(running), 2),
        push_at=_PUSHED_BEFORE * start.push_at / _PUSH_AT[1],
        push=push, push_ticks=round(_PUSH_TIME / CONTROL_DT) if pushed else 0,
    )  # fmt: skip
