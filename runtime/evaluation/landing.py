"""Trials of clearing obstacles without rehearsals, with the network that corrects landings and without."""

import math
from functools import partial

import numpy as np
from numpy.typing import NDArray

from locomotion import MOVING, Ground, Human
from locomotion.body_events import Cleared
from locomotion.human.human import BetweenGaits
from locomotion.skills.course import make_course
from locomotion.skills.registry import skill_kinds
from locomotion.training.skills.vault import DEPTHS
from runtime.evaluation.courses import SPEED
from runtime.evaluation.evaluation import Attempt, Trial, start_noise

__all__ = ["landing_residual_trials"]

PUSH = 200.0
"""[N] at the waist for 0.1 s."""
_DISTANCES, _WITHIN = (9.0, 16.0), 150  # [m] to the edge; ticks after the landing in which a push begins
_PUSHED, _STAYS, _LONGEST = 10, 300, 3000  # ticks of a push; behind the obstacle, without a fall; of a trial


def landing_residual_trials(trials: int, seed: int) -> list[Trial]:
    """Four tests of ``trials`` for each kind of obstacle, of any size: people start 9 to 16 m away from a
    stand, clear it without rehearsals, and stay up for 3 s behind it: as planned, and corrected; both also
    pushed with `PUSH` from any side after the landing."""
    rng, tried = np.random.default_rng([seed, 8]), []
    for kind in skill_kinds():
        for number in range(trials):
            size, depth = float(rng.uniform(*kind.sizes)), float(rng.uniform(*DEPTHS))
            distance = float(rng.uniform(*_DISTANCES))
            push = int(rng.integers(0, _WITHIN)), float(rng.uniform(0.0, 2.0 * math.pi))
            noise = start_noise(seed + number, distance)
            for corrected in (False, True):
                for pushed in (None, push):
                    tried.append(
                        partial(_land, kind.affordance, (size, depth, distance), noise, corrected, pushed)
                    )
    return tried


def _land(
    affordance: str,
    obstacle: tuple[float, float, float],
    noise: NDArray[np.float64],
    corrected: bool,
    push: tuple[int, float] | None,
) -> Attempt:
    size, depth, distance = obstacle
    course = make_course([(affordance, size, depth)], [distance])
    ground = Ground.from_arrays(course.vertices, course.faces)
    human = Human(ground, rehearsals=0, between=BetweenGaits(landing=True if corrected else None))
    human.reset(course.path[0], 0.0)
    human.data.qvel[:] += noise
    human.follow(course.path, SPEED, course.obstacles)
    landing, waist = human.on_feet.landing, human.model.body("waist").id
    landed = stayed = 0
    cleared = False
    while human.status in MOVING and human.ticks < _LONGEST and stayed < _STAYS:
        landed += landing.decides
        pushing = push is not None and 0 < landed - push[0] <= _PUSHED and landing.decides
        force = (PUSH * math.cos(push[1]), PUSH * math.sin(push[1])) if push and pushing else (0.0, 0.0)
        human.data.xfrc_applied[waist, :2] = force
        human.tick()
        cleared = cleared or any(isinstance(event, Cleared) for event in human.events)
        stayed += cleared
    held = stayed == _STAYS or human.status == "arrived"
    ends = "stays up" if held else f"{human.status} {'behind it' if landed else 'before'}"
    test = f"{affordance}, {'corrected' if corrected else 'as planned'}"
    test += f", pushed with {PUSH:.0f} N" if push else ""
    what = f"{size:.2f} m, {depth:.2f} m thick, from {distance:.1f} m"
    return Attempt(test, what, ends, held, compared=not corrected)
