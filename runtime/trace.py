"""Trace files: everything that a run left behind, enough to draw and replay it without the level."""

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from navmesh.files.archive import ArchiveError, read_archive, write_archive
from runtime.figure import Figure, Shapes

__all__ = ["AgentTrace", "LevelTrace", "PathTrace", "Trace"]

KIND = "surefoot trace"
VERSION = 1


@dataclass(frozen=True)
class PathTrace:
    """One planned path: node centres that A* chose, pulled line, smoothed line, each (k, 3) float64 [m]."""

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
    """One figure: ``poses`` (t, nbody, 7) float32, position [m] and quaternion wxyz; its paths in order."""

    name: str
    figure: Figure
    poses: np.ndarray
    paths: tuple[PathTrace, ...]


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
                {"name": agent.name, "bodies": list(agent.figure.bodies), "paths": len(agent.paths)}
            )
            arrays[f"agent{i}.poses"] = agent.poses
            arrays[f"agent{i}.parents"], arrays[f"agent{i}.owner"] = agent.figure.parents, agent.figure.owner
            for name in _SHAPE_ARRAYS:
                arrays[f"agent{i}.{name}"] = getattr(agent.figure.shapes, name)
            for j, planned in enumerate(agent.paths):
                for name in _PATH_ARRAYS:
                    arrays[f"agent{i}.path{j}.{name}"] = getattr(planned, name)
        write_archive(path, KIND, VERSION, header, arrays)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> "Trace":
        """Read what `write` wrote; raises `navmesh.files.archive.ArchiveError` for any other file."""
        header, arrays = read_archive(path, KIND, VERSION)
        try:
            agents = tuple(_agent(i, entry, arrays) for i, entry in enumerate(header["agents"]))
            level = {name: arrays[f"level.{name}"] for name in _LEVEL_ARRAYS}
            return cls(
                level=LevelTrace(affordances=tuple(header["affordances"]), **level),
                times=arrays["times"],
                agents=agents,
                events=tuple(header["events"]),
                state_hash=header["state_hash"],
                report=header["report"],
            )
        except (KeyError, TypeError) as error:
            raise ArchiveError(
                f"{path}: not a whole {KIND}: {error} is missing; run the mission again"
            ) from None


_LEVEL_ARRAYS = ("vertices", "faces", "positions", "radii", "edges", "rim", "normal", "height")
_SHAPE_ARRAYS = ("place", "size", "round", "colour")
_PATH_ARRAYS = ("raw", "pulled", "smooth")


def _agent(index: int, entry: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> AgentTrace:
    own = f"agent{index}."
    shapes = Shapes(**{name: arrays[own + name] for name in _SHAPE_ARRAYS})
    figure = Figure(tuple(entry["bodies"]), arrays[own + "parents"], arrays[own + "owner"], shapes)
    paths = tuple(
        PathTrace(**{name: arrays[f"{own}path{j}.{name}"] for name in _PATH_ARRAYS})
        for j in range(entry["paths"])
    )
    return AgentTrace(name=entry["name"], figure=figure, poses=arrays[own + "poses"], paths=paths)
