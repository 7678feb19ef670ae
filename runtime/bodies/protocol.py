"""What an agent asks of its body, whatever kind that is, and the kinds there are.

A `Population` makes and advances all bodies of its kinds in a world: people one by one
(`runtime.bodies.humans`), animals in one call (`runtime.bodies.quadrupeds`), walkers in one crowd
(`runtime.bodies.walkers`). A `Driver` is one body of it.
"""

from collections import deque
from collections.abc import Mapping, Sequence
from typing import Any, Protocol, TypeVar

import numpy as np

from locomotion import PERSON_RULES
from locomotion.avoidance.yielding import Course
from locomotion.events import Event
from locomotion.quadruped import BODY_NAMES, load_body
from locomotion.saved_arrays import check_array
from runtime.bodies.figure import Figure
from runtime.errors import RuntimeInputError
from runtime.planning.planning import Plan

__all__ = ["BODIES", "PLANS_KEPT", "Driver", "Follower", "Population", "radius_of", "recall", "saved_parts"]

BODIES = ("human", "walker", *BODY_NAMES)
"""What `World.spawn` can make."""
_Saved = TypeVar("_Saved")
PLANS_KEPT = 256
"""Plans that an agent remembers; a pursuer makes many."""


def radius_of(body: str) -> float:
    """[m] that the graph's queries keep free around a body of `BODIES`; of a walker, by default."""
    return PERSON_RULES["radius"] if body in ("human", "walker") else load_body(body).radius


class Driver(Protocol):
    """One body. ``events`` is what happened to it, in order, until its agent takes them; ``plans`` the last
    paths it was given or made."""

    figure: Figure
    radius: float
    events: list[Event]
    plans: deque[Plan]

    @property
    def time(self) -> float: ...
    @property
    def status(self) -> str: ...
    @property
    def position(self) -> np.ndarray: ...
    @property
    def facing(self) -> float: ...
    @property
    def progress(self) -> float:
        """Share of its path that is behind it, 0 to 1."""
        ...

    @property
    def left(self) -> float:
        """[m] of its way that are still before it."""
        ...

    @property
    def hindrance(self) -> str:
        """Why one on its way gets nowhere, as far as it knows."""
        ...

    @property
    def skills(self) -> Mapping[str, tuple[float, float]]: ...
    def transforms(self) -> np.ndarray: ...
    def transforms_between(self, share: float) -> np.ndarray:
        """A ``share`` (0 to 1) of the way from where it was when `Population.remember` was called last."""
        ...

    def plan(self, goals: np.ndarray) -> Plan:
        """The way through ``goals`` (k, 3), not taken. Raises `runtime.planning.planning.NoWay`."""
        ...

    def go_to(self, goals: np.ndarray, speed: float, facing: float | None) -> Plan:
        """Take the way through ``goals``. Raises `runtime.planning.planning.NoWay`."""
        ...

    @property
    def goals_left(self) -> int:
        """How many of the goals of `go_to` are still before it, at least one while it is on its way."""
        ...

    def way_holds(self) -> bool:
        """Of one on its way: whether the rest of it can be gone on the level as it is now. True for one that
        has lost its footing: another way is no help."""
        ...

    def stop(self) -> None:
        """Give up its way and come to a stand."""
        ...

    def save(self) -> Any: ...
    def restore(self, state: Any) -> None: ...
    def state_hash(self) -> str: ...


class Follower(Protocol):
    """A body that follows a path and gives way to others."""

    @property
    def pace(self) -> float:
        """Share of its speed at which it goes at present."""
        ...

    @property
    def reach(self) -> float:
        """[m] that its head is ahead of the foremost of its discs."""
        ...

    def course(self) -> Course | None:
        """What it is about to do, None where that cannot be changed."""
        ...

    def foretold(self) -> np.ndarray | None:
        """(COUNT, d, 2) [m] where its discs are every `giving_way.STEP` from now on, of one whose course
        cannot be changed; None: it goes on as it moves."""
        ...

    def give_way(self, pace: float, shift: np.ndarray | None) -> None:
        """Go at another pace; with ``shift`` (k, 2) [m] change its path by it, as its course tells it."""
        ...

    @property
    def waited(self) -> float | None:
        """[s] for which it has given way without headway; None for one that is not on its way."""
        ...

    def way_back(self) -> np.ndarray | None:
        """(k, 3) [m] the points, `giving_way.SPACING` apart, of the way on which it has come, back from its
        rearmost point; None where there is none, or it has gone back often enough."""
        ...

    @property
    def backs(self) -> float:
        """[m] that it would go back at least, to let others by."""
        ...

    @property
    def length(self) -> float:
        """[m] from its rearmost point to its front."""
        ...

    def make_room(self, far: float) -> None:
        """Go ``far`` [m] back, and then on again."""
        ...

    def give_up(self) -> None:
        """Be stuck where it is."""
        ...

    def end_in(self, ahead: float) -> None:
        """Take the place ``ahead`` [m] further on for its goal; of one at rest, where it is."""
        ...


class Population(Protocol):
    """All bodies of some kinds in a world."""

    bodies: tuple[str, ...]

    def spawn(self, body: str, place: np.ndarray, facing: float, radius: float) -> Driver:
        """``radius`` [m] is `radius_of` the body, or what was asked for a walker."""
        ...

    def revive(self, body: str, state: Any) -> Driver:
        """A body where and as it was when its driver was saved."""
        ...

    def remove(self, driver: Driver) -> None: ...
    def in_the_way(self) -> np.ndarray:
        """Discs (k, 6) that cover them on the ground, as `locomotion.crowd.Crowd.lead` takes them; as many
        for each."""
        ...

    def followers(self) -> Sequence[Follower]:
        """All of them, if they follow paths; nobody otherwise."""
        ...

    def remember(self) -> None:
        """Keep where all are, for `Driver.transforms_between`."""
        ...

    def change_level(self) -> None:
        """Go on on the level as it is now, where all are."""
        ...

    def tick(self) -> None:
        """Advance all by 10 ms."""
        ...


def saved_parts(state: Any, kind: type[_Saved]) -> tuple[_Saved, tuple[Plan, ...]]:
    """What a driver has saved: the state of its body, of this ``kind``, and its plans. Raises
    `RuntimeInputError` for anything else, and for plans that are none."""
    body, plans = state if isinstance(state, tuple) and len(state) == 2 else (None, ())
    if not isinstance(body, kind):
        raise RuntimeInputError(f"no {kind.__name__} is saved")
    if not (isinstance(plans, tuple) and all(isinstance(plan, Plan) for plan in plans)):
        raise RuntimeInputError("no plans are saved")
    for plan in plans:
        for name in ("raw", "pulled", "points"):
            check_array(f"the {name} points of a plan", getattr(plan, name), None, 3)
    return body, plans


def recall(plans: deque[Plan], saved: tuple[Plan, ...]) -> None:
    """Make ``plans`` those that were saved."""
    plans.clear()
    plans.extend(saved)
