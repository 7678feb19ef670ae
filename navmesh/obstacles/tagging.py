"""Putting an author's tags to a level's detected obstacles."""

import math
import os
from dataclasses import dataclass

import numpy as np

from navmesh.errors import NavmeshError
from navmesh.obstacles.free_length import REACH, cells_of, room
from navmesh.obstacles.kinds import kind_of
from navmesh.obstacles.obstacles import Obstacles
from navmesh.obstacles.tags import Addition, NewValues, Reference, Tags
from navmesh.rules import WalkRules
from navmesh.surface.surface import Surface
from surefoot.errors import SurefootError
from surefoot.files.yamlfile import Located, read_yaml

__all__ = ["TagFile", "load_tags"]


@dataclass(frozen=True, slots=True)
class TagFile:
    """Tags and where they came from, for messages."""

    tags: Tags
    located: Located | None = None
    """Where each value stands in the file; None for tags that were made in memory."""

    def apply(self, obstacles: Obstacles, surface: Surface, walking: WalkRules) -> Obstacles:
        """``obstacles`` with the removals, changes and additions, in this order.

        Raises `NavmeshError` (for a file with line and column) when a reference fits none of the obstacles
        or several, a name is taken, or there is no floor before or behind an added obstacle.
        """
        arrays = {name: array.copy() for name, array in obstacles.arrays().items()}
        gone = np.zeros(len(obstacles), np.bool_)
        for i, reference in enumerate(self.tags.remove):
            gone[self._find(obstacles, reference, ("remove", i))] = True
        for i, change in enumerate(self.tags.change):
            index = self._find(obstacles, change, ("change", i))
            if gone[index]:
                raise self._error(
                    ("change", i), f"{obstacles.tag[index]} is also removed; keep one of the two"
                )
            _change(arrays, index, change.set)
        kept = {name: array[~gone] for name, array in arrays.items()}
        for i, addition in enumerate(self.tags.add):
            row = _row(addition)
            for side, missing in (("run_up", addition.run_up), ("landing", addition.landing)):
                if missing is None:
                    row[side] = _measured(row, side, surface, walking)
                    if row[side] <= 0.0:
                        where = "before" if side == "run_up" else "behind"
                        problem = f"no floor {where} {addition.name!r} at the height that it says"
                        raise self._error(("add", i, "position"), problem)
            if kind_of(addition.affordance).crossing == "onto":
                row["depth"] = row["landing"]
            kept = {name: np.concatenate((array, [row[name]])) for name, array in kept.items()}
        result = Obstacles(**kept)
        self._check_names(result)
        return result.sorted()

    def _check_names(self, obstacles: Obstacles) -> None:
        names, counts = np.unique(obstacles.tag, return_counts=True)
        for name in names[counts > 1].tolist():
            for key, entries in (("add", self.tags.add), ("change", self.tags.change)):
                for i, entry in enumerate(entries):
                    said = entry.name if isinstance(entry, Addition) else entry.set.name
                    if said == name:
                        inside = ("name",) if isinstance(entry, Addition) else ("set", "name")
                        raise self._error((key, i, *inside), f"two obstacles would be called {name!r}")

    def _find(self, obstacles: Obstacles, reference: Reference, address: tuple[str | int, ...]) -> int:
        if reference.tag is not None:
            found = np.flatnonzero(obstacles.tag == reference.tag)
            if len(found):
                return int(found[0])
            choices = ", ".join(sorted(obstacles.tag.tolist())[:20]) or "none: nothing was detected"
            raise self._error((*address, "tag"), f"no obstacle is called {reference.tag!r}; valid: {choices}")
        assert reference.at is not None
        distance = np.linalg.norm(obstacles.position - np.array(reference.at), axis=1)
        if reference.affordance is not None:
            distance = np.where(obstacles.affordance == reference.affordance, distance, np.inf)
        order = np.argsort(distance, kind="stable")
        what = reference.affordance or "obstacle"
        if not len(order) or distance[order[0]] > reference.within:
            near = [
                f"{obstacles.tag[k]} ({distance[k]:.2f} m away)"
                for k in order[:3]
                if np.isfinite(distance[k])
            ]
            raise self._error(
                (*address, "at"),
                f"no {what} within {reference.within:g} m; nearest: {', '.join(near) or 'none'}",
            )
        if len(order) > 1 and distance[order[1]] <= min(reference.within, distance[order[0]] + 0.05):
            pair = f"{obstacles.tag[order[0]]} and {obstacles.tag[order[1]]}"
            raise self._error((*address, "at"), f"both {pair} are here; name the affordance or the tag")
        return int(order[0])

    def _error(self, address: tuple[str | int, ...], problem: str) -> SurefootError:
        if self.located is None:
            return NavmeshError(f"tags: {'.'.join(str(step) for step in address)}: {problem}")
        return self.located.error(address, problem)


def load_tags(path: str | os.PathLike[str]) -> TagFile:
    """Read a tag file. Raises `FileError` with line and column for anything wrong in it."""
    return TagFile(*read_yaml(path, Tags, "tag file"))


def _change(arrays: dict[str, np.ndarray], index: int, values: NewValues) -> None:
    """Put new values into row ``index``; a new width is taken up evenly around the middle of the edge."""
    if values.name is not None:
        arrays["tag"][index] = values.name
    if values.height is not None:
        shift = values.height - arrays["height"][index]
        arrays["height"][index] = values.height
        arrays["rim_height"][index] += shift
        arrays["rise"][index] += kind_of(str(arrays["affordance"][index])).rises * shift
    if values.width is not None:
        middle = arrays["position"][index]
        factor = values.width / arrays["width"][index]
        arrays["rim"][index] = middle + factor * (arrays["rim"][index] - middle)
        arrays["rim_height"][index] = arrays["height"][index] + factor * (
            arrays["rim_height"][index] - arrays["height"][index]
        )
        arrays["width"][index] = values.width
    for name in ("depth", "run_up", "landing"):
        if getattr(values, name) is not None:
            arrays[name][index] = getattr(values, name)
    arrays["authored"][index] = True


def _row(addition: Addition) -> dict:
    """The values of an added obstacle by the names of `Obstacles`; run-up and landing may be None."""
    heading = math.radians(addition.run_towards_deg)
    run = np.array([math.cos(heading), math.sin(heading), 0.0])
    left = np.array([-run[1], run[0], 0.0])
    position = np.array(addition.position, np.float64)
    height = addition.height or 0.0
    return {
        "affordance": addition.affordance,
        "position": position,
        "normal": -run,
        "height": height,
        "depth": addition.depth or 0.0,
        "width": addition.width,
        "rim": np.array([position + 0.5 * addition.width * left, position - 0.5 * addition.width * left]),
        "rim_height": np.array([height, height]),
        "run_up": addition.run_up,
        "landing": addition.landing,
        "rise": kind_of(addition.affordance).rises * height,
        "tag": addition.name,
        "authored": True,
    }


def _measured(row: dict, side: str, surface: Surface, walking: WalkRules) -> float:
    """Free length [m] before (``side`` "run_up") or behind ("landing") an added obstacle; 0 without floor."""
    x, y, z = row["position"] - surface.origin
    dx, dy, _ = row["normal"] if side == "run_up" else -row["normal"]
    floor = z - row["height"] if kind_of(row["affordance"]).from_below else z
    if side == "landing":
        x, y = x + row["depth"] * dx, y + row["depth"] * dy
        floor += row["rise"]
    return float(room(cells_of(surface), x, y, floor, dx, dy, math.tan(walking.max_slope), REACH)[0])
