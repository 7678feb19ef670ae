"""What a skill that clears obstacles offers to the body, and the run-up to it.

A skill is asked for its entry speed and its mark before the obstacle; during the run-up the body replans the
speeds of the remaining steps at each step (`locomotion.skills.approach`); when the stance foot stands at the
mark, the skill starts, and from then on changes the running controller's targets until it is finished.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.errors import LocomotionError
from locomotion.gaits.run import controller
from locomotion.gaits.run.skill import RunSkill
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.skills.approach import ApproachPlan, ApproachWeights, plan_approach

__all__ = [
    "ClearingSkill",
    "Clears",
    "covers",
    "distance_to",
    "foot_distance",
    "plan_run_up",
    "run_up_speeds",
    "skill_for",
    "skill_ranges",
]

_WEIGHTS = ApproachWeights(2000.0, (8.0, 4.0, 2.0, 1.0))
# [1/m²], [s²/m²] from the last step backwards: of those tried, these bring the foot nearest to the mark
# (error sd 0.05 m) and the speed nearest to the entry speed (sd 0.1 m/s)
_SPREAD = 0.8
# [m/s] by which a run-up may be slower or faster than the entry speed
_HASTE = 1.3
# [m/s] by which the speed asked for may exceed that of the last step: more, soon after setting off, trips it
HEIGHT_TOLERANCE = 0.02
"""[m] that an obstacle may be lower or higher than what a skill has learned."""


class Clears(Protocol):
    """What obstacles something clears."""

    @property
    def affordance(self) -> str:
        """The kind of obstacle that it clears, as in `locomotion.skills.registry`."""
        ...

    @property
    def heights(self) -> tuple[float, float]:
        """Least and greatest height [m] that it clears; width, if it leaps over gaps."""
        ...


class ClearingSkill(Clears, Protocol):
    """A skill that takes the body over an obstacle, on top of the running controller."""

    def approach(self, size: float, depth: float = 0.0) -> tuple[float, float]:
        """Entry speed [m/s] for an obstacle of that height (gap: width) [m] that is ``depth`` [m] thick, and
        distance [m] from the stance foot's touchdown to the edge at the start."""
        ...

    @property
    def stride(self) -> tuple[float, float, float]:
        """(a, lag, b): on the run under it a step asked for at speed v [m/s] after one at v' is
        a v + lag (v' - v) + b long [m]."""
        ...

    @property
    def ends(self) -> Literal["running", "walking"]:
        """How the body goes on when the skill is finished."""
        ...

    def start(self, obstacle: ObstacleAhead, state: NDArray[np.float64]) -> NDArray[np.float64]:
        """Begin, just after the stance switch to the take-off step; ``state`` is the running controller's.
        Returns all that the skill remembers, (k,) float64."""
        ...

    def tick(
        self,
        obstacle: ObstacleAhead,
        memory: NDArray[np.float64],
        state: NDArray[np.float64],
        data: mujoco.MjData,
    ) -> bool:
        """One control tick after the running controller's and before the physics: changes ``data.ctrl``
        (39,), ``memory`` and ``state`` in place, and may let hands hold on (`locomotion.body.hand_hold`). Of
        ``data`` it reads the state only, nothing derived from it. True when it is finished."""
        ...

    def fell(self, memory: NDArray[np.float64], state: NDArray[np.float64]) -> bool:
        """Whether the body has fallen, asked after each tick's physics; ``state`` says what
        `controller.observe` takes it for, which a body that lies over a wall or rolls is too."""
        ...

    def check(self, memory: NDArray[np.float64], steps: float) -> None:
        """Raises `LocomotionError` for a ``memory``, read from a file, that it cannot have after so many
        ``steps`` of the run."""
        ...


def skill_for(skills: Sequence[ClearingSkill], obstacle: ObstacleAhead) -> ClearingSkill | None:
    """The skill that clears an obstacle, or None."""
    for skill in skills:
        if covers(skill.heights, obstacle.size) and skill.affordance == obstacle.affordance:
            return skill
    return None


def covers(heights: tuple[float, float], size: float) -> bool:
    """Whether a skill that has learned ``heights`` [m] clears an obstacle of this ``size`` [m]."""
    low, high = heights
    return low - HEIGHT_TOLERANCE <= size <= high + HEIGHT_TOLERANCE


def skill_ranges(skills: Sequence[Clears]) -> dict[str, tuple[float, float]]:
    """Least and greatest size [m] of the obstacles that ``skills`` clear, with what they let pass, by
    affordance. `LocomotionError` where the ranges of two skills for the same leave some in between."""
    ranges: dict[str, tuple[float, float]] = {}
    for skill in sorted(skills, key=lambda each: each.heights):
        affordance = skill.affordance
        low, high = skill.heights[0] - HEIGHT_TOLERANCE, skill.heights[1] + HEIGHT_TOLERANCE
        if affordance in ranges:
            least, most = ranges[affordance]
            if low > most + 1e-9:
                raise LocomotionError(
                    f"skills for {affordance!r}: nothing is learned from {most:g} to {low:g} m; the "
                    "ranges of skills for the same kind of obstacle must join"
                )
            low, high = least, max(most, high)
        ranges[affordance] = low, high
    return ranges


def foot_distance(state: NDArray[np.float64], obstacle: ObstacleAhead) -> float:
    """Distance [m] from the stance foot's touchdown place to the obstacle's edge, at right angles to it."""
    foot = controller.PLANTED.start + (3 if state[controller.STANCE] > 0 else 0)
    return distance_to(obstacle, state[foot], state[foot + 1])


def distance_to(obstacle: ObstacleAhead, x: float, y: float) -> float:
    """Distance [m] from a place to the obstacle's edge, at right angles to it; below 0 behind it."""
    px, py = obstacle.position[0], obstacle.position[1]
    return float((x - px) * obstacle.normal[0] + (y - py) * obstacle.normal[1])


def run_up_speeds(entry: float, run: RunSkill) -> tuple[float, float]:
    """Lowest and highest speed [m/s] of a run-up to the entry speed ``entry``."""
    low, high = run.speeds
    return max(low, entry - _SPREAD), min(high, entry + _SPREAD)


def plan_run_up(
    state: NDArray[np.float64],
    obstacle: ObstacleAhead,
    skill: ClearingSkill,
    run: RunSkill,
    farther: float = 0.0,
    faster: float = 0.0,
    bend: float = 0.0,
) -> ApproachPlan:
    """Speeds of the remaining steps, planned at a stance switch; none: start the skill at this step.

    farther [m], faster [m/s]: changes of the skill's mark and entry speed. bend: [m] by which the path to
    the obstacle is longer than the distance at right angles to its edge."""
    entry, mark = skill.approach(obstacle.size, obstacle.depth)
    entry, mark = min(max(entry + faster, run.speeds[0]), run.speeds[1]), mark + farther
    low, high = run_up_speeds(entry, run)
    if state[controller.STEPS] >= 2.0:
        high = max(entry, min(high, float(state[controller.STEP_SPEED]) + _HASTE))
    speed = min(max(float(state[controller.SPEED]), low), high)
    a, lag, b = skill.stride
    # over the steps to come the lag adds up to lag * (speed - entry)
    distance = foot_distance(state, obstacle) + bend - lag * (speed - entry)
    return plan_approach(
        distance,
        speed,
        entry,
        mark,
        (a, b),
        bounds=(low, high),
        weights=_WEIGHTS,
    )
