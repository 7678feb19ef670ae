"""Playtest files: where players appear, where they should get to, and who plays. YAML beside the level.

```yaml
character: {radius: 0.3, skills: {jump: [0.15, 0.7], drop: [0.15, 2.0]}}
spawns:
  - {name: gate, at: [2.4, 26.0, 0.0]}
places:
  - {name: stage, at: [30.0, 29.0, 0.45]}
  - {name: trench, at: [42.8, 27.0, -2.5], reachable: false}
routes:
  - {from: gate, to: stage, at_most: 40.0}
```

Everything may be left out. ``level.obj`` is played by ``level.playtest.yaml`` when there is one, and the open
world in the folder ``city.world`` by ``city.playtest.yaml``.
"""

import math
import os
from pathlib import Path
from typing import Annotated, Self

from annotated_types import Ge, Gt, Le, Len
from pydantic import BaseModel, ConfigDict, Field

import navmesh
from navmesh.obstacles.kinds import affordances
from runtime.missions.model import Name, Point
from runtime.playtest.character import Character, changed
from surefoot.files.choices import OneOf
from surefoot.files.yamlfile import FileError, Located, read_yaml

__all__ = ["LoadedPlan", "PlaceSpec", "Plan", "RouteSpec", "SpawnSpec", "plan_path"]

Range = Annotated[list[Annotated[float, Ge(0.0), Le(100.0)]], Len(2, 2)]


class _Strict(BaseModel):
    model_config = ConfigDict(
        extra="forbid", strict=True, frozen=True, allow_inf_nan=False, populate_by_name=True
    )


class CharacterSpec(_Strict):
    """Who plays; what is left out is as the body has it."""

    radius: Annotated[float, Ge(0.05), Le(10.0)] | None = None
    """[m] of the body."""
    height: Annotated[float, Gt(0.0), Le(100.0)] | None = None
    """[m] free height that it needs."""
    max_step: Annotated[float, Ge(0.0), Le(10.0)] | None = None
    """[m] that it steps up or down without a skill."""
    max_slope_deg: Annotated[float, Gt(0.0), Le(89.0)] | None = None
    """[°] that it walks up."""
    speed: Annotated[float, Ge(0.5), Le(6.0)] | None = None
    """[m/s]"""
    skills: dict[Annotated[str, OneOf(affordances)], Range] | None = None
    """Least and greatest height (gap: width) [m] that it clears; replaces those of the body."""


class SpawnSpec(_Strict):
    """Where players appear."""

    name: Name
    at: Point
    """[m] (x, y, z), Z up; snapped to the walkable surface."""


class PlaceSpec(_Strict):
    """Somewhere that players should, or should not, be able to get to."""

    name: Name
    at: Point
    reachable: bool = True


class RouteSpec(_Strict):
    """How long the way from a spawn or place to another may be."""

    start: Annotated[Name, Field(alias="from")]
    to: Name
    at_most: Annotated[float, Gt(0.0), Le(1e6)]
    """[m]"""


class Plan(_Strict):
    """The content of a playtest file."""

    character: CharacterSpec = CharacterSpec()
    radius: Annotated[float, Gt(0.0), Le(1e5)] = 250.0
    """[m] Of an open world: how far around a bot chunks are loaded."""
    spawns: Annotated[list[SpawnSpec], Len(0, 1000)] = []
    places: Annotated[list[PlaceSpec], Len(0, 1000)] = []
    routes: Annotated[list[RouteSpec], Len(0, 1000)] = []


class LoadedPlan:
    """A checked plan; ``located`` is None for the plan of nobody, which has nothing in it."""

    def __init__(self, plan: Plan, located: Located | None) -> None:
        self.plan = plan
        self.path = None if located is None else located.path
        self._located = located
        self._check_names()

    @classmethod
    def read(cls, path: str | os.PathLike[str] | None) -> Self:
        """Read and check the plan at ``path``; None stands for an empty one. Raises `FileError`."""
        if path is None:
            return cls(Plan(), None)
        return cls(*read_yaml(path, Plan, "playtest"))

    def character(self, body: Character) -> Character:
        """``body`` with what the plan says of who plays."""
        spec = self.plan.character
        steepest = None if spec.max_slope_deg is None else math.radians(spec.max_slope_deg)
        rules = {"headroom": spec.height, "max_step": spec.max_step, "max_slope": steepest}
        skills = (
            None if spec.skills is None else {name: (low, high) for name, (low, high) in spec.skills.items()}
        )
        for name, (low, high) in (skills or {}).items():
            if low > high:
                address = ("character", "skills", name)
                raise self.error(
                    address, f"{'.'.join(address)}: least {low:g} m is above greatest {high:g} m"
                )
        try:
            given = {name: value for name, value in rules.items() if value is not None}
            return changed(body, spec.radius, spec.speed, given, skills)
        except navmesh.NavmeshError as error:
            raise self.error(("character",), f"character: {error}") from None

    def error(self, address: tuple[str | int, ...], problem: str) -> FileError:
        """An error that names the line and column of ``address`` in the file."""
        assert self._located is not None
        return self._located.error(address, problem)

    def _check_names(self) -> None:
        seen: set[str] = set()
        for kind, entries in (("spawns", self.plan.spawns), ("places", self.plan.places)):
            for i, entry in enumerate(entries):
                if entry.name in seen:
                    problem = f"{kind}[{i}].name: {entry.name!r} is taken; names are unique"
                    raise self.error((kind, i, "name"), problem)
                seen.add(entry.name)
        for i, route in enumerate(self.plan.routes):
            for key, name in (("from", route.start), ("to", route.to)):
                if name not in seen:
                    valid = ", ".join(sorted(seen)) or "none: name spawns or places first"
                    raise self.error(
                        ("routes", i, key), f"routes[{i}].{key}: unknown {name!r}; valid: {valid}"
                    )


def plan_path(level: str | os.PathLike[str]) -> Path:
    """Where the plan of ``level`` is looked for: ``level.obj`` → ``level.playtest.yaml``."""
    return Path(level).with_suffix(".playtest.yaml")
