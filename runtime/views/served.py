"""A world of `surefoot serve` as a spectator sees it."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import Any

import numpy as np

import navmesh
from locomotion.recorded.skeletons import LEVELS
from locomotion.recorded_people.drawing import drawn
from runtime.bodies.figure import Figure, Shapes
from runtime.bodies.held_things import Looks, thing_of
from runtime.errors import RuntimeInputError
from runtime.server.messages import PROTOCOL
from runtime.traces.trace import LevelTrace, PathTrace
from runtime.views.window import Moment

__all__ = ["ServedWorld"]


_NO_GRAPH = {each.name: () for each in fields(LevelTrace)}


class ServedWorld:
    """The world called ``name`` on the server at ``address`` (ws://…), by default the only one. ``name``: as
    on the server. ``level``: what is drawn of its level; of an open world the chunks that are loaded.
    Raises `RuntimeInputError` if there is no server, it refuses the ``token``, or there is no such world.
    """

    def __init__(self, address: str, name: str | None = None, token: str = "") -> None:
        try:
            from websockets.exceptions import ConnectionClosed, WebSocketException
            from websockets.sync.client import connect
        except ImportError as error:
            raise RuntimeInputError(f"{error}; in Surefoot's folder: pip install -e '.[serve]'") from None

        self._closed, self._id = ConnectionClosed, 0
        self._figures: dict[str, Figure] = {}
        self._ways: dict[str, tuple[int, PathTrace]] = {}
        self._agents: dict[str, _Seen] = {}
        self._numbered: dict[int, _Seen] = {}
        self._looks = Looks()
        self._time: float | None = None
        self._gone = False
        self._chunks: dict[str, navmesh.Terrain] = {}
        self._due: list[tuple[list[str], list[str]]] = []  # chunks loaded and dropped, not shown yet
        try:
            self._socket = connect(address, compression=None, max_size=None)
        except (OSError, WebSocketException, ValueError) as error:
            raise RuntimeInputError(f"{address}: cannot be reached: {error}") from None
        try:
            worlds = self._ask("hello", version=PROTOCOL, token=token)["worlds"]
            self.name = _chosen(address, worlds, name)
            joined = self._ask("join", world=self.name, states="changes")
            self._figures.update({each["name"]: _figure(each) for each in joined["agents"]})
            self._level_name = joined["level"]
            if joined["loaded"]:
                self._change_chunks(joined["loaded"], [])
            else:
                mesh, graph = (self._ask(kind, level=joined["level"]) for kind in ("level", "graph"))
                self.level = _level(mesh, graph)
        except BaseException:
            self.close()
            raise

    def moment(self) -> Moment | None:
        """The newest state, once there is one; None if the world or its server is gone."""
        try:
            while self._time is None and not self._gone:
                self._heed(self._hear())
            if self._gone or self._time is None:
                return None
            while self._due:
                self._change_chunks(*self._due.pop(0))
            now, self._time = self._time, None
            return self._seen(now)
        except self._closed:
            return None

    def close(self) -> None:
        """Leave."""
        self._socket.close()

    def __enter__(self) -> "ServedWorld":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _seen(self, now: float) -> Moment:
        agents = {name: agent for name, agent in self._agents.items() if name in self._figures}
        ways = {}
        for name, agent in agents.items():
            number = agent.way
            if number is not None:
                known = self._ways.get(name)
                ways[name] = known if known and known[0] == number else (number, self._way(name))
        self._ways = ways
        figures, poses = {}, [np.empty((0, 7))]
        for name, agent in agents.items():
            figures[name], pose = self._looks.look(name, self._figures[name], agent.transforms(), agent.thing)
            poses.append(pose)
        return Moment(
            now,
            self.level,
            figures,
            np.concatenate(poses),
            tuple(way for _, way in ways.values()),
        )

    def _way(self, agent: str) -> PathTrace:
        try:
            told = self._ask("way", world=self.name, agent=agent)
        except RuntimeInputError:  # it has gone meanwhile
            told = {}
        return PathTrace(*(np.reshape(told.get(line, ()), (-1, 3)) for line in ("raw", "pulled", "smooth")))

    def _change_chunks(self, loaded: Sequence[str], dropped: Sequence[str]) -> None:
        """Show the chunks of an open world that are loaded now, without a graph."""
        for name in dropped:
            self._chunks.pop(name, None)
        for name in loaded:
            mesh = self._ask("chunk", level=self._level_name, chunk=name)
            self._chunks[name] = navmesh.Terrain.from_arrays(mesh["vertices"], mesh["faces"])
        loaded_now = navmesh.join_chunks(self._chunks)
        self.level = _level({"vertices": loaded_now.vertices, "faces": loaded_now.faces}, _NO_GRAPH)

    # --- messages
    def _ask(self, kind: str, **fields: Any) -> dict[str, Any]:
        """The result of a request. Raises `RuntimeInputError` with the server's reason."""
        self._id += 1
        self._socket.send(json.dumps({"type": kind, "id": self._id, **fields}))
        while True:
            message = self._hear()
            if message["type"] not in ("reply", "error"):
                self._heed(message)
            elif message["type"] == "error":
                raise RuntimeInputError(f"the server refuses: {message['message']}")
            elif message["id"] == self._id:
                return message["result"]

    def _hear(self) -> dict[str, Any]:
        return json.loads(self._socket.recv())

    def _heed(self, message: Mapping[str, Any]) -> None:
        if message["type"] == "changes":
            self._time = message["time"]
            for change in message["agents"]:
                seen = self._agents.setdefault(change["name"], _Seen())
                seen.change(change)
                if "number" in change:
                    self._numbered[change["number"]] = seen
            for number, indices, values in message["moved"]:
                self._numbered[number].move(indices, values)
        elif message["type"] == "agent":
            self._figures[message["agent"]["name"]] = _figure(message["agent"])
        elif message["type"] == "chunks":
            self._due.append((message["loaded"], message["dropped"]))
        elif message["type"] == "gone":
            self._gone |= message["agent"] is None
            self._figures.pop(message["agent"], None)
            self._agents.pop(message["agent"], None)


class _Seen:
    """An agent as it was told last."""

    def __init__(self) -> None:
        self.way: int | None = None
        self.thing = ""
        self._channels = np.empty(0)
        self._steps = 1.0, 1.0
        self._told = np.empty((0, 7))

    def change(self, change: Mapping[str, Any]) -> None:
        """Take in a `runtime.server.messages.AgentChange`."""
        self.way = change.get("way", self.way)
        self.thing = thing_of(change["holds"]) if "holds" in change else self.thing
        if "transforms" in change:
            self._told = np.reshape(change["transforms"], (-1, 7))
        self._steps = change.get("steps", self._steps)

    def move(self, indices: Sequence[int], values: Sequence[int]) -> None:
        """Take in an entry of `runtime.server.messages.Changes.moved`."""
        if len(self._channels) == 0:
            self._channels = np.zeros(len(indices))
        self._channels[indices] = values

    def transforms(self) -> np.ndarray:
        """(n, 7) of its bodies in the world."""
        if len(self._channels) == 0:
            return self._told
        (place, turn), told = self._steps, self._channels
        root = np.concatenate([place * (told[0:3] + told[4:7]), 0.5 * turn * told[7:11]])
        root[3:] /= np.linalg.norm(root[3:])
        return drawn(LEVELS[0], turn * told[None, 11:], root[None])[0]


def _chosen(address: str, worlds: list[str], name: str | None) -> str:
    if name is None and len(worlds) == 1:
        return worlds[0]
    if not worlds:
        raise RuntimeInputError(f"{address}: there is no world yet; let a client create one")
    if name not in worlds:
        missing = "choose one" if name is None else f"no world {name!r}"
        raise RuntimeInputError(f"{address}: {missing}; there are: {', '.join(worlds)} (--world)")
    return name


def _level(mesh: Mapping[str, Any], graph: Mapping[str, Any]) -> LevelTrace:
    shapes = {"positions": (-1, 3), "radii": -1, "rim": (-1, 2, 3), "normal": (-1, 3), "height": -1}
    return LevelTrace(
        vertices=np.reshape(mesh["vertices"], (-1, 3)),
        faces=np.reshape(mesh["faces"], (-1, 3)).astype(np.int32),
        edges=np.reshape(graph["edges"], (-1, 2)).astype(np.int32),
        affordances=tuple(graph["affordances"]),
        **{name: np.reshape(np.array(graph[name], dtype=np.float64), s) for name, s in shapes.items()},
    )


def _figure(told: Mapping[str, Any]) -> Figure:
    shapes = Shapes(
        place=np.reshape(told["place"], (-1, 7)),
        size=np.reshape(told["size"], (-1, 3)),
        round=np.array(told["round"], dtype=bool),
        colour=np.reshape(told["colour"], (-1, 3)),
    )
    return Figure(tuple(told["bodies"]), np.array(told["parents"]), np.array(told["owner"]), shapes)
