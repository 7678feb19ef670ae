"""The curriculum of running: its stages, from the first steps to the whole range, and their trials."""

from functools import partial
from typing import Any, NamedTuple

import numpy as np

from locomotion.training.gaits.run_genes import (
    DOWN,
    LEVEL,
    STRAIGHT,
    UP,
    genes_scale,
    inner_scale,
    rows_scale,
)
from locomotion.training.search.loop import Stage
from locomotion.training.training import Training

__all__ = ["BEGINNINGS", "WAYS", "beginning", "curriculum"]

BEGINNINGS = 8
"""How often training starts over to continue from the best: fewer than half of the attempts learn to run."""

WAY: dict[str, Any] = {"length": (12.0, 20.0), "beyond": 10.0, "radius": 6.0, "speeds": (2.6, 3.6)}
"""A path to run after a few walked steps, without bends in which it would walk."""
_WAY_TAKES = 9.0  # [s]
_PUSHED = {
    "speeds": (3.2, 3.7), "steady": True, "push": 330.0, "weakest": 0.7, "noise": 0.3, "duration": 7.0,
}  # fmt: skip
_ANY_SPEED = {"speeds": (2.6, 3.9), "steady": True, "push": 250.0, "noise": 0.3, "duration": 7.0}
_FROM_A_WALK = {"speeds": (2.8, 3.6), "walking": 1.0, "push": 100.0, "noise": 0.1, "duration": 5.0}
_SLOW_RUN = {"speeds": (1.7, 2.3), "steady": True, "noise": 0.3, "push": 200.0, "duration": 4.0}
WAYS = (
    WAY, _FROM_A_WALK, {**WAY, "ground": "gentle"}, _ANY_SPEED, {**WAY, "push": 60.0},
    {**WAY, "length": (10.0, 12.0)}, _SLOW_RUN,
)  # fmt: skip
HARD_PUSHES = (
    WAY, _PUSHED, {**WAY, "ground": "gentle"}, _PUSHED, _ANY_SPEED, _PUSHED, {**WAY, "length": (10.0, 12.0)},
    _PUSHED, _FROM_A_WALK, _SLOW_RUN,
)  # fmt: skip
_STEADY = {"steady": True, "noise": 0.3, "duration": 4.0}
SLOW = ({**_STEADY, "speeds": (1.95, 2.45), "lateral": 1.0},)
SLOWER = (
    {**_STEADY, "speeds": (1.5, 2.2)},
    {**_STEADY, "speeds": (1.7, 2.4), "push": 200.0},
    {**_STEADY, "speeds": (1.7, 2.4), "lateral": 1.4},
)
FASTER = ({**_STEADY, "speeds": (4.1, 4.6), "lateral": 1.2},)
FASTEST = ({**_STEADY, "speeds": (4.3, 5.0), "lateral": 1.6},)
_BEND, _PUSH = {**_STEADY, "lateral": 1.9, "duration": 7.0}, {**_STEADY, "push": 330.0, "duration": 5.0}
FAST_ROW = {**_BEND, "speeds": (3.6, 4.4)}, {**_PUSH, "speeds": (3.7, 4.4)}
_FAST_BEND, _FAST_PUSH = {**_BEND, "speeds": (3.9, 5.0)}, {**_PUSH, "speeds": (3.9, 5.0)}
FAST_BENDS_AND_PUSHES = _FAST_BEND, _FAST_PUSH, _FAST_PUSH
_TOP_PUSH = {**_PUSH, "speeds": (4.85, 5.0), "push": 360.0}
_TOP_BEND = {**_STEADY, "speeds": (4.6, 5.0), "lateral": 2.0, "duration": 6.0}
TOP = (
    _TOP_PUSH, _FAST_BEND, _FAST_PUSH, _TOP_BEND, *(_TOP_PUSH,) * 3, {**_TOP_PUSH, "speeds": (4.5, 5.0)},
)  # fmt: skip
_CIRCLE = {**_STEADY, "circle": True, "lateral": 1.7, "duration": 10.0}
_ROUND, _ROUND_FAST = {**_CIRCLE, "speeds": (3.6, 4.3)}, {**_CIRCLE, "speeds": (4.3, 5.0)}
_BLOW = {**_PUSH, "speeds": (3.6, 5.0), "push": 330.0, "weakest": 0.8}
_TOP_BLOW = {**_BLOW, "speeds": (4.85, 5.0)}
SURE = (
    _ROUND, _TOP_BLOW, _ROUND_FAST, _BLOW, {**_CIRCLE, "speeds": (4.85, 5.0)}, _TOP_BLOW,
    {**_CIRCLE, "speeds": (3.6, 5.0), "push": 250.0}, {**_BLOW, "speeds": (4.1, 4.9)}, _TOP_BLOW,
    {**_BLOW, "speeds": (3.6, 4.3)}, _TOP_BLOW, _BLOW,
)  # fmt: skip
_LANDS: dict[str, Any] = {**_STEADY, "duration": 6.0}
_SETS_OFF = {**_FROM_A_WALK, "push": 220.0, "weakest": 0.7, "duration": 6.0}
SOFT = (
    {**_LANDS, "speeds": (2.4, 3.2)}, {**_SETS_OFF, "speeds": (2.5, 3.0)}, {**_BLOW, "speeds": (2.6, 3.3)},
    {**_CIRCLE, "speeds": (2.5, 3.6)}, {**_SETS_OFF, "speeds": (2.9, 3.6)}, {**_LANDS, "speeds": (3.1, 3.8)},
    {**_BLOW, "speeds": (3.3, 3.8)}, {**_BEND, "speeds": (2.6, 4.6)}, {**_SETS_OFF, "speeds": (3.5, 4.6)},
    {**_BLOW, "speeds": (3.4, 4.1)}, {**_LANDS, "speeds": (3.7, 4.6)}, {**_CIRCLE, "speeds": (3.6, 4.8)},
    {**_SETS_OFF, "speeds": (2.6, 4.0)}, {**_BLOW, "speeds": (3.9, 4.8)},
)  # fmt: skip
_SLOW_PUSH = {**_STEADY, "speeds": (1.8, 2.3), "push": 330.0, "duration": 5.0}
SLOW_PUSHES = (
    _SLOW_PUSH, {**_SLOW_PUSH, "speeds": (1.8, 2.5), "lateral": 1.2, "push": 60.0},
    _SLOW_PUSH, _FROM_A_WALK,
)  # fmt: skip
FAST: dict[str, Any] = {"speeds": (2.4, 4.4), "steady": True, "noise": 0.4, "push": 100.0}
SPEEDS = ({"speeds": (2.9, 4.1), "duration": 5.0, "noise": 0.5, "push": 100.0, "lateral": 0.7},)
TIGHT_BENDS = ({**FAST, "duration": 5.0, "lateral": 2.2, "push": 0.0},)
FLAT, BENDS = {"lateral": 0.0}, {"lateral": 1.8}
HILLS = {"tilt": 0.18}, BENDS, {"tilt": 0.18, "lateral": 1.2}
EVERY = genes_scale(1, 0.5, 0, *LEVEL) + rows_scale(slow=0.5, slowest=0.5)


def set_off(slowest: float, fastest: float) -> tuple[dict[str, Any], ...]:
    """Kinds of trials that set off from a walk to a speed [m/s]; they include slow runs, which share rows."""
    walked = {"walking": 1.0, "noise": 0.1, "speeds": (slowest, fastest)}
    return walked, walked, _SLOW_RUN, walked


class _Plan(NamedTuple):
    """A stage; ``fall``: cost of each fall besides the time lost, ``soft``: cost of hard landings and wrong
    step rates."""

    name: str
    generations: int
    sigma: float
    scale: np.ndarray
    trials: int
    kinds: tuple[dict, ...] = ({},)
    style: float = 0.4
    fall: float = 0.0
    soft: float = 0.0
    population: int = 32


def _stage(training: Training, plan: _Plan, **trial: Any) -> Stage:
    """The stage of a ``plan`` with trials as of `TrialKind`."""
    kinds, trials = plan.kinds, plan.trials
    options = {
        "trials": trials, "style": plan.style, "fall": plan.fall, "soft": plan.soft, "trial": trial,
        "kinds": kinds,
    }  # fmt: skip
    seconds = sum((trial | kinds[i % len(kinds)]).get("duration", _WAY_TAKES) for i in range(trials))
    return Stage(
        plan.name, training.generations(plan.generations), plan.sigma, plan.scale, options, plan.population,
        seconds,
    )  # fmt: skip


def beginning(training: Training) -> tuple[Stage, ...]:
    """The stages from scratch to four seconds of running. They do not always get there: see `BEGINNINGS`."""
    stage, scale = partial(_stage, training), genes_scale(1, 0, 0, *STRAIGHT)
    return (
        stage(_Plan("first steps", 8, 0.20, scale, 1, style=0.1, population=48), duration=0.8, noise=0.2),
        stage(_Plan("first second", 25, 0.18, scale, 1, style=0.1, population=48), duration=1.6, noise=0.2),
        stage(_Plan("four seconds", 45, 0.18, scale, 1, style=0.1, population=48), duration=4.0, noise=0.2),
    )


def curriculum(training: Training) -> tuple[Stage, ...]:
    """The stages from there to the whole range."""
    stage = partial(_stage, training)
    middle, family = genes_scale(1, 0, 0, *STRAIGHT), genes_scale(1, 1, 0, *LEVEL)
    up, down = genes_scale(1, 0, 0, *UP), genes_scale(1, 0, 0, *DOWN)
    steep: dict[str, Any] = {"speeds": (2.5, 3.4), "noise": 0.3, "duration": 4.0}
    high, top = rows_scale(fast=0.5, faster=1, fastest=1), rows_scale(fast=0.2, faster=0.5, fastest=1)
    whole = rows_scale(fast=1, faster=1, fastest=1)
    lowest, inner = rows_scale(slow=0.5, slowest=1), inner_scale(*STRAIGHT)
    everywhere = genes_scale(1, 0, 0, *LEVEL, *UP, *DOWN)
    return (
        stage(_Plan("twelve seconds", 40, 0.16, middle, 2), duration=10.0, noise=0.2),
        stage(_Plan("pushes", 40, 0.07, middle, 6), duration=6.0, noise=0.5, push=60.0),
        stage(_Plan("speeds", 30, 0.06, genes_scale(1, 1, 1, *LEVEL), 5, SPEEDS)),
        stage(_Plan("flat", 15, 0.05, family, 5), duration=4.5, **FAST),
        stage(_Plan("bends", 40, 0.045, family, 8, (FLAT, BENDS, BENDS, BENDS)), duration=4.0, **FAST),
        stage(_Plan("gentle climbs", 16, 0.10, up, 3, style=0.2), climb=(0.06, 0.16), **steep),
        stage(_Plan("climbs", 25, 0.08, up, 4, style=0.2), climb=(0.05, 0.24), push=40.0, **steep),
        stage(_Plan("gentle descents", 10, 0.10, down, 3, style=0.2), climb=(-0.16, -0.06), **steep),
        stage(_Plan("descents", 15, 0.08, down, 4, style=0.2), climb=(-0.24, -0.05), push=40.0, **steep),
        stage(_Plan("tight bends", 20, 0.06, genes_scale(1, 0, 0, "turn", "bend"), 4, TIGHT_BENDS)),
        stage(_Plan("hills", 30, 0.04, everywhere, 6, HILLS), duration=4.0, **FAST),
        stage(_Plan("slow", 25, 0.05, rows_scale(slow=1), 5, SLOW, style=0.3)),
        stage(_Plan("slower", 20, 0.05, rows_scale(slow=1, slowest=0.5), 6, SLOWER, style=0.3)),
        stage(_Plan("jog on", 12, 0.05, lowest, 3, set_off(1.5, 1.7), style=0.3), duration=3.0),
        stage(_Plan("set off slowly", 20, 0.04, lowest, 4, set_off(1.6, 2.6), style=0.3), duration=3.0),
        stage(_Plan("set off", 40, 0.04, lowest, 4, set_off(2.4, 3.6), style=0.3), duration=4.0),
        stage(_Plan("ways", 40, 0.04, EVERY, len(WAYS), WAYS, style=0.3)),
        stage(_Plan("hard pushes", 40, 0.025, EVERY, len(HARD_PUSHES), HARD_PUSHES, style=0.3, fall=3.0)),
        stage(_Plan("slow pushes", 30, 0.04, rows_scale(slow=1), 8, SLOW_PUSHES, style=0.3, fall=3.0)),
        stage(_Plan("faster", 25, 0.05, rows_scale(faster=1), 5, FASTER, style=0.3)),
        stage(_Plan("fastest", 40, 0.05, rows_scale(faster=0.5, fastest=1), 5, FASTEST, style=0.3)),
        stage(_Plan("fast", 30, 0.04, rows_scale(fast=1, faster=0.3), 8, FAST_ROW, style=0.3, fall=6.0)),
        stage(_Plan("fast bends and pushes", 30, 0.03, high, 10, FAST_BENDS_AND_PUSHES, style=0.3, fall=6.0)),
        stage(_Plan("top", 60, 0.03, top, 12, TOP, style=0.3, fall=6.0)),
        stage(_Plan("sure", 60, 0.025, whole, len(SURE), SURE, style=0.3, fall=6.0)),
        stage(_Plan("soft", 60, 0.025, inner, len(SOFT), SOFT, style=0.3, fall=6.0, soft=8.0)),
    )
