"""Data of a run's page: a JSON header, and one block of bytes with the arrays that it names."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from locomotion import Rig
from runtime.events import event_text
from runtime.traces.trace import AgentTrace, LevelTrace, PathTrace, Trace
from runtime.views.camera import calm_track, size_of
from runtime.views.meshes import smooth_normals
from runtime.views.obstacle_colours import in_order, obstacle_colour, parts_of_colour
from runtime.views.worn import ground_of, only_things, wearers, worn_poses

__all__ = ["page_data"]

FRAME = 0.03
"""[s] least time between frames of the page."""
_WIDEST_QUATERNION = 32767.0


class _Block:
    """Consecutive arrays; `add` returns an array's entry for the header: kind, shape, first byte."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self._size = 0

    def add(self, array: np.ndarray, kind: str) -> dict[str, Any]:
        data = np.ascontiguousarray(array, dtype=kind).tobytes()
        data += bytes(-len(data) % 4)  # arrays are aligned to four bytes
        entry = {"kind": kind, "shape": list(array.shape), "at": self._size}
        self._parts.append(data)
        self._size += len(data)
        return entry

    def joined(self) -> bytes:
        return b"".join(self._parts)


def page_data(trace: Trace, follow: str | None, character: Rig | None = None) -> tuple[dict[str, Any], bytes]:
    """Header and arrays of ``trace``'s page, which opens on the agent ``follow``, None: the first. People
    wear the ``character``, if there is one; `RuntimeInputError` if there are no people.

    Lengths are in metres, relative to the middle of the level, so that single precision is enough.
    """
    block = _Block()
    origin = 0.5 * (trace.level.vertices.min(axis=0) + trace.level.vertices.max(axis=0))
    frames = _frames(trace.times)
    header = {
        "follow": follow if follow is not None else next((agent.name for agent in trace.agents), None),
        "times": block.add(trace.times[frames], "<f4"),
        "level": _level(block, trace.level, origin),
        "agents": [_agent(block, agent, trace.times, frames, origin) for agent in trace.agents],
        "skins": [],
        "events": [
            {"time": float(event["time"]), "agent": event["agent"], "text": event_text(event)}
            for event in _in_short(trace.events)
        ],
    }
    if character is not None:
        header["skins"] = _skins(block, trace, character, frames, origin)
        header["character"] = _character(block, character)
    return header, block.joined()


def _in_short(events: Sequence[Mapping[str, Any]]) -> Iterator[Mapping[str, Any]]:
    """The events, with only the first of several departures of an agent in a row: a follower replans twice a
    second."""
    latest: dict[str, str] = {}
    for event in events:
        kind, before = event["kind"], latest.get(event["agent"])
        latest[event["agent"]] = kind
        if not kind == before == "Departed":
            yield event


def _frames(times: np.ndarray) -> np.ndarray:
    """Indices of the poses to show, at least `FRAME` apart."""
    kept = [0]
    for k, moment in enumerate(times):
        if moment - times[kept[-1]] >= FRAME - 1e-6:
            kept.append(k)
    return np.array(kept, dtype=np.int64)


def _level(block: _Block, level: LevelTrace, origin: np.ndarray) -> Mapping[str, Any]:
    wide = level.radii > 0.3
    edges = level.edges[wide[level.edges].all(axis=1)] if len(level.edges) else level.edges
    return {
        "vertices": block.add(level.vertices - origin, "<f4"),
        "faces": block.add(level.faces, "<u4"),
        "discs": block.add(np.column_stack([level.positions - origin, level.radii])[wide], "<f4"),
        "edges": block.add((level.positions - origin)[edges], "<f4"),
        "rims": block.add(level.rim - origin, "<f4"),
        "obstacles": [
            {"affordance": affordance, "label": f"{affordance} {abs(height):.2f} m"}
            for affordance, height in zip(level.affordances, level.height.tolist(), strict=True)
        ],
        "colours": {
            affordance: [part / 255.0 for part in parts_of_colour(obstacle_colour(affordance))]
            for affordance in in_order(level.affordances)
        },
    }


def _agent(
    block: _Block, agent: AgentTrace, times: np.ndarray, frames: np.ndarray, origin: np.ndarray
) -> Mapping[str, Any]:
    shapes = agent.figure.shapes
    poses = agent.poses[frames]
    return {
        "name": agent.name,
        "size": size_of(agent),
        **_places(block, poses, origin),
        "own": agent.own,
        "held": block.add(agent.held[frames] if agent.held.shape[1] else agent.held, "<i2"),
        "calm": block.add(calm_track(agent, times, times[frames]) - origin, "<f4"),
        "owner": block.add(agent.figure.owner, "<u4"),
        "place": block.add(shapes.place, "<f4"),
        "sizes": block.add(shapes.size, "<f4"),
        "round": block.add(shapes.round, "<u4"),
        "colours": block.add(shapes.colour, "<f4"),
        "paths": [_path(block, planned, origin) for planned in agent.paths],
    }


def _places(block: _Block, poses: np.ndarray, origin: np.ndarray) -> dict[str, Any]:
    """``poses`` (t, n, 7) as arrays of the page."""
    return {
        "positions": block.add(poses[..., :3].astype(np.float64) - origin, "<f4"),
        "turns": block.add(np.rint(poses[..., 3:] * _WIDEST_QUATERNION), "<i2"),
    }


def _skins(
    block: _Block, trace: Trace, rig: Rig, frames: np.ndarray, origin: np.ndarray
) -> list[dict[str, Any]]:
    """Of each agent that wears the character where its bones are, and where what it holds is."""
    ground, skins = ground_of(trace.level), []
    for agent in wearers(trace.agents):
        worn = worn_poses(rig, agent, trace.times, ground)
        things = only_things(agent, rig, worn)
        held = None if things is None else _places(block, things.poses[frames], origin)
        skins.append(
            {
                "agent": trace.agents.index(agent),
                "bones": _places(block, worn[frames], origin),
                "things": held,
            }
        )
    return skins


def _character(block: _Block, rig: Rig) -> dict[str, Any]:
    """The mesh of a character: its points at rest, with the bones that move them."""
    mesh = rig.skeleton.mesh
    return {
        "rest": block.add(rig.rest, "<f4"),
        "points": block.add(mesh.points, "<f4"),
        "normals": block.add(smooth_normals(mesh.points, mesh.faces), "<f4"),
        "bones": block.add(mesh.bones, "<u4"),
        "shares": block.add(mesh.shares, "<f4"),
        "faces": block.add(mesh.faces, "<u4"),
        "colours": block.add(mesh.colours, "<f4"),
    }


def _path(block: _Block, planned: PathTrace, origin: np.ndarray) -> Mapping[str, Any]:
    return {name: block.add(getattr(planned, name) - origin, "<f4") for name in ("raw", "pulled", "smooth")}
