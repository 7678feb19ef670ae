"""Mission files: a level, agents with a start and waypoints, and what is expected of them.

```yaml
level: {file: ../levels/courtyard.obj, up: z, scale: 1.0}
rules: {max_slope_deg: 45, max_step: 0.3}
seed: 1
time_limit: 60
agents:
  - name: ada
    body: human
    start: [0, 0, 0]
    facing_deg: 90
    speed: 3.5
    goto:
      - [12, 0, 0]
    expect: {arrives_within: 30, never_falls: true, uses_skills: [jump]}
```

Paths in a mission are relative to the mission's file.
"""

import os
from pathlib import Path
from typing import Annotated, Literal, Self

from annotated_types import Ge, Gt, Le, Len
from pydantic import AfterValidator, BaseModel, ConfigDict, StringConstraints

import navmesh
from navmesh.yamlfile import FileError, Located, read_yaml
from runtime.rules import walk_rules

__all__ = ["AgentSpec", "Expectation", "LevelSpec", "LoadedMission", "Mission", "RulesSpec", "load_mission"]

MAX_COORDINATE = 1e6


def _near(value: float) -> float:
    if not -MAX_COORDINATE <= value <= MAX_COORDINATE:
        raise ValueError(f"a coordinate is within ±{MAX_COORDINATE:g} m")
    return value


Coordinate = Annotated[float, AfterValidator(_near)]
Point = Annotated[list[Coordinate], Len(3, 3)]
Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z_][A-Za-z0-9_-]{0,39}$")]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


class LevelSpec(_Strict):
    """The mesh that the mission runs on."""

    file: str
    """Mesh file, relative to the mission's."""
    up: Literal["x", "y", "z"] = "z"
    """Axis of the file that points up; the coordinates in the mission are Z up in any case."""
    scale: Annotated[float, Gt(0.0), Le(1e6)] = 1.0
    """Metres per unit of the file."""
    tags: str | None = None
    """File with authored obstacle tags, relative to the mission's; by default the one beside the level."""


class RulesSpec(_Strict):
    """Where a body can walk; what is left out is as all the bodies of the mission need it."""

    max_slope_deg: Annotated[float, Gt(0.0), Le(89.0)] | None = None
    """[°] steeper faces end the walkable surface."""
    max_step: Annotated[float, Ge(0.0), Le(10.0)] | None = None
    """[m] higher steps end the walkable surface."""
    headroom: Annotated[float, Gt(0.0), Le(100.0)] | None = None
    """[m] free height above the floor that walking needs."""
    resolution: Annotated[float, Ge(0.02), Le(2.0)] | None = None
    """[m] width of a cell of the surface."""


class Expectation(_Strict):
    """What has to hold for the mission to succeed; what is left out is not looked at."""

    arrives_within: Annotated[float, Gt(0.0), Le(86400.0)] | None = None
    """[s] simulated time by which the last waypoint is reached."""
    never_falls: bool | None = None
    """Whether the agent stays on its feet for the whole mission."""
    uses_skills: list[Literal["jump"]] | None = None
    """Skills that the agent finishes at least once."""


class AgentSpec(_Strict):
    """One figure: where it starts and where it goes."""

    name: Name
    body: Literal["human", "walker", "dog", "cat", "horse"] = "human"
    start: Point
    """[m] (x, y, z), Z up; snapped to the walkable surface below."""
    facing_deg: Annotated[float, Ge(-360.0), Le(360.0)] = 0.0
    """[°] counter-clockwise from the X axis."""
    speed: Annotated[float, Ge(0.5), Le(6.0)] = 3.5
    """[m/s] along its path."""
    goto: Annotated[list[Point], Len(1, 1000)]
    """Waypoints [m], reached one after the other."""
    expect: Expectation = Expectation()


class Mission(_Strict):
    """The content of a mission file."""

    level: LevelSpec
    rules: RulesSpec = RulesSpec()
    seed: Annotated[int, Ge(0), Le(2**63 - 1)] = 0
    time_limit: Annotated[float, Gt(0.0), Le(86400.0)] = 120.0
    """[s] simulated time after which the mission ends in any case."""
    agents: Annotated[list[AgentSpec], Len(1, 100)]


class LoadedMission:
    """A checked mission with the place of its file: resolves paths, and errors name the line.

    ``level_path`` and ``tags_path`` (or None) exist.
    """

    def __init__(self, mission: Mission, located: Located) -> None:
        self.mission = mission
        self.path = located.path
        self._located = located
        self._check_names()
        self.level_path = self._existing(("level", "file"), mission.level.file, "level")
        tags = mission.level.tags
        self.tags_path = None if tags is None else self._existing(("level", "tags"), tags, "tags file")

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Self:
        """Read and check the mission at ``path``; raises `navmesh.yamlfile.FileError`."""
        mission, located = read_yaml(path, Mission, "mission")
        return cls(mission, located)

    def rules(self) -> navmesh.WalkRules:
        """The walk rules of the mission, defaults filled in."""
        try:
            return walk_rules(
                {agent.body for agent in self.mission.agents}, **self.mission.rules.model_dump()
            )
        except navmesh.NavmeshError as error:
            raise self.error(("rules",), f"rules: {error}") from None

    def error(self, address: tuple[str | int, ...], problem: str) -> FileError:
        """An error whose message names the line and column of ``address`` in the file."""
        return self._located.error(address, problem)

    def _existing(self, address: tuple[str | int, ...], name: str, what: str) -> Path:
        path = self.path.parent / name
        try:
            found = path.is_file()
        except (OSError, ValueError):
            found = False
        if not found:
            raise self.error(address, f"{'.'.join(map(str, address))}: no such {what}: {str(path)!r}")
        return path

    def _check_names(self) -> None:
        seen: set[str] = set()
        for i, agent in enumerate(self.mission.agents):
            if agent.name in seen:
                raise self.error(
                    ("agents", i, "name"), f"agents[{i}].name: {agent.name!r} is taken; names are unique"
                )
            seen.add(agent.name)


def load_mission(path: str | os.PathLike[str]) -> LoadedMission:
    """Read and check the mission at ``path``; raises `navmesh.yamlfile.FileError` naming line and column."""
    return LoadedMission.read(path)
