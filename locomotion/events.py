"""What happens to a body, as typed events with the simulation time at which it happened."""

from dataclasses import dataclass

__all__ = [
    "Arrived", "BackedOut", "Cleared", "Event", "Fell", "GotStuck", "GotUp", "LostGround", "MissedGoal",
    "SetOff", "StrayedFromPath", "TookOff", "WentBack",
]  # fmt: skip


@dataclass(frozen=True)
class Event:
    """time: simulation time [s] since the body was made; position: its point (x, y, z) on the ground [m]."""

    time: float
    position: tuple[float, float, float]


@dataclass(frozen=True)
class SetOff(Event):
    """The body begins to follow a path of this length [m] to this goal."""

    goal: tuple[float, float, float]
    length: float


@dataclass(frozen=True)
class Arrived(Event):
    """The body is at its goal, this far from it [m, horizontally]."""

    distance: float


@dataclass(frozen=True)
class BackedOut(Event):
    """The body has gone backwards along its own trail, this far [m], to where it can turn around."""

    distance: float


@dataclass(frozen=True)
class MissedGoal(Event):
    """The body has come to the end of its path, but this far from the goal [m, horizontally]."""

    distance: float


@dataclass(frozen=True)
class StrayedFromPath(Event):
    """The body is this far beside its path [m] and does not follow it any more."""

    distance: float


@dataclass(frozen=True)
class LostGround(Event):
    """The ground under the body, or just ahead of it on its path, is not there any more."""


@dataclass(frozen=True)
class GotStuck(Event):
    """The body has made no headway along its path for some seconds; ``among_others``: it and those around it
    wait for each other. ``reason`` says why, as far as that is known."""

    among_others: bool = False
    reason: str = "it makes no headway"


@dataclass(frozen=True)
class Fell(Event):
    """The body lies on the ground; its wished speed [m/s], the path's slope and arc length [m] there."""

    speed: float
    slope: float
    arc_length: float


@dataclass(frozen=True)
class GotUp(Event):
    """The body has got up after a fall, ``seconds`` [s] after it: it stands, or goes on on hands and feet."""

    seconds: float


@dataclass(frozen=True)
class TookOff(Event):
    """The body begins to clear an obstacle: its affordance and height [m], the error of the take-off
    distance [m, positive: too early] and of the entry speed [m/s]."""

    affordance: str
    height: float
    takeoff_error: float
    speed_error: float


@dataclass(frozen=True)
class WentBack(Event):
    """The body turns round before an obstacle, of this affordance and size [m], to run up to it from
    ``distance`` [m] farther away."""

    affordance: str
    size: float
    distance: float


@dataclass(frozen=True)
class Cleared(Event):
    """The body is over the obstacle and runs on."""

    affordance: str
    height: float
