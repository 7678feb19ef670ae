"""Mission files: a level, agents with what they do, what is expected of them.

See ``docs/guides/missions.md``.

```yaml
level: {file: ../levels/courtyard.obj, up: z, scale: 1.0}
seed: 1
time_limit: 60
agents:
  - name: ada
    body: human
    start: [0, 0, 0]
    speed: 3.5
    goto:
      - [12, 0, 0]
    expect: {arrives_within: 30, never_falls: true, uses_skills: [jump]}
```

Paths in a mission are relative to the mission's file.
"""

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Self

import numpy as np
from pydantic.json_schema import GenerateJsonSchema

import navmesh
from locomotion import LocomotionError, load_run_skill
from locomotion.skills.description import load_described
from navmesh.streaming.world_folder import INDEX
from runtime.bodies.registry import is_body_file, kind_of
from runtime.errors import RuntimeInputError
from runtime.missions.model import Mission, RulesSpec, Step
from runtime.planning.rules import walk_rules
from surefoot.files.inputs import note_input
from surefoot.files.yamlfile import FileError, Located, dotted, nearest, read_yaml

__all__ = ["Address", "LoadedMission", "load_mission", "mission_schema", "places_in", "places_of", "steps_of"]

Address = tuple[str | int, ...]


class LoadedMission:
    """A checked mission with the place of its file: resolves paths and names, and errors name the line.

    ``level_path`` and ``tags_path`` (or None) exist; ``open_world``: whether the level is one, a folder.
    ``bodies`` are the agents' in order, as
    `runtime.World.spawn` takes them: files of one's own are sound, and their paths resolved. ``skill_paths``
    are those of skills of one's own, sound too. Every name that the mission mentions stands in it.
    """

    def __init__(self, mission: Mission, located: Located) -> None:
        self.mission = mission
        self.path = located.path
        self._located = located
        self._check_unique()
        self._check_mentions()
        self.open_world = _is(Path.is_dir, self.path.parent / mission.level.file)
        self.level_path = self._level()
        self.bodies = [self._body(i, agent.body) for i, agent in enumerate(mission.agents)]
        self.skill_paths = [self._skill(k, name) for k, name in enumerate(mission.skills)]
        tags = mission.level.tags
        self.tags_path = None if tags is None else self._existing(("level", "tags"), tags, "tags file")

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Self:
        """Read and check the mission at ``path``; raises `FileError`."""
        mission, located = read_yaml(path, Mission, "mission")
        return cls(mission, located)

    def rules(self) -> navmesh.WalkRules:
        """The walk rules of the mission, defaults filled in."""
        try:
            return walk_rules(set(self.bodies), **self.mission.rules.model_dump())
        except navmesh.NavmeshError as error:
            raise self.error(("rules",), str(error)) from None

    def point(self, place: Sequence[float] | str) -> np.ndarray:
        """The (3,) float64 [m] of a place: itself, or the waypoint of that name."""
        return np.array(self.mission.waypoints[place] if isinstance(place, str) else place, dtype=np.float64)

    @property
    def players(self) -> list[str | np.ndarray]:
        """Around whom an open world is loaded: names of agents, and places (3,) [m]."""
        names = [agent.name for agent in self.mission.agents]
        said = names if self.mission.players is None else self.mission.players
        return [each if each in names else self.point(each) for each in said]

    def error(self, address: Address, problem: str) -> FileError:
        """An error whose message names the line and column of ``address`` in the file."""
        return self._located.error(address, f"{dotted(address)}: {problem}")

    def unknown(self, address: Address, name: str, what: str, valid: Iterable[str]) -> FileError:
        """The error that ``name`` at ``address`` is none of the ``valid`` ones."""
        known = list(valid)
        valid_ones = f"{nearest(name, known)}valid: {', '.join(known) or 'none'}"
        return self.error(address, f"no {what} is called {name!r}; {valid_ones}")

    def _level(self) -> Path:
        """Path of a mesh file or of the folder of an open world, of which nothing is said that it cannot
        have."""
        mission, level, address = self.mission, self.mission.level, ("level", "file")
        if not self.open_world:
            for said, name, where in (
                (level, "radius", ("level", "radius")),
                (mission, "players", ("players",)),
            ):
                if name in said.model_fields_set:
                    raise self.error(where, "this is for open worlds; the level is a mesh, loaded as a whole")
            return self._existing(address, level.file, "level")
        for name in ("up", "scale", "tags"):
            if getattr(level, name) is not None:
                raise self.error(("level", name), "an open world is as it was baked; leave this out")
        if mission.rules != RulesSpec():
            raise self.error(("rules",), "an open world has the rules that it was baked with; leave this out")
        path = self.path.parent / level.file
        if not (path / INDEX).is_file():
            raise self.error(
                address,
                f"{str(path)!r} is a folder without an open world; expected a mesh file, or a folder that "
                "navmesh.bake_open_world has written",
            )
        note_input(path / INDEX)
        return path

    def _existing(self, address: Address, name: str, what: str) -> Path:
        path = self.path.parent / name
        if not _is(Path.is_file, path):
            raise self.error(address, f"no such {what}: {str(path)!r}")
        note_input(path)
        return path

    def _body(self, i: int, body: str) -> str:
        if not is_body_file(body):
            return body
        address: Address = ("agents", i, "body")
        path = str(self._existing(address, body, "body file"))
        try:
            kind_of(path).check(path)
        except RuntimeInputError as error:
            raise self.error(address, str(error)) from None
        return path

    def _skill(self, k: int, name: str) -> Path:
        path = self._existing(("skills", k), name, "skill file")
        try:
            load_described(path, load_run_skill())
        except LocomotionError as error:
            raise self.error(("skills", k), str(error)) from None
        return path

    def _check_unique(self) -> None:
        seen: set[str] = set()
        for i, agent in enumerate(self.mission.agents):
            if agent.name in seen:
                raise self.error(("agents", i, "name"), f"{agent.name!r} is taken; names are unique")
            seen.add(agent.name)

    def _check_mentions(self) -> None:
        mission = self.mission
        known: Mapping[str, Iterable[str]] = {
            "agent": [agent.name for agent in mission.agents],
            "waypoint": mission.waypoints,
            "region": mission.regions,
            "agent or waypoint": [*(agent.name for agent in mission.agents), *mission.waypoints],
        }
        for address, what, name, of in _mentions(mission):
            if name not in known[what]:
                raise self.unknown(address, name, what, known[what])
            if name == of:
                raise self.error(address, f"{name!r} is this agent itself; another one is needed")


def _is(kind: Callable[[Path], bool], path: Path) -> bool:
    """Whether there is something of a ``kind`` at a ``path``, which may be none at all."""
    try:
        return kind(path)
    except (OSError, ValueError):
        return False


def load_mission(path: str | os.PathLike[str]) -> LoadedMission:
    """Read and check the mission at ``path``; raises `FileError` naming line and column."""
    return LoadedMission.read(path)


def mission_schema() -> dict[str, Any]:
    """The JSON schema of mission files, for editors."""
    schema = Mission.model_json_schema()
    return {"$schema": GenerateJsonSchema.schema_dialect, "title": "Surefoot mission", **schema}


def places_of(goto: Any) -> Iterator[tuple[Address, Any]]:
    """The places of a ``goto``, one or several, each with its address below it."""
    if isinstance(goto, str) or not isinstance(goto[0], list | str):
        yield (), goto
    else:
        yield from (((k,), place) for k, place in enumerate(goto))


def places_in(step: Step) -> Iterator[tuple[Address, Any]]:
    """All places that a step mentions, with their addresses below it."""
    if step.goto is not None:
        yield from ((("goto", *address), place) for address, place in places_of(step.goto))
    if step.patrol is not None:
        yield from ((("patrol", "points", k), place) for k, place in enumerate(step.patrol.points))
    if step.use is not None and step.use.near is not None:
        yield ("use", "near"), step.use.near


def steps_of(mission: Mission) -> Iterator[tuple[Address, str, list[tuple[Address, Step]]]]:
    """Every script: address, name of the agent that performs it, its steps with their addresses."""
    for i, agent in enumerate(mission.agents):
        here: Address = ("agents", i)
        if agent.goto is not None:
            yield here, agent.name, [(here, agent.steps[0])]
        elif agent.script is not None:
            yield here, agent.name, [((*here, "script", k), step) for k, step in enumerate(agent.script)]
    for t, trigger in enumerate(mission.triggers):
        for o, order in enumerate(trigger.then):
            here = ("triggers", t, "then", o)
            yield here, order.agent, [((*here, "do", k), step) for k, step in enumerate(order.do)]


def _mentions(mission: Mission) -> Iterator[tuple[Address, str, str, str | None]]:
    """Address, kind and name of all that is mentioned by name, and the agent that it must not be."""
    for k, player in enumerate(mission.players or ()):
        if isinstance(player, str):
            yield ("players", k), "agent or waypoint", player, None
    for i, agent in enumerate(mission.agents):
        here: Address = ("agents", i)
        if isinstance(agent.start, str):
            yield (*here, "start"), "waypoint", agent.start, None
        for k, region in enumerate(agent.expect.stays_out_of or ()):
            yield (*here, "expect", "stays_out_of", k), "region", region, None
        for k, distance in enumerate(agent.expect.keeps_distance or ()):
            yield (*here, "expect", "keeps_distance", k, "to"), "agent", distance.to, agent.name
    for t, trigger in enumerate(mission.triggers):
        here, when = ("triggers", t, "when"), trigger.when
        for event in ("arrives", "falls"):
            if (name := getattr(when, event)) is not None:
                yield (*here, event), "agent", name, None
        for event, what in (("enters", when.enters), ("uses", when.uses)):
            if what is not None:
                yield (*here, event, "agent"), "agent", what.agent, None
        if when.enters is not None:
            yield (*here, "enters", "region"), "region", when.enters.region, None
        for o, order in enumerate(trigger.then):
            yield ("triggers", t, "then", o, "agent"), "agent", order.agent, None
    for _, performer, steps in steps_of(mission):
        for address, step in steps:
            for below, place in places_in(step):
                if isinstance(place, str):
                    yield (*address, *below), "waypoint", place, None
            if step.follow is not None:
                yield (*address, "follow", "agent"), "agent", step.follow.agent, performer
