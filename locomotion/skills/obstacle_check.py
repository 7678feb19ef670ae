"""Whether the obstacles that a person is told of can be what it says of them, and whether it clears them."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from locomotion.errors import LocomotionError
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.skills.interface import ClearingSkill, skill_for
from locomotion.skills.registry import CLEARING
from surefoot.numeric import as_point, is_finite

__all__ = ["check_obstacles"]

_UNIT = 1e-3  # by which the length of a normal may differ from 1


def check_obstacles(obstacles: Sequence[ObstacleAhead], skills: Sequence[ClearingSkill]) -> None:
    """Raises `LocomotionError` for what is no sequence of `ObstacleAhead`, obstacles with a mistake or out of
    order, and those that none of ``skills`` clears."""
    if not isinstance(obstacles, Sequence):
        raise LocomotionError(f"obstacles are a list of ObstacleAhead, not a {type(obstacles).__name__}")
    for number, obstacle in enumerate(obstacles):
        if not isinstance(obstacle, ObstacleAhead):
            raise LocomotionError(
                f"obstacle {number} is a {type(obstacle).__name__}; expected an ObstacleAhead"
            )
        mistake = _mistake(obstacle)
        if mistake is not None:
            raise LocomotionError(f"obstacle {number}: {mistake}")
        if skill_for(skills, obstacle) is None:
            wanted = f"{obstacle.affordance} {obstacle.size:.2f} m"
            offered = [f"{s.affordance} {s.heights[0]:g} to {s.heights[1]:g} m" for s in skills]
            raise LocomotionError(f"no skill clears {wanted}; there are {offered or 'none'}")
    for number, (before, after) in enumerate(pairwise(obstacles), start=1):
        if after.arc_length < before.arc_length:
            raise LocomotionError(
                f"obstacle {number} is at {after.arc_length:g} m, the one before it at "
                f"{before.arc_length:g} m; give them in order"
            )


def _mistake(obstacle: ObstacleAhead) -> str | None:
    if obstacle.affordance not in CLEARING:
        return f"affordance {obstacle.affordance!r}: valid: {', '.join(map(repr, CLEARING))}"
    for name in ("arc_length", "height", "depth"):
        value = getattr(obstacle, name)
        if not is_finite(value):
            return f"{name} must be a finite number of metres, not {value!r}"
    for name in ("position", "normal"):
        if as_point(getattr(obstacle, name)) is None:
            return f"{name} must be three finite numbers, not {getattr(obstacle, name)!r}"
    if abs(float(np.linalg.norm(obstacle.normal[:2])) - 1.0) > _UNIT:
        return f"normal must be horizontal and 1 long, not {obstacle.normal!r}"
    return None
