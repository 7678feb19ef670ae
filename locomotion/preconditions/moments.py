"""What is noted of a person at a moment of its run-up, from which its odds are computed."""

from __future__ import annotations

from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.gaits.run import controller
from locomotion.gaits.run.skill import RunSkill
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.skills.interface import ClearingSkill, foot_distance, plan_run_up
from locomotion.skills.run_up_layout import BEND, FARTHER, FASTER

__all__ = ["PLAN", "Moment", "make_slippery", "planned"]

PLAN = ("steps", "early", "next speed", "entry speed")
"""What is noted of the plan of a run-up: number of steps left; how far before its mark the last foothold will
be [m]; planned speed of the step that begins, and wanted speed of the last one [m/s]."""


class Moment(NamedTuple):
    """A person at the beginning of a step of its run-up, or just after its take-off.

    state: (STATE_SIZE,) memory of the running controller. plan: (4,), see `PLAN`. variation: (2,) take-off
    mark farther from the obstacle [m], faster entry [m/s]. beside: [m] to the left of its path.
    """

    state: NDArray[np.float64]
    plan: NDArray[np.float64]
    variation: NDArray[np.float64]
    beside: float


def planned(
    state: NDArray[np.float64],
    obstacle: ObstacleAhead,
    skill: ClearingSkill,
    run: RunSkill,
    run_up: NDArray[np.float64],
    off: bool,
) -> NDArray[np.float64]:
    """(4,) the plan of the rest of a run-up (`PLAN`), whose memory is ``run_up``; ``off``: whether the skill
    has begun."""
    farther, faster, bend = (float(each) for each in run_up[[FARTHER, FASTER, BEND]])
    entry, mark = skill.approach(obstacle.size, obstacle.depth)
    if off:
        return np.array([0.0, foot_distance(state, obstacle) - mark - farther, entry, entry + faster])
    plan = plan_run_up(state, obstacle, skill, run, farther, faster, bend)
    following = plan.speeds[0] if len(plan.speeds) else float(state[controller.STEP_SPEED])
    return np.array([len(plan.speeds), plan.takeoff_error, following, entry + faster])


def make_slippery(model: mujoco.MjModel, friction: float) -> None:
    """Give the person of ``model`` and its ground less ``friction`` than shoes on ordinary ground have."""
    model.geom_friction[:, 0] = friction
