"""A world: a level, its graph, and the agents in it, advanced in steps of 10 ms."""

import hashlib
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

import navmesh
from locomotion import Ground
from locomotion.person import CONTROL_DT
from runtime.agent import Agent, AgentState
from runtime.drivers import BODIES, Pack, People, Population, radius_of
from runtime.errors import RuntimeInputError
from runtime.events import Event
from runtime.rules import person_walk_rules

__all__ = ["BODIES", "World", "WorldState"]


@dataclass(frozen=True)
class WorldState:
    """A moment of a world; `World.restore` goes back to it."""

    ticks: int
    owed: float
    events: tuple[Event, ...]
    random: Mapping[str, Any]
    agents: dict[str, AgentState]


class World:
    """A level with agents. No threads, no display, no state outside the object.

    ``terrain`` is the level; or a graph that was built or loaded, whose rules should suit a person. The same
    seed and the same calls give the same run, bit for bit.

    ``graph``: the `navmesh.NodeGraph`. ``agents``: by name, in order of their making. ``random``: the
    `numpy.random.Generator` for whatever chance the host needs, saved, restored and hashed with the rest.
    """

    def __init__(self, terrain: navmesh.Terrain | navmesh.NodeGraph, seed: int = 0) -> None:
        if isinstance(terrain, navmesh.NodeGraph):
            self.graph = terrain
        elif isinstance(terrain, navmesh.Terrain):
            self.graph = navmesh.NodeGraph.build(terrain, person_walk_rules())
        else:
            raise RuntimeInputError(
                f"a world is made of a Terrain or a NodeGraph, not of a {type(terrain).__name__}"
            )
        self.agents: dict[str, Agent] = {}
        self.random = np.random.default_rng(seed)
        level = self.graph.terrain
        ground = Ground.from_arrays(level.vertices, level.faces)
        self._populations: tuple[Population, ...] = (People(self.graph, ground), Pack(self.graph, ground))
        self._ticks = 0
        self._owed = 0.0
        self._events: list[Event] = []

    @property
    def time(self) -> float:
        """Simulated time [s]: whole ticks of 10 ms."""
        return self._ticks * CONTROL_DT

    @property
    def events(self) -> list[Event]:
        """What has happened since this was last read, in order; reading empties it."""
        events, self._events = self._events, []
        return events

    def spawn(self, body: str, at: ArrayLike, facing: float = 0.0, name: str | None = None) -> Agent:
        """Put a standing ``body`` on the walkable surface at ``at`` (3,) [m], facing ``facing`` [rad].

        ``body`` is "human", "dog", "cat" or "horse"; a quadruped stands with its rear feet there.
        The place is moved to the nearest one where the body fits (see `NodeGraph.find_path`). ``name`` is
        its own in this world; by default "human1" and so on. Raises `RuntimeInputError` for an unknown body,
        a taken name, a place off the walkable surface, or a
        quadruped without room for its head.
        """
        if body not in BODIES:
            raise RuntimeInputError(f"body {body!r}: valid: {', '.join(map(repr, BODIES))}")
        name = f"{body}{len(self.agents) + 1}" if name is None else name
        if name in self.agents:
            raise RuntimeInputError(f"name {name!r} is taken; names are unique in a world")
        place = np.asarray(at, dtype=np.float64)
        if place.shape != (3,) or not np.isfinite(place).all() or not math.isfinite(facing):
            raise RuntimeInputError(f"at and facing must be finite (3,) and (), not {at!r} and {facing!r}")
        here = self.graph.find_path(place, place, radius=radius_of(body))
        if here.status != "complete":
            raise RuntimeInputError(f"{place.tolist()} is not near a place where a {body} fits")
        population = next(each for each in self._populations if body in each.bodies)
        driver = population.spawn(body, here.waypoints[0], facing)
        agent = self.agents[name] = Agent(self, name, body, driver)
        return agent

    def step(self, dt: float) -> int:
        """Advance by ``dt`` [s] ≥ 0, in whole ticks of 10 ms; the rest is owed to later calls.

        Returns how many ticks were made. Raises `RuntimeInputError` for a ``dt`` below 0 or not finite.
        """
        if not (math.isfinite(dt) and dt >= 0.0):
            raise RuntimeInputError(f"dt must be a finite number of seconds, 0 or more, not {dt!r}")
        self._owed += dt
        due = math.floor(self._owed / CONTROL_DT + 1e-6)
        for _ in range(due):
            self._ticks += 1
            for population in self._populations:
                population.tick()
            for agent in self.agents.values():
                agent.notice()
        self._owed = max(self._owed - due * CONTROL_DT, 0.0)
        return due

    def report(self, event: Event) -> None:
        """Add an event to `events`."""
        self._events.append(event)

    def state_hash(self) -> str:
        """Hexadecimal digest of everything that decides how the world goes on; equal for equal runs."""
        checksum = hashlib.sha256(repr((self._ticks, self._owed)).encode())
        checksum.update(repr(self.random.bit_generator.state).encode())
        for name, agent in self.agents.items():
            checksum.update(f"{name}:{agent.state_hash()}".encode())
        return checksum.hexdigest()[:32]

    def save(self) -> WorldState:
        """This moment, for `restore`."""
        agents = {name: agent.save() for name, agent in self.agents.items()}
        return WorldState(
            self._ticks, self._owed, tuple(self._events), self.random.bit_generator.state, agents
        )

    def restore(self, state: WorldState) -> None:
        """Go back to a moment that `save` gave, in this world or one with the same level and agents.

        Raises `RuntimeInputError` when the agents are others.
        """
        if list(state.agents) != list(self.agents):
            raise RuntimeInputError(
                f"the state is of agents {list(state.agents)}, here are {list(self.agents)}"
            )
        self._ticks, self._owed, self._events = state.ticks, state.owed, list(state.events)
        self.random.bit_generator.state = state.random
        for name, saved in state.agents.items():
            self.agents[name].restore(saved)
