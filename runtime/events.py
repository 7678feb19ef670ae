"""What happened to an agent, one type per kind of event; polled from `World.events`."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from locomotion.errors import LocomotionError
from locomotion.skills.registry import in_words
from surefoot.words import several

__all__ = [
    "Arrived",
    "BackedOut",
    "Blocked",
    "Departed",
    "Event",
    "Fell",
    "GotUp",
    "Hindered",
    "Lost",
    "PostureReached",
    "SkillFinished",
    "SkillStarted",
    "Stuck",
    "Told",
    "TurnedAway",
    "Waiting",
    "event_text",
]

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Event:
    """Something that happened to ``agent`` at ``time`` [s, simulated] and ``position`` [m]."""

    time: float
    agent: str
    position: Point

    @property
    def kind(self) -> str:
        """Name of the event's type, such as ``"Arrived"``."""
        return type(self).__name__

    def to_dict(self) -> dict[str, Any]:
        """The event as plain values, with its ``kind``."""
        return {"kind": self.kind, **asdict(self)}

    def __str__(self) -> str:
        return f"{self.agent} {self._what()}"

    def _what(self) -> str:
        return self.kind.lower()


@dataclass(frozen=True)
class Departed(Event):
    """The agent started along a path of ``length`` [m] to ``goal``, over obstacles that need ``skills``. Of a
    person that is the length of the shortest line, without run-ups: its path is still to be planned."""

    goal: Point
    length: float
    skills: tuple[str, ...]

    def _what(self) -> str:
        many = (several(count, skill) for skill, count in Counter(self.skills).items())
        over = f" ({', '.join(many)} on the way)" if self.skills else ""
        return f"sets out for {_place(self.goal)}, {self.length:.1f} m{over}"


@dataclass(frozen=True)
class Arrived(Event):
    """The agent reached ``goal``."""

    goal: Point

    def _what(self) -> str:
        return f"arrives at {_place(self.goal)}"


@dataclass(frozen=True)
class Blocked(Event):
    """There is no path to ``goal``; ``reason`` says why."""

    goal: Point
    reason: str

    def _what(self) -> str:
        return f"cannot reach {_place(self.goal)}: {self.reason}"


@dataclass(frozen=True)
class BackedOut(Event):
    """The agent backed up along its own trail for ``length`` [m], to where it can turn round."""

    length: float

    def _what(self) -> str:
        return f"has backed out {self.length:.1f} m to {_place(self.position)}"


@dataclass(frozen=True)
class SkillStarted(Event):
    """The agent left the run for ``skill``, as missions call it ("jump", "vault", "drop-roll", "leap"), at an
    obstacle of ``height`` [m] (of a gap its width)."""

    skill: str
    height: float

    def _what(self) -> str:
        return in_words(self.skill, self.height)


@dataclass(frozen=True)
class SkillFinished(Event):
    """The agent finished ``skill`` and runs on, past an obstacle of ``height`` [m] (a gap: its width)."""

    skill: str
    height: float

    def _what(self) -> str:
        return f"runs on after the {self.skill}"


@dataclass(frozen=True)
class Fell(Event):
    """The agent lost its balance. A human gets up and continues (`GotUp`), unless it falls off the level
    (`Lost`)."""

    def _what(self) -> str:
        return f"falls at {_place(self.position)}"


@dataclass(frozen=True)
class GotUp(Event):
    """The agent is up again, or on hands and feet on steep ground, ``seconds`` [s] after it fell."""

    seconds: float

    def _what(self) -> str:
        return f"is up again after {self.seconds:.1f} s"


@dataclass(frozen=True)
class Lost(Event):
    """The agent gave up following its path, or has lost its ground; ``reason`` says why."""

    reason: str

    def _what(self) -> str:
        return f"loses its way at {_place(self.position)}: {self.reason}"


@dataclass(frozen=True)
class Hindered(Event):
    """The agent makes no progress: it goes back for another run-up, or has been without progress for 10 s.
    ``reason`` says why. It keeps trying, by another way if need be, until it gets on or is `Stuck`."""

    reason: str

    def _what(self) -> str:
        return f"gets nowhere at {_place(self.position)}: {self.reason}"


@dataclass(frozen=True)
class Stuck(Event):
    """The agent has given up after making no progress; ``reason`` says why."""

    reason: str

    def _what(self) -> str:
        return f"is stuck at {_place(self.position)}: {self.reason}"


@dataclass(frozen=True)
class TurnedAway(Event):
    """The agent does not take off for ``skill`` at an obstacle of ``height`` [m] (of a gap its width): its
    ``odds``, 0 to 1, are too low for its bravery, or too low to rehearse it. It tries again, takes another
    way, or is `Stuck`."""

    skill: str
    height: float
    odds: float

    def _what(self) -> str:
        return f"turns away from a {self.skill} of {self.height:.2f} m: odds {100.0 * self.odds:.0f} %"


@dataclass(frozen=True)
class PostureReached(Event):
    """The agent is in the ``posture`` that it was asked for. ``holds``: what it has in its hands, an object
    and its state such as "rifle deployed", or "" with free hands."""

    posture: str
    holds: str

    def _what(self) -> str:
        return f"is in the posture {self.posture}" + (f", {self.holds}" if self.holds else "")


@dataclass(frozen=True)
class Told(Event):
    """A trigger gave the agent a new script; ``why`` says what happened."""

    why: str

    def _what(self) -> str:
        return f"is told to do something else: {self.why}"


@dataclass(frozen=True)
class Waiting(Event):
    """The agent is on its way to ``goal``, and what comes next of an open world is not loaded yet: it stands
    until it is, and then sets out again (`Departed`)."""

    goal: Point

    def _what(self) -> str:
        return f"waits for what is to be loaded on its way to {_place(self.goal)}"


def event_text(values: Mapping[str, Any]) -> str:
    """The sentence for an event stored by `Event.to_dict`; only its name if it is of an unknown kind."""
    kinds = {kind.__name__: kind for kind in Event.__subclasses__()}
    told = {name: value for name, value in values.items() if name != "kind"}
    try:
        return str(kinds[values["kind"]](**told))
    except (KeyError, TypeError, LocomotionError):
        return f"{values['agent']}: {values['kind']}"


def _place(point: Point) -> str:
    return f"({point[0]:.1f}, {point[1]:.1f}, {point[2]:.1f})"
