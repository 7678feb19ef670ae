"""A world that the server runs, and how it is told in messages."""

from itertools import count
from typing import Any

import numpy as np
from pydantic_core import to_json

import navmesh
from runtime.agent import Agent
from runtime.errors import RuntimeInputError
from runtime.planning import Plan
from runtime.recording import level_trace
from runtime.server.messages import States
from runtime.world import World, WorldState

__all__ = ["HostedWorld", "graph_message", "level_message", "skeleton", "way_message"]

_DRAWN = ("positions", "radii", "edges", "rim", "normal", "height")


class HostedWorld:
    """``name`` is its own in the server; ``level``: its level's; ``manual``: whether its clients step it.
    ``clients``: who joined it, and what each wants to be told."""

    def __init__(self, name: str, level: str, graph: navmesh.NodeGraph, seed: int, manual: bool) -> None:
        self.name, self.level, self.manual = name, level, manual
        self.world = World(graph, seed)
        self.clients: dict[Any, States] = {}
        self.saved: WorldState | None = None
        self._texts: dict[States, bytes] = {}
        self._ways: dict[str, tuple[Plan, int]] = {}
        self._numbers = count(1)

    def changed(self) -> None:
        """What was said of it does not hold any more."""
        self._texts.clear()

    def agent(self, name: str) -> Agent:
        """Raises `RuntimeInputError`."""
        if name not in self.world.agents:
            here = ", ".join(self.world.agents) or "none"
            raise RuntimeInputError(f"no agent {name!r} in world {self.name!r}; there are: {here}")
        return self.world.agents[name]

    def state(self, states: States) -> bytes:
        """The text of the present state; made once for all who want it."""
        if states not in self._texts:
            agents = [self._agent_state(agent, states) for agent in self.world.agents.values()]
            message = {"type": "state", "world": self.name, "time": self.world.time, "agents": agents}
            self._texts[states] = to_json(message)
        return self._texts[states]

    def _agent_state(self, agent: Agent, states: States) -> dict[str, Any]:
        told = {
            "name": agent.name,
            "status": agent.status,
            "position": agent.position.round(4).tolist(),
            "facing": round(agent.facing, 4),
            "way": self._number_of(agent),
        }
        if states in ("world", "local"):
            pose = agent.pose
            transforms = pose.local if states == "local" else pose.transforms
            told["transforms"] = transforms.round(5).ravel().tolist()
        return told

    def _number_of(self, agent: Agent) -> int | None:
        """The number of the path that an agent is on."""
        way = agent.way
        if way is None:
            return None
        known = self._ways.get(agent.name)
        if known is None or known[0] is not way:
            known = self._ways[agent.name] = way, next(self._numbers)
        return known[1]


def skeleton(agent: Agent) -> dict[str, Any]:
    """`messages.Skeleton` of an agent."""
    figure = agent.figure
    return {
        "name": agent.name,
        "body": agent.body,
        "bodies": list(figure.bodies),
        "parents": figure.parents.tolist(),
        "owner": figure.owner.tolist(),
        "place": figure.shapes.place.round(5).tolist(),
        "size": figure.shapes.size.round(5).tolist(),
        "round": np.asarray(figure.shapes.round).tolist(),
        "colour": figure.shapes.colour.round(4).tolist(),
    }


def level_message(graph: navmesh.NodeGraph) -> dict[str, Any]:
    """The level's mesh as plain values."""
    terrain = graph.terrain
    return {"vertices": terrain.vertices.round(4).tolist(), "faces": terrain.faces.tolist()}


def graph_message(graph: navmesh.NodeGraph) -> dict[str, Any]:
    """What of a level's graph and obstacles is drawn, as `runtime.trace.LevelTrace` has it."""
    level = level_trace(graph)
    drawn = {name: getattr(level, name).round(4).tolist() for name in _DRAWN}
    return {**drawn, "affordances": list(level.affordances)}


def way_message(agent: Agent) -> dict[str, Any]:
    """The lines of the path that an agent is on, as `runtime.trace.PathTrace` has them; empty without one."""
    way = agent.way
    if way is None:
        return {"raw": [], "pulled": [], "smooth": []}
    lines = {"raw": way.raw, "pulled": way.pulled, "smooth": way.points}
    return {name: line.round(4).tolist() for name, line in lines.items()}
