"""What a playtest says: faults, which fail it, and notes, which do not; each with a place and a sentence."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

__all__ = ["KINDS", "Fault", "Sighting", "numbered"]

KINDS = {
    "hole": "hole in the floor",
    "walled_off": "walled off",
    "narrow": "too narrow",
    "low": "too low",
    "steep": "too steep",
    "step": "step too high",
    "ledge": "ledge out of reach",
    "gap": "gap too wide",
    "unreachable": "cannot be reached",
    "tops": "tops of walls",
    "one_way": "one-way",
    "trap": "trap",
    "forbidden": "should not be reachable",
    "detour": "way too long",
    "unusable": "obstacle of no use",
    "fell": "bots fall",
    "stuck": "bots get stuck",
    "blocked": "bots find no way",
    "never_cleared": "obstacle never cleared",
    "slow": "slower than planned",
    "open_edge": "open edge of the level",
}
"""Kind of finding → its title."""


@dataclass(frozen=True)
class Sighting:
    """A bot met the fault: its number, when [s], where [m], and which leg of its run it was."""

    bot: int
    time: float
    position: tuple[float, float, float]


@dataclass(frozen=True)
class Fault:
    """One finding. ``kind`` is one of `KINDS`; ``found_by`` is "analysis" or "bots".

    ``position`` (x, y, z) [m]; ``extent`` [m²] of the place concerned, 0 for a spot. ``size`` is what was
    measured there, along ``span``, its two ends [m]: the width of a passage, hole or gap, the free height of
    a passage, the height of a step or ledge [m], or a slope [°]; None and empty where nothing was. ``fails``:
    whether it fails the playtest; if not, it is a note. ``sightings`` are the bots that met it.
    """

    kind: str
    position: tuple[float, float, float]
    text: str
    fails: bool = True
    found_by: str = "analysis"
    extent: float = 0.0
    sightings: tuple[Sighting, ...] = field(default=())
    size: float | None = None
    span: tuple[tuple[float, float, float], ...] = ()

    @property
    def title(self) -> str:
        """The kind in words."""
        return KINDS[self.kind]

    @property
    def name(self) -> str:
        """What it is called in a list of tests and when two reports are compared: kind and place."""
        x, y, z = self.position
        return f"{self.kind}@{x:.1f},{y:.1f},{z:.1f}".replace("-0.0", "0.0")

    def to_dict(self) -> dict[str, Any]:
        """As plain values."""
        return {"name": self.name, **asdict(self)}


def numbered(faults: Sequence[Fault]) -> list[Fault]:
    """Faults before notes, by kind as in `KINDS`, then by place: the order that a report gives them in."""
    order = {kind: k for k, kind in enumerate(KINDS)}
    return sorted(faults, key=lambda each: (not each.fails, order[each.kind], each.position))
