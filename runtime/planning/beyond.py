"""Ways that lead beyond what is loaded of an open world: what a body is told now, and what comes later."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import chain

import numpy as np

import navmesh
from runtime.errors import RuntimeInputError
from runtime.planning.planning import NoWay

__all__ = ["Beyond", "loaded_part"]

_WORTH = 0.5  # [m] of a way that are worth setting out for, if it does not lead to the goal
_REASONS = {
    "off_graph": "it is not near a place where the body fits",
    "partial": "no way leads there on foot or with the skills at hand",
    "no_path": "no way leads there on foot or with the skills at hand",
}


@dataclass(frozen=True)
class Beyond:
    """What of a way is loaded, and what comes after it.

    ``told``: the points [m] that the body is told to go through; empty if it has to wait. ``full``: how
    many of the goals are among them, the first ones; behind those ``told`` may have one more point, where
    what is loaded ends. ``towards`` [m]: a coarse waypoint after that; once it is loaded the way leads
    farther. ``length`` [m]: of the way after ``told``.
    """

    told: tuple[tuple[float, float, float], ...]
    full: int
    towards: tuple[float, float, float]
    length: float

    def check(self, name: str, goals: int) -> None:
        """Raises `RuntimeInputError` for what cannot be left of a way of the agent ``name`` through so many
        ``goals``."""
        if not np.isfinite([*chain(*self.told), *self.towards, self.length]).all() or self.length < 0.0:
            raise RuntimeInputError(f"{name} has a way beyond what is loaded that is no way")
        if not 0 <= self.full < goals or len(self.told) not in (self.full, self.full + 1):
            raise RuntimeInputError(f"{name} has been told of {len(self.told)} points, {self.full} are goals")


def loaded_part(
    world: navmesh.OpenWorld,
    start: np.ndarray,
    goals: np.ndarray,
    radius: float,
    skills: Mapping[str, tuple[float, float]],
) -> Beyond | None:
    """What of the way from ``start`` (3,) through all ``goals`` (k, 3) [m] is loaded; None for all of it.

    Raises `NoWay` for a goal that cannot be reached, whether it is loaded or not.
    """
    told: list[np.ndarray] = []
    beyond, full, length = None, len(goals), 0.0
    for index, goal in enumerate(goals):
        route = world.route(start, goal, radius, skills)
        if route.status != "complete":
            raise NoWay(index, _REASONS[route.status])
        start = goal
        if beyond is not None:
            length += route.length
        elif not len(route.beyond):
            told.append(goal)
        else:
            beyond, full, length = route.beyond, index, route.beyond_length
            if route.fine is not None and route.fine.length >= _WORTH:
                told.append(route.fine.waypoints[-1])
            elif route.fine is not None:
                length += route.fine.length
    if beyond is None:
        return None
    loaded = world.is_loaded(beyond)
    towards = beyond[-1] if loaded.all() else beyond[np.argmin(loaded)]
    return Beyond(tuple(_triple(each) for each in told), full, _triple(towards), length)


def _triple(point: np.ndarray) -> tuple[float, float, float]:
    x, y, z = point.tolist()
    return x, y, z
