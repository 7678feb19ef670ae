"""Obstacles that a skill can clear, as a structure of arrays."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from navmesh.obstacles.kinds import affordances, obstacle_kinds

__all__ = ["Obstacles", "tag_names"]


@dataclass(frozen=True, slots=True, eq=False)
class Obstacles:
    """k obstacles in world coordinates, sorted by affordance and place; the order of a mesh's triangles
    does not show. Each is crossed one way: from the run-up side over its edge; a wall that can be vaulted
    from both sides is two obstacles."""

    affordance: np.ndarray
    """(k,) str: name of its kind (`navmesh.obstacles.kinds`): "jump" (onto it), "vault" (over it), "drop"
    (off it), "gap" (across it), or one that was registered. What is said below of one of the four holds for
    all kinds that are crossed in the same way."""
    position: np.ndarray
    """(k, 3) float64 [m]: the middle of the usable edge, a point of the mesh's own edge: the top of the edge
    nearest the run-up side."""
    normal: np.ndarray
    """(k, 3) float64: horizontal unit vector at right angles to the edge, towards the run-up side."""
    height: np.ndarray
    """(k,) float64 [m]: jump: rise from the floor before it; vault: of its top above the floor before it;
    drop: depth of the fall; gap: of the far rim above the near one (may be negative)."""
    depth: np.ndarray
    """(k,) float64 [m], along the way across: jump: of the top (the same as `landing`); vault: thickness;
    drop: 0; gap: width from rim to rim."""
    width: np.ndarray
    """(k,) float64 [m]: usable length of the edge. A body of radius r has width - 2r of freedom."""
    rim: np.ndarray
    """(k, 2, 3) float64 [m]: ends of the usable edge, left and right as seen from the run-up side."""
    rim_height: np.ndarray
    """(k, 2) float64 [m]: what `height` is at the two ends of `rim`; it changes evenly in between."""
    run_up: np.ndarray
    """(k,) float64 [m]: free length straight before the edge, measured on the surface up to 50 m."""
    landing: np.ndarray
    """(k,) float64 [m]: free length on top (jump), behind the far edge (vault, gap) or below (drop)."""
    rise: np.ndarray
    """(k,) float64 [m]: the floor behind minus the floor before, at the edge; negative for a drop."""
    tag: np.ndarray
    """(k,) str: name; detected ones are called by affordance, place and heading, as jump@25.0,3.4,0.3/180."""
    authored: np.ndarray
    """(k,) bool: added or changed by the level's author."""

    def __len__(self) -> int:
        return len(self.height)

    def __repr__(self) -> str:
        kinds = [f"{int((self.affordance == kind).sum())} {kind}" for kind in sorted(set(self.affordance))]
        return f"<Obstacles: {', '.join(kinds) or 'none'}>"

    @property
    def size(self) -> np.ndarray:
        """(k,) float64 [m], what a skill's range is compared with: `height`, or for a gap its width."""
        wide = [kind.affordance for kind in obstacle_kinds() if kind.measure == "width"]
        return np.where(np.isin(self.affordance, wide), self.depth, self.height)

    @classmethod
    def empty(cls) -> "Obstacles":
        """No obstacles."""
        return cls(**{name: np.zeros((0, *shape), kind) for name, (kind, shape) in LAYOUT.items()})

    @classmethod
    def joined(cls, parts: Sequence["Obstacles"]) -> "Obstacles":
        """The obstacles of all ``parts``, of which there is at least one."""
        return cls(**{name: np.concatenate([part.arrays()[name] for part in parts]) for name in LAYOUT})

    def arrays(self) -> dict[str, np.ndarray]:
        """The arrays by name, for an archive; ``Obstacles(**arrays)`` makes them obstacles again."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    def select(self, which: np.ndarray) -> "Obstacles":
        """The obstacles that ``which`` (indices or a mask) picks, in that order."""
        return Obstacles(**{name: array[which] for name, array in self.arrays().items()})

    def near(self, point: np.ndarray, affordance: str | None = None) -> tuple[int, float]:
        """Index of and distance [m] to the obstacle whose position is nearest to ``point`` (3,), among those
        of ``affordance`` if it is given; (-1, infinity) when there is none."""
        distance = np.linalg.norm(self.position - np.asarray(point, np.float64), axis=1)
        if affordance is not None:
            distance = np.where(self.affordance == affordance, distance, np.inf)
        best = int(np.argmin(distance)) if len(distance) else -1
        return (best, float(distance[best])) if best >= 0 and np.isfinite(distance[best]) else (-1, np.inf)

    def sorted(self) -> "Obstacles":
        """In the order of affordance, place (to the centimetre) and heading."""
        number = {name: k for k, name in enumerate(affordances())}
        kind = np.array([number[name] for name in self.affordance], np.int64)
        place = np.rint(self.position * 100.0)
        heading = np.rint(np.arctan2(self.normal[:, 1], self.normal[:, 0]) * 100.0)
        return self.select(np.lexsort((heading, place[:, 2], place[:, 1], place[:, 0], kind)))


def tag_names(affordance: np.ndarray, position: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Names (k,) str of detected obstacles: affordance, place [0.1 m] and heading of the run-up [degrees]."""
    names = []
    for what, (x, y, z), (nx, ny, _) in zip(affordance, position, normal, strict=True):
        heading = round(math.degrees(math.atan2(-ny, -nx))) % 360
        names.append(f"{what}@{x:.1f},{y:.1f},{z:.1f}/{heading}".replace("-0.0", "0.0"))
    return np.array(names, "<U64")


LAYOUT: dict[str, tuple[type | str, tuple[int, ...]]] = {
    "affordance": ("<U5", ()),
    "position": (np.float64, (3,)),
    "normal": (np.float64, (3,)),
    "height": (np.float64, ()),
    "depth": (np.float64, ()),
    "width": (np.float64, ()),
    "rim": (np.float64, (2, 3)),
    "rim_height": (np.float64, (2,)),
    "run_up": (np.float64, ()),
    "landing": (np.float64, ()),
    "rise": (np.float64, ()),
    "tag": ("<U64", ()),
    "authored": (np.bool_, ()),
}
"""Type and shape (without the first axis) of each array of `Obstacles`."""
