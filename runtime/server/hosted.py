"""A world on the server, and its description in messages.

Long work (`HostedWorld.step` and most others) can be interrupted, see `surefoot.pausing`; nobody else may use
the world in the meantime. Callers hold `HostedWorld.lock`.
"""

import asyncio
import time
import weakref
from collections.abc import Mapping, Sequence
from itertools import chain, count
from typing import Any

import numpy as np
from pydantic_core import to_json

import navmesh
from runtime.dis.gateway import Gateway
from runtime.errors import RuntimeInputError
from runtime.planning.planning import Plan
from runtime.server.changes import NOTHING, Changes, Shown
from runtime.server.client import Client
from runtime.server.messages import States
from runtime.world.agent import Agent
from runtime.world.level_of_detail import PHYSICS
from runtime.world.world import World, WorldState
from surefoot.pausing import pause

__all__ = ["HostedWorld", "skeleton", "way_message"]


class HostedWorld:
    """``name``: unique on the server; ``level``: its level's name; ``manual``: whether clients step it.
    ``clients``: members in order of joining, each with the states that it wants. ``spawned``: client of
    each agent. ``loaded``: the chunks of an open world that members have been told of. ``since``: when [s]
    it was last advanced or, without clients, left. ``at_work``: whether an advance is due. ``closed``:
    whether it has ended. ``gateway``: to other simulators, if it talks to them.
    """

    def __init__(
        self,
        name: str,
        level: str,
        start: navmesh.NodeGraph | navmesh.OpenWorld,
        seed: int,
        manual: bool,
    ) -> None:
        self.name, self.level, self.manual = name, level, manual
        self.world = World(start, seed)
        self.loaded = self.world.loaded
        self.clients: dict[Client, States] = {}
        self.spawned: dict[str, Client | None] = {}
        self.saved: WorldState | None = None
        self.since = time.monotonic()
        self.gateway: Gateway | None = None
        self._strangers: set[str] = set()
        self.lock = asyncio.Lock()
        self.at_work = self.closed = False
        self._texts: dict[States, bytes] = {}
        self._ways: dict[str, tuple[Plan, int]] = {}
        self._numbers = count(1)
        self._changes = Changes(self._agent_fields)
        self._players: dict[Client, tuple[str | tuple[float, float, float], ...]] = {}
        self._players_left = False
        self._told: weakref.WeakKeyDictionary[Client, Mapping[str, Shown]] = weakref.WeakKeyDictionary()

    @property
    def owner(self) -> Client | None:
        """The client whose quota it counts towards: the longest-standing member."""
        return next(iter(self.clients), None)

    def agent(self, name: str) -> Agent:
        """Raises `RuntimeInputError`."""
        if name not in self.world.agents:
            here = ", ".join(self.world.agents) or "none"
            raise RuntimeInputError(f"no agent {name!r} in world {self.name!r}; there are: {here}")
        return self.world.agents[name]

    # --- what takes long
    def join(self, states: States) -> dict[str, Any]:
        """The reply to a client that joins, and the state in the form that it wants."""
        self._describe(states)
        agents = []
        for agent in self.world.agents.values():
            agents.append(skeleton(agent))
            pause()
        return {"world": self.name, "level": self.level, "time": self.world.time, "agents": agents}

    def step(self, dt: float) -> int:
        """Ticks."""
        if self._players_left:
            self._let_play(self._players)
        ticks = self.world.step(dt)
        if self.gateway is not None:
            self.gateway.exchange()
        self.changed()
        return ticks

    def spawn(
        self,
        body: str,
        at: tuple[float, float, float],
        facing: float,
        name: str | None,
        detail: str = PHYSICS,
    ) -> Agent:
        agent = self.world.spawn(body, at, facing, name, detail=detail)
        self.changed()
        return agent

    def go_to(
        self, agent: str, points: Sequence[tuple[float, float, float]], speed: float, facing: float | None
    ) -> str:
        """Status."""
        sent = self.agent(agent)
        status = sent.go_to(points, speed, facing)
        former = sent.driver.plans
        while len(former) > 1:  # many orders of one client must not fill the memory
            former.popleft()
        return status

    def stop(self, agent: str) -> str:
        """Status."""
        self.agent(agent).stop()
        return self.agent(agent).status

    def play(self, client: Client, players: Sequence[str | tuple[float, float, float]]) -> None:
        """Keep an open world loaded around ``players``, agents by name and places [m], for ``client``; those
        of others are kept, too."""
        for each in players:
            if isinstance(each, str):
                self.agent(each)
        by_client = {**self._players, client: tuple(players)}
        self._let_play(by_client)
        self._players = by_client

    def _let_play(self, by_client: Mapping[Client, Sequence[str | tuple[float, float, float]]]) -> None:
        agents, everybody = self.world.agents, chain.from_iterable(by_client.values())
        self.world.players = [
            agents[each] if isinstance(each, str) else each
            for each in everybody
            if not isinstance(each, str) or each in agents
        ]
        self._players_left = False

    def chunks_changed(self) -> tuple[list[str], list[str]]:
        """The chunks of an open world that were loaded and dropped since the last call."""
        before, self.loaded = set(self.loaded), self.world.loaded
        now = set(self.loaded)
        return sorted(now - before), sorted(before - now)

    def remove(self, agent: str) -> None:
        self.agent(agent).remove()
        self._players = {
            client: tuple(each for each in players if each != agent)
            for client, players in self._players.items()
        }
        self.changed()

    def save(self) -> dict[str, Any]:
        """Time and hash."""
        self.saved = self.world.save()
        return {"time": self.world.time, "hash": self.world.state_hash()}

    def restore(self) -> dict[str, Any]:
        """Time and hash."""
        if self.saved is None:
            raise RuntimeInputError(f"world {self.name!r} has not been saved")
        self.world.restore(self.saved)
        self._changes.refresh(self.name, self.world, anew=True)
        self.changed()
        return {"time": self.world.time, "hash": self.world.state_hash()}

    def changed(self) -> None:
        """Send the present state to the clients that want it."""
        self._texts.clear()
        self._ways = {name: way for name, way in self._ways.items() if name in self.world.agents}
        self.spawned = {
            name: self.spawned.get(name, self.owner)
            for name, agent in self.world.agents.items()
            if not agent.driver.comes_from_elsewhere
        }
        wanted: set[States] = set(self.clients.values())
        for states in wanted:
            self._describe(states)

    def strangers(self) -> tuple[list[Agent], set[str]]:
        """Agents of other simulators that have come since the last call, and names of those that are gone."""
        here = {name: agent for name, agent in self.world.agents.items() if agent.driver.comes_from_elsewhere}
        come = [agent for name, agent in here.items() if name not in self._strangers]
        gone, self._strangers = self._strangers - here.keys(), set(here)
        return come, gone

    def _describe(self, states: States) -> None:
        if states == "none" or states in self._texts:
            return
        if states == "changes":
            self._changes.refresh(self.name, self.world)
            return
        agents = []
        for agent in self.world.agents.values():
            agents.append(to_json(self._agent_state(agent, states)))
            pause()
        head = to_json({"type": "state", "world": self.name, "time": self.world.time})[:-1]
        self._texts[states] = b'%b,"agents":[%b]}' % (head, b",".join(agents))

    # ---
    def state(self, states: States) -> bytes | None:
        """The text of the present state, None if nobody asked for its form."""
        return self._texts.get(states)

    def state_for(self, client: Client) -> bytes | None:
        """The same in the form that ``client`` wants; it must be sent to it, since what comes next may tell
        what has changed from it."""
        states = self.clients.get(client, "none")
        if states != "changes":
            return self.state(states)
        text = self._changes.text(self._told.get(client, NOTHING))
        if text is not None:
            self._told[client] = self._changes.newest
        return text

    def begin(self, client: Client, states: States) -> None:
        """Let ``client`` be a member that wants ``states``; what it was told before is told again."""
        self.clients[client] = states
        self._told.pop(client, None)

    def end(self, client: Client) -> bool:
        """Let ``client`` be no member any more; returns whether it was."""
        self._told.pop(client, None)
        self._players_left |= bool(self._players.pop(client, ()))
        return self.clients.pop(client, None) is not None

    def _agent_state(self, agent: Agent, states: States) -> dict[str, Any]:
        told = self._agent_fields(agent)
        if states in ("world", "local"):
            pose = agent.pose
            transforms = pose.local if states == "local" else pose.transforms
            told["transforms"] = transforms.round(5).ravel().tolist()
        return told

    def _agent_fields(self, agent: Agent) -> dict[str, Any]:
        held, state = agent.held
        return {
            "name": agent.name,
            "status": agent.status,
            "level": agent.level,
            "posture": agent.posture,
            "holds": f"{held} {state}" if held else "",
            "position": agent.position.round(4).tolist(),
            "facing": round(agent.facing, 4),
            "way": self._number_of(agent),
        }

    def _number_of(self, agent: Agent) -> int | None:
        """Number of an agent's present path."""
        way = agent.way
        if way is None:
            return None
        known = self._ways.get(agent.name)
        if known is None or known[0] is not way:
            known = self._ways[agent.name] = way, next(self._numbers)
        return known[1]


def skeleton(agent: Agent) -> dict[str, Any]:
    """`messages.Skeleton` of an agent."""
    figure, joints = agent.figure, agent.driver.joints
    turns = zip(joints.names, joints.body.tolist(), joints.axes.tolist(), strict=True)
    return {
        "name": agent.name,
        "body": agent.body,
        "bodies": list(figure.bodies),
        "parents": figure.parents.tolist(),
        "offsets": joints.offsets.round(5).tolist(),
        "joints": [{"name": name, "body": body, "axis": axis} for name, body, axis in turns],
        "owner": figure.owner.tolist(),
        "place": figure.shapes.place.round(5).tolist(),
        "size": figure.shapes.size.round(5).tolist(),
        "round": np.asarray(figure.shapes.round).tolist(),
        "colour": figure.shapes.colour.round(4).tolist(),
    }


def way_message(agent: Agent) -> dict[str, Any]:
    """Lines of an agent's present path as in `runtime.traces.trace.PathTrace`; empty without one."""
    way = agent.way
    if way is None:
        return {"raw": [], "pulled": [], "smooth": []}
    lines = {"raw": way.raw, "pulled": way.pulled, "smooth": way.points}
    return {name: line.round(4).tolist() for name, line in lines.items()}
