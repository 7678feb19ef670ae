"""Objects in the hands: what a figure does with them changes its arms, in any of its postures.

In a posture file each state of an object is told once, as joints that differ from the posture's. From that
come the nodes, such as "kneel/rifle deployed", and their arcs: from one state to the next, and those from
posture to posture with the object in the hands. An object that is stowed changes no joint: it has no nodes.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from locomotion.postures.schema import PostureFile

__all__ = [
    "STOWED",
    "Capsule",
    "DerivedArc",
    "HeldNode",
    "derived_arcs",
    "held_nodes",
    "node_name",
    "parts_of",
]

STOWED = "stowed"
"""The state of an object that is in no hand. Every object has it."""


@dataclass(frozen=True)
class Capsule:
    """A part of what a thing looks like, between two points [m] of its frame: the origin is where the right
    hand has it, x points to where the left one has it, z up. ``radius`` [m]; ``colour``: red, green and blue,
    0 to 1."""

    begin: tuple[float, float, float]
    end: tuple[float, float, float]
    radius: float
    colour: tuple[float, float, float]


@dataclass(frozen=True)
class HeldNode:
    """A posture with an object in a state: the joints [deg] that differ from the posture's."""

    posture: str
    object: str
    state: str
    joints: dict[str, float]
    both: dict[str, float]

    @property
    def name(self) -> str:
        return node_name(self.posture, self.object, self.state)


@dataclass(frozen=True)
class DerivedArc:
    """An arc that comes from a state of an object: between two nodes in ``seconds``, or, with ``like`` (the
    number of an arc of the file), that arc with the joints of the node that it begins in."""

    start: str
    end: str
    object: str
    state: str
    seconds: float = 0.0
    like: int = -1
    backwards: bool = False


def node_name(posture: str, held: str = "", state: str = STOWED) -> str:
    """What the node of a posture is called, with an object in a state."""
    return posture if state == STOWED else f"{posture}/{held} {state}"


def parts_of(node: str, objects: dict[str, tuple[str, ...]]) -> tuple[str, str, str]:
    """Posture, object and state of a node's name; no object where the hands are free. ``objects``: the states
    of each, but for `STOWED`."""
    posture, _, held = node.partition("/")
    for name, states in objects.items():
        for state in states:
            if held == f"{name} {state}":
                return posture, name, state
    return node, "", STOWED


def held_nodes(file: PostureFile) -> list[HeldNode]:
    """The nodes that the objects of a file add, in its order."""
    return [
        HeldNode(posture, name, label, state.joints | own.joints, state.both | own.both)
        for name, thing in file.objects.items()
        for label, state in thing.states.items()
        for posture, own in state.in_.items()
    ]


def derived_arcs(file: PostureFile) -> Iterator[DerivedArc]:
    """The arcs that the objects of a file add: into each state from the one before it, and back; and every
    arc of the file whose postures both have the state with the same joints."""
    for name, thing in file.objects.items():
        before: dict[str, str] = {}  # of each posture the node of the last state that it has
        for label, state in thing.states.items():
            for posture in state.in_:
                here, there = before.get(posture, posture), node_name(posture, name, label)
                yield DerivedArc(here, there, name, label, seconds=state.seconds)
                yield DerivedArc(there, here, name, label, backwards=True)
                before[posture] = there
            for k, arc in enumerate(file.arcs):
                own = state.in_.get(arc.from_), state.in_.get(arc.to)
                if own[0] is not None and own[0] == own[1]:
                    here, there = (node_name(each, name, label) for each in (arc.from_, arc.to))
                    yield DerivedArc(here, there, name, label, like=k, backwards=arc.backwards)
