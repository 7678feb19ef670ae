"""Trace files: a recorded run, enough to draw and replay it without the level's files."""

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np
from annotated_types import Ge, Le, Len
from pydantic import BaseModel, ConfigDict

from runtime.bodies.figure import Figure, Shapes
from surefoot.files.archive import read_archive, write_archive
from surefoot.files.schema import Array, Flags, Header, Indices, Numbers, Rising, Schema

__all__ = ["AgentTrace", "LevelTrace", "PathTrace", "Trace"]

_LONGEST_PAUSE = 10.0  # [s] between two poses
_UNIT = 0.01  # tolerance of a quaternion's length


@dataclass(frozen=True)
class PathTrace:
    """One planned path: node centres from A*, the string-pulled line, the smoothed line, each (k, 3) float64
    [m]."""

    raw: np.ndarray
    pulled: np.ndarray
    smooth: np.ndarray


@dataclass(frozen=True)
class LevelTrace:
    """The level as it was drawn and walked.

    ``vertices`` (v, 3) float64 [m], ``faces`` (f, 3) int32; graph: ``positions`` (n, 3), ``radii`` (n,) [m],
    ``edges`` (e, 2) int32; obstacles: ``affordances`` (k,) names, ``rim`` (k, 2, 3) [m], ``normal`` (k, 3)
    and ``height`` (k,) [m] as in `NodeGraph.obstacles`.
    """

    vertices: np.ndarray
    faces: np.ndarray
    positions: np.ndarray
    radii: np.ndarray
    edges: np.ndarray
    affordances: tuple[str, ...]
    rim: np.ndarray
    normal: np.ndarray
    height: np.ndarray


@dataclass(frozen=True)
class AgentTrace:
    """One figure: ``poses`` (t, nbody, 7) float32, position [m] and quaternion wxyz; its paths in order.
    ``held`` (t, k) bool: when each of the last k bodies, which are things to hold, is in its hands."""

    name: str
    figure: Figure
    poses: np.ndarray
    paths: tuple[PathTrace, ...]
    held: np.ndarray = field(default_factory=lambda: np.zeros((0, 0), np.bool_))

    @property
    def own(self) -> int:
        """How many of the bodies are no things."""
        return len(self.figure.bodies) - self.held.shape[1]

    def posed(self, moment: int, pose: np.ndarray) -> Shapes:
        """What is seen of it in a ``pose`` (nbody, 7) at the ``moment`` of that number."""
        shapes, things = self.figure.posed(pose), self.held.shape[1]
        if things == 0 or self.held[moment].all():
            return shapes
        shown = np.concatenate([np.ones(self.own, np.bool_), self.held[moment]])[self.figure.owner]
        return Shapes(*(part[shown] for part in (shapes.place, shapes.size, shapes.round, shapes.colour)))


@dataclass(frozen=True)
class Trace:
    """A run: ``times`` (t,) float64 [s] of the poses, events as plain values, hash of the last state.

    ``report`` is what `mission_run` found: expectations and whether they held.
    """

    level: LevelTrace
    times: np.ndarray
    agents: tuple[AgentTrace, ...]
    events: tuple[Mapping[str, Any], ...]
    state_hash: str
    report: Mapping[str, Any] = field(default_factory=dict)

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write the trace to ``path``, whole or not at all."""
        arrays: dict[str, np.ndarray] = {"times": self.times}
        header: dict[str, Any] = {
            "events": list(self.events),
            "state_hash": self.state_hash,
            "report": dict(self.report),
            "affordances": list(self.level.affordances),
            "agents": [],
        }
        for name in _LEVEL_ARRAYS:
            arrays[f"level.{name}"] = getattr(self.level, name)
        for i, agent in enumerate(self.agents):
            header["agents"].append(
                {
                    "name": agent.name, "bodies": list(agent.figure.bodies), "paths": len(agent.paths),
                    "things": agent.held.shape[1],
                }
            )  # fmt: skip
            if agent.held.shape[1]:
                arrays[f"agent{i}.held"] = agent.held
            arrays[f"agent{i}.poses"] = agent.poses
            arrays[f"agent{i}.parents"], arrays[f"agent{i}.owner"] = agent.figure.parents, agent.figure.owner
            for name in _SHAPE_ARRAYS:
                arrays[f"agent{i}.{name}"] = getattr(agent.figure.shapes, name)
            for j, planned in enumerate(agent.paths):
                for name in _PATH_ARRAYS:
                    arrays[f"agent{i}.path{j}.{name}"] = getattr(planned, name)
        write_archive(path, TRACE_FILE.kind, TRACE_FILE.version, header, arrays)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> "Trace":
        """Read what `write` wrote; raises `surefoot.files.archive.ArchiveError` for any other file."""
        header, arrays = read_archive(path, TRACE_FILE)
        return cls(
            level=LevelTrace(
                affordances=header.affordances, **{name: arrays[f"level.{name}"] for name in _LEVEL_ARRAYS}
            ),
            times=arrays["times"],
            agents=tuple(_agent(i, entry, arrays) for i, entry in enumerate(header.agents)),
            events=tuple(event.model_dump() for event in header.events),
            state_hash=header.state_hash,
            report=header.report,
        )


class _AgentEntry(Header):
    name: str
    bodies: Annotated[tuple[str, ...], Len(1)]
    paths: Annotated[int, Ge(0), Le(100_000)]
    things: Annotated[int, Ge(0), Le(64)] = 0


class _EventEntry(BaseModel):
    """Fields of an event as plain values; others may follow."""

    model_config = ConfigDict(extra="allow", strict=True, frozen=True, allow_inf_nan=False)

    kind: str
    time: float
    agent: str
    position: Annotated[list[float], Len(3, 3)]


class _TraceHeader(Header):
    events: tuple[_EventEntry, ...]
    state_hash: str
    report: dict[str, Any]
    affordances: tuple[str, ...]
    agents: Annotated[tuple[_AgentEntry, ...], Len(1)]


_LEVEL_ARRAYS: dict[str, Array] = {
    "vertices": Numbers("vertices", 3),
    "faces": Indices("faces", 3, into="vertices"),
    "positions": Numbers("nodes", 3),
    "radii": Numbers("nodes", low=0.0),
    "edges": Indices("edges", 2, into="nodes"),
    "rim": Numbers("obstacles", 2, 3),
    "normal": Numbers("obstacles", 3),
    "height": Numbers("obstacles"),
}
_SHAPE_ARRAYS = ("place", "size", "round", "colour")
_PATH_ARRAYS = ("raw", "pulled", "smooth")


def _arrays_of(header: _TraceHeader) -> dict[str, Array]:
    arrays: dict[str, Array] = {"times": Rising("times", low=0.0)}
    arrays |= {f"level.{name}": kind for name, kind in _LEVEL_ARRAYS.items()}
    for i, agent in enumerate(header.agents):
        own, bodies, shapes = f"agent{i}.", len(agent.bodies), f"shapes of agent {i}"
        arrays |= {
            f"{own}poses": Numbers("times", bodies, 7, dtype="float32"),
            f"{own}parents": Indices(bodies, into=bodies, none=True),
            f"{own}owner": Indices(shapes, into=bodies),
            f"{own}place": Numbers(shapes, 7),
            f"{own}size": Numbers(shapes, 3, low=0.0, high=1e3),
            f"{own}round": Flags(shapes),
            f"{own}colour": Numbers(shapes, 3, low=0.0, high=1.0),
        }
        if agent.things:
            arrays[f"{own}held"] = Flags("times", agent.things)
        for j in range(agent.paths):
            for name in _PATH_ARRAYS:
                arrays[f"{own}path{j}.{name}"] = Numbers(f"{name} points of path {i}.{j}", 3)
    return arrays


def _check(header: _TraceHeader, arrays: dict[str, np.ndarray]) -> str | None:
    """What is inconsistent between the arrays of a trace; None if nothing."""
    if len(arrays["level.height"]) != len(header.affordances):
        return f"names {len(header.affordances)} obstacles and holds {len(arrays['level.height'])}"
    if (np.diff(arrays["times"]) > _LONGEST_PAUSE).any():
        return f"times are more than {_LONGEST_PAUSE:g} s apart"
    names = [agent.name for agent in header.agents]
    if len(set(names)) < len(names):
        return "two of its agents have the same name"
    if unknown := [event.agent for event in header.events if event.agent not in names]:
        return f"tells of {unknown[0][:40]!r}, which is not one of its agents"
    for i, agent in enumerate(header.agents):
        if agent.things >= len(agent.bodies):
            return f"agent {agent.name[:40]!r} has {len(agent.bodies)} bodies, {agent.things} of them things"
        parents = arrays[f"agent{i}.parents"]
        if (parents >= np.arange(len(parents))).any():
            return f"agent{i}.parents must come before their children"
        for name in ("poses", "place"):
            length = np.linalg.norm(arrays[f"agent{i}.{name}"][..., 3:], axis=-1)
            if (np.abs(length - 1.0) > _UNIT).any():
                return f"agent{i}.{name} holds quaternions that are not of length 1"
    return None


TRACE_FILE = Schema(
    kind="surefoot trace",
    version=1,
    header=_TraceHeader,
    arrays=_arrays_of,
    remedy="run the mission again",
    check=_check,
)


def _agent(index: int, entry: _AgentEntry, arrays: Mapping[str, np.ndarray]) -> AgentTrace:
    own = f"agent{index}."
    shapes = Shapes(**{name: arrays[own + name] for name in _SHAPE_ARRAYS})
    figure = Figure(entry.bodies, arrays[own + "parents"], arrays[own + "owner"], shapes)
    paths = tuple(
        PathTrace(**{name: arrays[f"{own}path{j}.{name}"] for name in _PATH_ARRAYS})
        for j in range(entry.paths)
    )
    held = arrays.get(own + "held", np.zeros((0, 0), np.bool_))
    return AgentTrace(entry.name, figure, arrays[own + "poses"], paths, held)
