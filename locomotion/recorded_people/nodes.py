"""Postures of a graph by their names, with what hands hold in them."""

from locomotion.errors import LocomotionError
from locomotion.postures.held_objects import STOWED, node_name
from locomotion.postures.posture_graph import PostureGraph

__all__ = ["can_hold", "checked_node"]


def checked_node(graph: PostureGraph, posture: str, held: str, state: str) -> str:
    """The node of ``posture`` with an object in a state. Raises `LocomotionError` if ``graph`` has none."""
    plain = [name for name in graph.postures if "/" not in name]
    if posture not in plain:
        raise LocomotionError(f"posture {posture!r}: valid: {', '.join(plain)}")
    if held and held not in graph.objects:
        raise LocomotionError(f"object {held!r}: valid: {', '.join(graph.objects) or 'none'}")
    if held and state not in (STOWED, *graph.objects[held]):
        raise LocomotionError(
            f"state {state!r} of a {held}: valid: {', '.join((STOWED, *graph.objects[held]))}"
        )
    node = node_name(posture, held, state)
    if node not in graph.postures:
        able = [name.partition("/")[0] for name in graph.postures if name.endswith(f"/{held} {state}")]
        raise LocomotionError(
            f"in the posture {posture!r} a {held} cannot be {state}; valid: {', '.join(able)}"
        )
    return node


def can_hold(graph: PostureGraph, posture: str, held: tuple[str, str]) -> tuple[str, str]:
    """An object and its state as they are, if they go with ``posture``, or else free hands."""
    return held if node_name(posture, *held) in graph.postures else ("", STOWED)
