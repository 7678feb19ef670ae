"""Walking persons about to run: start states for trials of setting off."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from locomotion.body.physics import save_physics
from locomotion.errors import LocomotionError
from locomotion.gaits.limits import run_entry_speed
from locomotion.gaits.run.skill import run_on
from locomotion.gaits.walk.layout import WALK_HEADING, WALK_STANCE
from locomotion.human.human import Human
from locomotion.human.state import HumanState

__all__ = ["WALK_STARTS", "WalkStart", "walk_starts"]

WALK_STARTS = 24
"""Number of start states."""
_NOISE = 0.05  # [m/s, rad/s] of the velocities with which they begin to walk
_WAY = np.array([[0.0, 0.0, 0.0], [60.0, 0.0, 0.0]])


class WalkStart(NamedTuple):
    """A person in the tick in which it can go over from its walk to its run, and its speed [m/s]; of that
    state, the physics, and what the running controller remembers when it goes over."""

    state: HumanState
    speed: float
    physics: NDArray[np.float64]
    running: NDArray[np.float64]


@lru_cache(maxsize=1)
def walk_starts() -> tuple[WalkStart, ...]:
    """The built-in walk on a plane along x, each time with other initial velocities. Raises `LocomotionError`
    if it does not reach a speed from which people run."""
    human, starts = Human(None, clearing=(), rehearsals=0), []
    for seed in range(WALK_STARTS):
        rng = np.random.default_rng(seed)
        human.reset(_WAY[0], 0.0)
        human.data.qvel[:] += _NOISE * rng.normal(size=human.model.nv)
        human.follow(_WAY, float(rng.uniform(3.0, 3.6)))
        while (speed := run_entry_speed(human.on_feet.walk, human.observed, 0.0)) is None:
            if human.status != "walking":
                raise LocomotionError(
                    f"walking people end {human.status} before they can run: train the walk again"
                )
            human.tick()
        walk, running = human.on_feet.walk, human.control.copy()
        run_on(running, human.data.ctrl, walk[WALK_STANCE], walk[WALK_HEADING], speed)
        starts.append(WalkStart(human.save_state(), speed, save_physics(human.model, human.data), running))
    return tuple(starts)
