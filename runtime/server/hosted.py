"""A world that the server runs, and how it is told in messages."""

import json
from typing import Any

import numpy as np

import navmesh
from runtime.agent import Agent
from runtime.errors import RuntimeInputError
from runtime.server.messages import States
from runtime.world import World, WorldState

__all__ = ["HostedWorld", "level_message", "skeleton"]


class HostedWorld:
    """``name`` is its own in the server; ``manual``: whether its clients step it."""

    def __init__(self, name: str, graph: navmesh.NodeGraph, seed: int, manual: bool) -> None:
        self.name, self.manual = name, manual
        self.world = World(graph, seed)
        self.saved: WorldState | None = None
        self._texts: dict[States, str] = {}

    def changed(self) -> None:
        """What was said of it does not hold any more."""
        self._texts.clear()

    def agent(self, name: str) -> Agent:
        """Raises `RuntimeInputError`."""
        if name not in self.world.agents:
            here = ", ".join(self.world.agents) or "none"
            raise RuntimeInputError(f"no agent {name!r} in world {self.name!r}; there are: {here}")
        return self.world.agents[name]

    def state(self, states: States) -> str:
        """The text of the present state; made once for all who want it."""
        if states not in self._texts:
            agents = [_agent_state(agent, states) for agent in self.world.agents.values()]
            message = {"type": "state", "world": self.name, "time": self.world.time, "agents": agents}
            self._texts[states] = json.dumps(message, separators=(",", ":"))
        return self._texts[states]


def _agent_state(agent: Agent, states: States) -> dict[str, Any]:
    told = {
        "name": agent.name,
        "status": agent.status,
        "position": agent.position.round(4).tolist(),
        "facing": round(agent.facing, 4),
    }
    if states in ("world", "local"):
        pose = agent.pose
        transforms = pose.local if states == "local" else pose.transforms
        told["transforms"] = transforms.round(5).ravel().tolist()
    return told


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
