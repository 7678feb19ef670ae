"""What a place must be like to be walked on."""

import math
from dataclasses import asdict, dataclass
from typing import Any

from navmesh.errors import NavmeshError

__all__ = ["WalkRules"]


@dataclass(frozen=True, slots=True)
class WalkRules:
    """When a place counts as walkable, and how finely the terrain is sampled.

    The rule, on the mesh itself:

    1. A *floor point* is a point of a face whose normal is within ``max_slope`` of straight up, or of the
       *riser* of a step, with no other part of the mesh above it within ``headroom`` (parts closer than 1 cm
       count as the same surface). A riser is made of steeper faces; the fall line through each of its points
       leads over them to floor above and to floor below that are at most ``max_step`` apart in height.
    2. *Walls always count, however thin*: walking ends at any part of the mesh that is more than
       ``max_step`` and less than ``headroom`` above the floor at its foot.
    3. *Floor ends* where within ``max_step`` up or down there is no floor point beyond: at a ledge, a
       steep face that is no riser, a hole, or an obstacle lower than ``max_step`` without floor on top.

    Floors are sampled at the centre of every square of ``resolution``: a strip of floor, or a gap in it,
    that holds no such centre can be missed, a wall cannot. The body's radius is not a rule of the build:
    it is an argument of each query.
    """

    max_slope: float = math.radians(45.0)
    """[rad], 0 to π/2 (exclusive). Steeper faces end the walkable surface, but for risers of steps."""
    max_step: float = 0.2
    """[m], 0 up to half of `headroom`. Rises and drops up to this are walked over; higher ones are ledges."""
    headroom: float = 1.8
    """[m], above 0. Free height that a body needs; lower ceilings end the walkable surface."""
    resolution: float = 0.25
    """[m], 0.02 to 2. Spacing of the samples. Halving it makes the build about four times slower."""
    min_radius: float = 0.1
    """[m], 0 or more. Places with less clearance get no node: no body is as thin as that."""

    def __post_init__(self) -> None:
        for name, low, high, why in (
            ("max_slope", 0.0, math.pi / 2 - 1e-6, "[rad], below π/2"),
            ("headroom", 1e-3, 1e3, "[m]"),
            ("resolution", 0.02, 2.0, "[m]"),
            ("min_radius", 0.0, 1e3, "[m]"),
            ("max_step", 0.0, 1e3, "[m]"),
        ):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
                raise NavmeshError(f"{name} = {value!r}: expected a number from {low:g} to {high:g} {why}")
            object.__setattr__(self, name, float(value))
        if self.max_step > self.headroom / 2:
            raise NavmeshError(
                f"max_step = {self.max_step:g} m: expected at most half of headroom ({self.headroom / 2:g} m)"
            )

    def to_dict(self) -> dict[str, float]:
        """The rules as plain numbers, for a file's header."""
        return asdict(self)

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> "WalkRules":
        """Rules from `to_dict`; an unknown or missing name is an error."""
        if set(values) != set(cls.__slots__):
            found = ", ".join(values) or "none"
            raise NavmeshError(f"walk rules: {found}; expected {', '.join(cls.__slots__)}")
        return cls(**values)
