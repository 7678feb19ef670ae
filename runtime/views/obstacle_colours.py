"""In which colour each kind of obstacle is drawn."""

from collections.abc import Iterable

from locomotion.skills.registry import skill_kinds

__all__ = ["in_order", "obstacle_colour", "parts_of_colour"]

_UNKNOWN = "#808080"


def obstacle_colour(affordance: str) -> str:
    """ "#rrggbb"; grey for a kind that is not known here, of a trace from elsewhere."""
    colours = {kind.affordance: kind.colour for kind in skill_kinds()}
    return colours.get(affordance, _UNKNOWN)


def parts_of_colour(colour: str) -> tuple[int, int, int]:
    """Red, green and blue of "#rrggbb", 0 to 255."""
    red, green, blue = bytes.fromhex(colour[1:])
    return red, green, blue


def in_order(affordances: Iterable[str]) -> list[str]:
    """Each of ``affordances`` once, in the order in which kinds are listed, with unknown ones at the end."""
    order = {kind.affordance: k for k, kind in enumerate(skill_kinds())}
    return sorted(set(affordances), key=lambda name: (order.get(name, len(order)), name))
