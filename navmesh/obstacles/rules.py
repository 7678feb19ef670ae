"""Which obstacles count as clearable, and how much room they need around them."""

import math
from dataclasses import asdict, dataclass
from typing import Any

from navmesh.errors import NavmeshError
from navmesh.obstacles.kinds import ObstacleKind

__all__ = ["ObstacleRules"]

Range = tuple[float, float]


@dataclass(frozen=True, slots=True)
class ObstacleRules:
    """Ranges (least, greatest) in metres of what is tagged. A rise that the walk rules let one step over is
    never tagged, whatever the ranges say."""

    jump_rise: Range = (0.1, 0.7)
    """[m], rise from the floor before to the floor on top that one jumps or steps up onto."""
    vault_height: Range = (0.6, 1.0)
    """[m], height over the floor before it of something thin with floor behind it again."""
    vault_depth: float = 0.8
    """[m], greatest thickness of what one vaults over."""
    drop_height: Range = (0.9, 2.0)
    """[m], fall from a floor's rim to the floor below."""
    gap_width: Range = (0.4, 2.5)
    """[m], horizontal distance from rim to rim that one leaps."""
    level: float = 0.3
    """[m], the floors before and behind a vault or a gap differ in height by at most this."""
    run_up: float = 1.0
    """[m], least free length before the edge."""
    landing: float = 0.8
    """[m], least free length behind the edge (behind the far edge of a vault or a gap)."""
    body_radius: float = 0.3
    """[m], the narrowest body in mind: an obstacle is usable over at least twice this width."""

    def __post_init__(self) -> None:
        for name in ("jump_rise", "vault_height", "drop_height", "gap_width"):
            value = getattr(self, name)
            try:
                low, high = (float(bound) for bound in value)
            except (TypeError, ValueError):
                raise NavmeshError(
                    f"{name} = {value!r}: expected two numbers (least, greatest) [m]"
                ) from None
            if not (math.isfinite(high) and 0.0 < low <= high <= 100.0):
                raise NavmeshError(f"{name} = {value!r}: expected 0 < least ≤ greatest ≤ 100 [m]")
            object.__setattr__(self, name, (low, high))
        for name, low, high in (
            ("vault_depth", 0.0, 10.0),
            ("level", 0.0, 10.0),
            ("run_up", 0.0, 100.0),
            ("landing", 0.0, 100.0),
            ("body_radius", 0.05, 10.0),
        ):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
                raise NavmeshError(f"{name} = {value!r}: expected a number from {low:g} to {high:g} [m]")
            object.__setattr__(self, name, float(value))

    def range_of(self, kind: ObstacleKind) -> Range | None:
        """The range of sizes of ``kind`` that is looked for; None for a kind that is not looked for."""
        return getattr(self, kind.rule) if kind.rule else None

    def to_dict(self) -> dict[str, Any]:
        """The rules as plain numbers and lists, for a file's header."""
        return {name: list(v) if isinstance(v, tuple) else v for name, v in asdict(self).items()}

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> "ObstacleRules":
        """Rules from `to_dict`; an unknown or missing name is an error."""
        if set(values) != set(cls.__slots__):
            found = ", ".join(values) or "none"
            raise NavmeshError(f"obstacle rules: {found}; expected {', '.join(cls.__slots__)}")
        return cls(**values)
