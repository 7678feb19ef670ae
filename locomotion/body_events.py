"""What happens to a body, as typed events with their simulation time."""

from dataclasses import dataclass

__all__ = [
    "Arrived", "BackedOut", "Cleared", "Event", "Fell", "GotStuck", "GotUp", "LostGround", "MissedGoal",
    "PostureReached", "SetOff", "StrayedFromPath", "TookOff", "TurnedAway", "WentBack",
]  # fmt: skip


@dataclass(frozen=True)
class Event:
    """time: simulation time [s] since the body was created. position: the body's point (x, y, z) on the
    ground [m]."""

    time: float
    position: tuple[float, float, float]


@dataclass(frozen=True)
class SetOff(Event):
    """The body starts to follow a path of this length [m] to this goal."""

    goal: tuple[float, float, float]
    length: float


@dataclass(frozen=True)
class Arrived(Event):
    """The body is at its goal, this far from it [m, horizontally]; an animal's front feet are."""

    distance: float


@dataclass(frozen=True)
class BackedOut(Event):
    """The body has backed up along its own trail, this far [m], to where it can turn round."""

    distance: float


@dataclass(frozen=True)
class MissedGoal(Event):
    """The body has reached the end of its path, but this far from the goal [m, horizontally]."""

    distance: float


@dataclass(frozen=True)
class PostureReached(Event):
    """The body is in the posture that it was asked for, with ``held`` in its hands: an object and its state,
    such as "rifle deployed", or "" with free hands."""

    posture: str
    held: str


@dataclass(frozen=True)
class StrayedFromPath(Event):
    """The body is this far from its path [m] and stops following it."""

    distance: float


@dataclass(frozen=True)
class LostGround(Event):
    """The ground under the body, or just ahead on its path, is gone, or it has fallen off it; ``reason`` says
    which."""

    reason: str = "there is no ground under it or ahead of it any more"


@dataclass(frozen=True)
class GotStuck(Event):
    """The body has made no progress along its path for some seconds. ``among_others``: it and other bodies
    wait for each other. ``reason``: why, or empty if unknown."""

    among_others: bool = False
    reason: str = "it makes no headway"


@dataclass(frozen=True)
class Fell(Event):
    """The body has fallen. Its wanted speed [m/s]; slope and arc length [m] of its path at that place."""

    speed: float
    slope: float
    arc_length: float


@dataclass(frozen=True)
class GotUp(Event):
    """The body has got up ``seconds`` [s] after a fall: it stands, or moves on on hands and feet."""

    seconds: float


@dataclass(frozen=True)
class TookOff(Event):
    """The body starts to clear an obstacle. The obstacle's affordance and height [m]; errors of the take-off
    distance [m, positive: too early] and of the entry speed [m/s]."""

    affordance: str
    height: float
    takeoff_error: float
    speed_error: float


@dataclass(frozen=True)
class TurnedAway(Event):
    """The body does not run at an obstacle of this affordance and size [m], or breaks its run-up off: its
    ``odds`` of clearing it, 0 to 1, are too low for its bravery, or too low to rehearse it."""

    affordance: str
    size: float
    odds: float


@dataclass(frozen=True)
class WentBack(Event):
    """The body turns round in front of an obstacle of this affordance and size [m] and goes back by
    ``distance`` [m] for a longer run-up."""

    affordance: str
    size: float
    distance: float


@dataclass(frozen=True)
class Cleared(Event):
    """The body has cleared the obstacle and runs on."""

    affordance: str
    height: float
