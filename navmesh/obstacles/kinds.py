"""The kinds of obstacles that a level can have: what each affords, as far as the graph has to know it.

The package finds four kinds in a mesh. A game adds its own with `register`: their obstacles come from
`ObstacleKind.find` or from an author's tags (`navmesh.obstacles.tags`). Who clears them, and how, is not
known here.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, get_args

from navmesh.errors import NavmeshError
from surefoot.numeric import is_finite

if TYPE_CHECKING:
    from navmesh.level.terrain import Terrain
    from navmesh.rules import WalkRules
    from navmesh.surface.surface import Surface

__all__ = [
    "CROSSINGS", "LONGEST_NAME", "Crossing", "ObstacleKind", "affordances", "kind_of", "obstacle_kinds",
    "register", "unregister",
]  # fmt: skip

Crossing = Literal["onto", "over", "off", "across", "under"]
"""How a body gets past an obstacle: onto a platform, over a wall, off a ledge, across a gap, under a beam."""
CROSSINGS: tuple[Crossing, ...] = get_args(Crossing)
"""In the order of their numbers in the kernels (from 0)."""
LONGEST_NAME = 16
"""Characters of an affordance's name."""
_NAME = re.compile(rf"[a-z][a-z-]{{0,{LONGEST_NAME - 1}}}")


@dataclass(frozen=True, slots=True)
class ObstacleKind:
    """A kind of obstacle.

    Attributes:
        affordance: its name, up to 16 small letters and -, such as "vault".
        crossing: how a body gets past it; decides what height, depth and rise of `Obstacles` mean.
        effort: (a, b), both at least 0: clearing one of ``size`` [m] is worth walking a + b * size metres.
        rule: the field of `ObstacleRules` that holds the range of sizes that are looked for; empty for a kind
            that the package does not look for.
        find: finds obstacles of this kind in a level, as `Obstacles`, from its terrain, its walkable
            surface and its walk rules; called when a graph is built and after every change. None: they
            are found by the package, or come from tags alone.
    """

    affordance: str
    crossing: Crossing
    effort: tuple[float, float] = (1.0, 1.0)
    rule: str = ""
    find: Callable[["Terrain", "Surface", "WalkRules"], object] | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.affordance, str) or not _NAME.fullmatch(self.affordance):
            raise NavmeshError(
                f"affordance {self.affordance!r}: expected up to {LONGEST_NAME} letters a to z and -"
            )
        if self.crossing not in CROSSINGS:
            raise NavmeshError(
                f"{self.affordance}: crossing {self.crossing!r}: valid: {', '.join(CROSSINGS)}"
            )
        if not _is_effort(self.effort):
            raise NavmeshError(
                f"{self.affordance}: effort {self.effort!r}: expected two numbers of at least 0"
            )

    @property
    def from_below(self) -> bool:
        """Whether the body comes from below its edge, and not from above."""
        return self.crossing in ("onto", "over")

    @property
    def has_depth(self) -> bool:
        """Whether the floor goes on only behind its depth: the thickness of a wall, the width of a gap, the
        way under a beam."""
        return self.crossing in ("over", "across", "under")

    @property
    def measure(self) -> Literal["height", "width"]:
        """What its size is, with which a skill's range is compared; a width is kept as `Obstacles.depth`."""
        return "width" if self.crossing == "across" else "height"

    @property
    def rises(self) -> int:
        """By how much the floor behind rises with the height: 1, 0 or -1."""
        return {"onto": 1, "over": 0, "off": -1, "across": 1, "under": 0}[self.crossing]

    def size(self, height: float, depth: float) -> float:
        """The size [m] of an obstacle with this height and depth [m]."""
        return depth if self.measure == "width" else height


def _is_effort(value: Any) -> bool:
    return isinstance(value, tuple) and len(value) == 2 and all(is_finite(v) and v >= 0.0 for v in value)


_FOUND_IN_MESHES = (
    ObstacleKind("jump", "onto", effort=(1.0, 2.0), rule="jump_rise"),
    ObstacleKind("vault", "over", effort=(3.0, 0.0), rule="vault_height"),
    ObstacleKind("drop", "off", effort=(2.0, 1.0), rule="drop_height"),
    ObstacleKind("gap", "across", effort=(1.0, 1.0), rule="gap_width"),
)
"""What `navmesh.obstacles.rim_measuring` looks for."""
_kinds: dict[str, ObstacleKind] = {kind.affordance: kind for kind in _FOUND_IN_MESHES}


def obstacle_kinds() -> tuple[ObstacleKind, ...]:
    """All kinds: those that the package finds, then the others as they were registered."""
    return tuple(_kinds.values())


def affordances() -> tuple[str, ...]:
    """The names of all kinds, in the order of `obstacle_kinds`."""
    return tuple(_kinds)


def kind_of(affordance: str) -> ObstacleKind:
    """The kind with this name. Raises `NavmeshError` where there is none."""
    try:
        return _kinds[affordance]
    except KeyError:
        raise NavmeshError(f"affordance {affordance!r}: valid: {', '.join(_kinds)}") from None


def register(kind: ObstacleKind) -> None:
    """Add a kind, in this process, before the first graph that has obstacles of it is built or read. Raises
    `NavmeshError` if its name is taken."""
    if kind.affordance in _kinds:
        raise NavmeshError(f"affordance {kind.affordance!r} is taken; names are unique")
    _kinds[kind.affordance] = kind


def unregister(affordance: str) -> None:
    """Take back a `register`. Graphs with obstacles of that kind cannot be used any more. Raises
    `NavmeshError` for a name that was not registered, and for the kinds that the package finds."""
    if kind_of(affordance) in _FOUND_IN_MESHES:
        raise NavmeshError(f"affordance {affordance!r} comes with the package")
    del _kinds[affordance]
