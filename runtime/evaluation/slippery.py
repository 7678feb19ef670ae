"""Trials of the drop-roll on slippery ground."""

from functools import partial

import numpy as np

from locomotion import MOVING
from locomotion.preconditions.moments import make_slippery
from locomotion.rehearsal.choices import REHEARSALS
from locomotion.skills.course import make_course
from locomotion.skills.drop_roll.kind import DROP_ROLL
from locomotion.skills.drop_roll.slippery import load_slippery_roll
from runtime.evaluation.courses import enter_course
from runtime.evaluation.evaluation import Attempt, Trial, start_noise

__all__ = ["slippery_roll_trials"]

_DISTANCES = (9.0, 16.0)  # [m] to the edge
_LONGEST = 6000  # ticks of a trial


def slippery_roll_trials(trials: int, seed: int) -> list[Trial]:
    """Two tests of ``trials`` each, on ground as slippery as it was learned for: people start from a stand 9
    to 16 m before an edge, roll off it and arrive 15 m behind it, with rehearsals and without."""
    rng, tried = np.random.default_rng([seed, 9]), []
    for number in range(trials):
        height, distance = float(rng.uniform(*DROP_ROLL.sizes)), float(rng.uniform(*_DISTANCES))
        for rehearsals in (0, REHEARSALS):
            tried.append(partial(_try, height, distance, seed + number, rehearsals))
    return tried


def _try(height: float, distance: float, seed: int, rehearsals: int) -> Attempt:
    course, friction = (
        make_course([(DROP_ROLL.affordance, height, 0.0)], [distance]),
        load_slippery_roll().friction,
    )
    human = enter_course(course, noise=start_noise(seed, distance), rehearsals=rehearsals)
    assert human.ground is not None
    human.ground.friction = friction
    make_slippery(human.model, friction)
    while human.status in MOVING and human.ticks < _LONGEST:
        human.tick()
    test = f"friction {friction:g}, {'with' if rehearsals else 'without'} rehearsals"
    what = f"{height:.2f} m from {distance:.1f} m"
    return Attempt(test, what, human.status, human.status == "arrived", compared=not rehearsals)
