"""The levels of a server: what clients are told of them, and what worlds are made of."""

from collections.abc import Mapping, Sequence
from copy import copy
from typing import Any, TypeVar

from pydantic_core import to_json

import navmesh
from locomotion.body.models import person_on
from runtime.errors import RuntimeInputError
from runtime.planning.level import Level
from runtime.traces.recording import level_trace
from surefoot.pausing import pause

__all__ = ["Levels", "graph_message", "mesh_message"]

_DRAWN = ("positions", "radii", "edges", "rim", "normal", "height")
_AT_ONCE = 4  # chunks that are loaded in one piece
_Level = TypeVar("_Level")


class Levels:
    """``levels`` by name: graphs, and open worlds, of which nothing need be loaded. Raises
    `RuntimeInputError` where a request does not fit a level."""

    def __init__(self, levels: Mapping[str, navmesh.NodeGraph | navmesh.OpenWorld]) -> None:
        self._levels = dict(levels)
        graphs = {name: level for name, level in levels.items() if isinstance(level, navmesh.NodeGraph)}
        for graph in graphs.values():
            person_on(Level.of(graph).ground)  # once for all worlds, before anybody waits for it
        self._meshes = {name: to_json(mesh_message(graph.terrain)) for name, graph in graphs.items()}
        self._graphs = {name: to_json(graph_message(graph)) for name, graph in graphs.items()}

    def __iter__(self):
        return iter(self._levels)

    def mesh(self, name: str) -> bytes:
        """All triangles of a level."""
        self._check(name, navmesh.NodeGraph, "ask for its chunks with the request chunk")
        return self._meshes[name]

    def graph(self, name: str) -> bytes:
        """What is drawn of a level's graph."""
        self._check(name, navmesh.NodeGraph, "its graph is not drawn")
        return self._graphs[name]

    def chunk(self, name: str, chunk: str) -> bytes:
        """The triangles of a chunk of an open world."""
        world = self._check(name, navmesh.OpenWorld, "ask for its mesh with the request level")
        return to_json(mesh_message(world.chunk(chunk)))

    def start(
        self, name: str, around: Sequence[tuple[float, float, float]]
    ) -> navmesh.NodeGraph | navmesh.OpenWorld:
        """What a world is made of; of an open world what is ``around`` places is loaded. Can be interrupted
        between pieces."""
        if not around:
            why = 'say around which places it is loaded first, as in "around": [[x, y, z]]'
            return self._check(name, navmesh.NodeGraph, why)
        world = copy(self._check(name, navmesh.OpenWorld, "leave out around"))
        while world.keep_around(around, _AT_ONCE):
            pause()
        if world.graph is None:
            places = ", ".join(str(list(each)) for each in around)
            raise RuntimeInputError(f"level {name!r} has nothing to walk on around {places}")
        return world

    def _check(self, name: str, kind: type[_Level], instead: str) -> _Level:
        if name not in self._levels:
            raise RuntimeInputError(f"no level {name!r}; valid: {', '.join(self._levels)}")
        level = self._levels[name]
        if not isinstance(level, kind):
            what = "an open world" if isinstance(level, navmesh.OpenWorld) else "loaded as a whole"
            raise RuntimeInputError(f"level {name!r} is {what}; {instead}")
        return level


def mesh_message(terrain: navmesh.Terrain) -> dict[str, Any]:
    """A mesh as plain values."""
    return {"vertices": terrain.vertices.round(4).tolist(), "faces": terrain.faces.tolist()}


def graph_message(graph: navmesh.NodeGraph) -> dict[str, Any]:
    """What is drawn of a level's graph and obstacles, as in `runtime.traces.trace.LevelTrace`."""
    level = level_trace(graph)
    drawn = {name: getattr(level, name).round(4).tolist() for name in _DRAWN}
    return {**drawn, "affordances": list(level.affordances)}
