"""What a world and its agents ask of bodies, whatever kind they are.

A `Population` makes and advances all bodies of a kind in a world: people one by one
(`runtime.bodies.people`), animals in one call (`runtime.bodies.quadrupeds`), walkers in one crowd
(`runtime.bodies.walkers`). A `Driver` is one body of it. `runtime.bodies.registry` lists the kinds.
"""

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Mapping, Sequence
from typing import Any, Protocol, TypeVar

import numpy as np

import navmesh
from locomotion import Ground
from locomotion.avoidance.yielding import Course
from locomotion.body_events import Event
from locomotion.saved_arrays import check_array
from runtime.bodies.cast import Cast
from runtime.bodies.figure import NO_JOINTS, Figure, Joints
from runtime.errors import RuntimeInputError
from runtime.planning.planning import NoWay, Plan

__all__ = ["PLANS_KEPT", "Driver", "Follower", "Population", "recall", "saved_parts"]

_Saved = TypeVar("_Saved")
PLANS_KEPT = 256
"""Plans that an agent remembers; a pursuer makes many."""


class Driver(ABC):
    """One body. ``events`` is what happened to it, in order, until its agent takes them; ``plans`` the last
    paths it was given or made. What is not abstract here is right for a body that can do no more than
    that."""

    figure: Figure
    radius: float
    events: list[Event]
    plans: deque[Plan]
    comes_from_elsewhere = False
    """Whether another simulator moves it, see `runtime.dis`; it then takes no orders."""
    tries_other_ways = False
    """Whether it can be told another way to the same goals when it gets nowhere: `can_turn`, `go_without`,
    `go_round`."""
    plans_in_slices = False
    """Whether it takes the way of `go_to` some ticks later, when `sets_out` says so. Until then its plan is
    not smooth, and it keeps to its former way."""

    @property
    @abstractmethod
    def simulated(self) -> object:
        """What simulates it, such as a `locomotion.Human`: for hosts that look inside."""

    @property
    def follower(self) -> "Follower | None":
        """Itself as one that follows a path and gives way to others; None for a body that does not."""
        return None

    @property
    @abstractmethod
    def time(self) -> float:
        """[s] since it was made."""

    def in_world(self, event: Event) -> Event:
        """An ``event`` of its `events` in metres and seconds of the world, which need not be its own."""
        return event

    @property
    @abstractmethod
    def status(self) -> str:
        """As `runtime.Agent.status`, but for "blocked"."""

    @property
    @abstractmethod
    def position(self) -> np.ndarray:
        """(3,) float64 [m] on the ground."""

    @property
    @abstractmethod
    def facing(self) -> float:
        """[rad, -π to π] counter-clockwise from the X axis."""

    @property
    def progress(self) -> float:
        """Share of its path that is behind it, 0 to 1."""
        length = self.plans[-1].length if self.plans else 0.0
        return 1.0 - self.left / length if length > 0.0 else 1.0

    @property
    @abstractmethod
    def left(self) -> float:
        """[m] of its way that are still before it."""

    @property
    def hindrance(self) -> str:
        """Why one on its way gets nowhere, as far as it knows."""
        return "it makes no headway"

    @property
    def skills(self) -> Mapping[str, tuple[float, float]]:
        """As `runtime.Agent.skills`."""
        return {}

    @property
    def ground(self) -> Ground | None:
        """The level as it stands on it; None for a body that has no use for one."""
        return None

    @abstractmethod
    def transforms(self) -> np.ndarray:
        """(n, 7): position [m] and quaternion (w, x, y, z) in the world of each body of `figure`."""

    def transforms_between(self, share: float) -> np.ndarray:
        """A ``share`` (0 to 1) of the way from where it was when `Population.remember` was called last."""
        return self.transforms()

    @property
    def joints(self) -> Joints:
        """The joints whose angles `joint_pose` gives; `NO_JOINTS` where it gives none."""
        return NO_JOINTS

    def joint_pose(self) -> np.ndarray | None:
        """(7 + j,) its pose by the angles [rad] of its `joints`, after its root's position [m] and quaternion
        (w, x, y, z) in the world; None for a body whose pose is not told by angles."""
        return None

    @property
    def detail(self) -> str:
        """What moves it: "physics", or of recorded motion the level of detail."""
        return "physics"

    @property
    def posture(self) -> str:
        """The posture that it is in or on its way to."""
        return "stand"

    @property
    def held(self) -> tuple[str, str]:
        """What its hands hold, and the state of that."""
        return "", "stowed"

    def held_in(self, posture: str) -> tuple[str, str]:
        """As `held`, for what it can hold on to in a posture: else it is stowed."""
        return self.held

    def check_posture(self, posture: str, held: str, state: str) -> None:
        """Raises `RuntimeInputError` for a posture that it does not have, or in which its hands cannot hold
        an object in this state."""
        raise RuntimeInputError("it has no postures; only a human has")

    def take(self, posture: str, held: str, state: str) -> None:  # noqa: B027  most have none
        """Take a posture that `check_posture` lets pass. Raises `RuntimeInputError` where there is no way to
        it."""

    def heed(self, bravery: float | None) -> None:
        """As `runtime.Agent.bravery`. Raises `RuntimeInputError` for a body without odds, unless None."""
        if bravery is not None:
            raise RuntimeInputError("it has no bravery; only a human has")

    def push(self, force: np.ndarray, seconds: float) -> None:
        """As `runtime.Agent.push`."""
        raise RuntimeInputError("it cannot be pushed; only a human with physics can")

    def odds(self, obstacle: int | str) -> float:
        """As `runtime.Agent.odds`."""
        raise RuntimeInputError("its odds are not known; only those of a human with physics are")

    def set_style(self, traits: Mapping[str, float]) -> None:
        """As `runtime.Agent.set_style`."""
        raise RuntimeInputError("it has no style; only people have")

    @property
    def traits(self) -> Mapping[str, float]:
        """All of `locomotion.body.traits.TRAITS` of a person; else none."""
        return {}

    @abstractmethod
    def plan(self, goals: np.ndarray) -> Plan:
        """The way through ``goals`` (k, 3), not taken. Raises `runtime.planning.planning.NoWay`."""

    @abstractmethod
    def go_to(self, goals: np.ndarray, speed: float, facing: float | None) -> Plan:
        """Take the way through ``goals``. Raises `runtime.planning.planning.NoWay`."""

    def sets_out(self) -> "tuple[Course | None] | None":
        """Of one that `plans_in_slices`: the course that it was on, if it has taken another way since it was
        asked last; else None."""
        return None

    @property
    @abstractmethod
    def goals_left(self) -> int:
        """How many of the goals of `go_to` are still before it, at least one while it is on its way."""

    @abstractmethod
    def way_holds(self) -> bool:
        """Of one on its way: whether the rest of it can be gone on the level as it is now. True for one that
        has lost its footing: another way is no help."""

    @abstractmethod
    def stop(self) -> None:
        """Give up its way and come to a stand."""

    def give_up(self, reason: str | None = None) -> None:
        """Be stuck where it is, for a ``reason`` other than that others are in its way."""
        self.stop()

    def take_note(self) -> None:  # noqa: B027  most have nothing to note
        """Something has happened to it: keep in `plans` what path it has taken by itself."""

    @property
    def can_turn(self) -> bool:
        """Whether it is on its way and can be told another one now."""
        return False

    def go_without(self, goals: np.ndarray, speed: float, closed: Sequence[str]) -> Plan:
        """As `go_to`, over none of the obstacles of the tags ``closed``."""
        raise NoWay(0, "it takes no other way")

    def go_round(
        self, goals: np.ndarray, speed: float, closed: tuple[str, ...]
    ) -> tuple[Plan, tuple[str, ...]]:
        """As `go_without`, over no obstacle at all, or not over the next one, if there is such a way; and the
        tags of what is closed then."""
        raise NoWay(0, "it takes no other way")

    @property
    def tag_ahead(self) -> str:
        """Of the obstacle that it comes to next; empty where there is none."""
        return ""

    @property
    def beside_path(self) -> float:
        """[m] by which it is beside its path, at least 0."""
        return 0.0

    @abstractmethod
    def save(self) -> Any:
        """Everything that decides how it goes on, as records of this distribution, tuples, arrays and plain
        values (`runtime.world.state_file`)."""

    def fits(self, state: Any) -> bool:
        """Whether ``state`` is of a driver like this one."""
        return True

    @abstractmethod
    def restore(self, state: Any) -> None:
        """Go on from what `save` gave. Raises `RuntimeInputError` or another `ValueError` for anything
        else."""

    @abstractmethod
    def state_hash(self) -> str:
        """Hexadecimal digest of what `save` gives."""


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


class Population(ABC):
    """All bodies of a kind in a world."""

    @abstractmethod
    def spawn(self, body: str, place: np.ndarray, facing: float, radius: float) -> Driver:
        """A body at ``place`` (3,). ``radius`` [m] is its kind's, or what was asked for. Raises
        `RuntimeInputError` where there is no room for it."""

    @abstractmethod
    def revive(self, body: str, state: Any) -> Driver:
        """A body where and as it was when its driver was saved."""

    def at_level(self, driver: Driver, level: str, at_once: bool = False) -> Driver | None:
        """The same body moved by physics or by recorded motion, as `Driver.detail` says, from where and as it
        is: its driver from now on. None while that cannot be; it is asked again then. ``at_once``: even while
        it clears an obstacle or lies on the ground."""
        return driver if level == driver.detail else None

    def prepare_levels(self) -> None:
        """Do what the first `at_level` would have to wait for; most have nothing to do."""
        return

    @abstractmethod
    def remove(self, driver: Driver) -> None:
        """Have one less."""

    @abstractmethod
    def in_the_way(self) -> np.ndarray:
        """Discs (k, 6) that cover them on the ground, as `locomotion.crowd.Crowd.lead` takes them; as many
        for each."""

    def parts(self) -> "Sequence[Population]":
        """The populations that it consists of: they are advanced, and asked for all below, instead of it."""
        return (self,)

    def followers(self) -> Sequence[Follower]:
        """All of them, if they follow paths; nobody otherwise."""
        return ()

    def cast(self, drivers: "Sequence[Driver]") -> Cast:
        """Some of them, to be drawn together."""
        return Cast(drivers)

    def remember(self) -> None:  # noqa: B027  those that are drawn as they are
        """Keep where all are, for `Driver.transforms_between`."""

    def foresee(self, graph: navmesh.NodeGraph) -> None:  # noqa: B027
        """Work out what going on on another ``graph`` takes and does not depend on where bodies are. It is
        called in another thread, before the level changes."""

    @abstractmethod
    def change_level(self) -> None:
        """Go on on the level as it is now, where all are."""

    def change_zones(self) -> None:  # noqa: B027
        """Go on after zones of the level's graph have been blocked or opened. Bodies that ask the graph anew
        for each route need nothing."""

    @abstractmethod
    def tick(self) -> None:
        """Advance all by 10 ms."""


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
