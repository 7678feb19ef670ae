"""Persons that walk and are about to run, from which trials of setting off start."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from locomotion.body import Human
from locomotion.errors import LocomotionError
from locomotion.gaits import run_entry_speed
from locomotion.human_state import HumanState

__all__ = ["WALK_STARTS", "WalkStart", "walk_starts"]

WALK_STARTS = 24
"""How many there are."""
_NOISE = 0.05  # [m/s, rad/s] of the velocities with which they begin to walk
_WAY = np.array([[0.0, 0.0, 0.0], [60.0, 0.0, 0.0]])


class WalkStart(NamedTuple):
    """A person in the tick in which it can go over from its walk to its run, and its speed [m/s]."""

    state: HumanState
    speed: float


@lru_cache(maxsize=1)
def walk_starts() -> tuple[WalkStart, ...]:
    """The package's walk on a plane along x, each time with other velocities at its start.

    Raises `LocomotionError` where it does not come to a speed from which people run.
    """
    human, starts = Human(None, clearing=(), rehearsals=0), []
    for seed in range(WALK_STARTS):
        rng = np.random.default_rng(seed)
        human.reset(_WAY[0], 0.0)
        human.data.qvel[:] += _NOISE * rng.normal(size=human.model.nv)
        human.follow(_WAY, float(rng.uniform(3.0, 3.6)))
        while (speed := run_entry_speed(human.on_feet.walk, human.control, 0.0)) is None:
            if human.status != "walking":
                raise LocomotionError(
                    f"people who walk end {human.status} before they can run: learn to walk anew"
                )
            human.tick()
        starts.append(WalkStart(human.save_state(), speed))
    return tuple(starts)
