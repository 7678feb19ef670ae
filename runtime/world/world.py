"""A world: a level, its graph, and the agents in it, advanced in steps of 10 ms."""

import hashlib
import math
import os
from collections.abc import Callable, Mapping, Sequence
from copy import copy
from itertools import compress, count
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike

import navmesh
from locomotion import LocomotionError, load_run_skill
from locomotion import body_events as bodily
from locomotion.body.person import CONTROL_DT
from locomotion.rehearsal.choices import REHEARSALS
from locomotion.rehearsal.sharing import REHEARSAL_TICKS
from locomotion.skills.library import described_ranges, different, learned_digest, learned_skills
from runtime.bodies.cast import Cast
from runtime.bodies.kinds.kind import WALKS, BodyKind, Surroundings
from runtime.bodies.populations import Populations
from runtime.bodies.protocol import Driver, Population
from runtime.bodies.registry import body_kinds, kind_of
from runtime.errors import RuntimeInputError
from runtime.events import Event
from runtime.planning.level import Level
from runtime.planning.rules import obstacle_rules, person_walk_rules
from runtime.traffic.traffic import EVERY, Traffic
from runtime.world.agent import Agent
from runtime.world.agent_services import Clock, Host
from runtime.world.agent_state import AgentState
from runtime.world.arguments import checked_files, checked_number, checked_points, checked_whole
from runtime.world.event_log import EventLog
from runtime.world.level_changes import LevelChanges
from runtime.world.level_of_detail import AUTO, LEVELS, PHYSICS, Budget, Viewer, checked_detail, levels_for
from runtime.world.level_of_detail import EVERY as LOOKS
from runtime.world.sizes import Sizes
from runtime.world.state import WorldState
from runtime.world.streaming import EVERY as CHANGES_CHUNKS
from runtime.world.streaming import Streaming, checked_players
from surefoot.pausing import pause
from surefoot.preparing import prepare_once
from surefoot.words import several

__all__ = ["World", "WorldState"]

_CHANGES = 1  # of people to physics or from it at once at most: each takes as long as several ticks
_LOOKS = 50  # ticks between two looks at whether an agent makes headway
_AS_SAVED = {
    "skills of the package": "with the release that saved it",
    "skills of their own": "in a world of the same skills=...",
    "preconditions": "with the preconditions that it was saved with (those of its release, or learned since)",
}
"""What a world is restored with, by what people have learned in another way (`LEARNED` of the library)."""
_E = TypeVar("_E", bound=Event)


class _Drawn(NamedTuple):
    """The agents of a population that are drawn together: their ``numbers`` (n,) in the order of all agents,
    ``names``, and `Agent.changed` of each (n,)."""

    cast: Cast
    numbers: np.ndarray
    names: list[str]
    changed: np.ndarray


def _drawn(home: Population, members: Sequence[tuple[int, Agent]]) -> _Drawn:
    return _Drawn(
        home.cast([agent.driver for _, agent in members]),
        np.array([number for number, _ in members], np.int64),
        [agent.name for _, agent in members],
        np.array([agent.changed for _, agent in members]),
    )


class World:
    """A level with agents. No display, no state outside the object.

    Making one takes load time: it compiles what is not compiled yet, and builds a graph of a terrain. Its
    methods say what time they take: constant, sliced over the ticks, or load time.

    ``terrain`` is the level; or a graph that was built or loaded, whose rules should suit a person; or an
    open world of which something is loaded (`navmesh.OpenWorld.keep_around`): the world has its own copy,
    loads and drops chunks around its `players`, and lets agents go to places that are not loaded yet. The
    same seed and the same calls give the same run, bit for bit.

    ``skills``: files that describe skills of your own (`locomotion.skills.description`), which its people
    have besides the package's; a graph that it builds counts what they clear among the obstacles. Raises
    `RuntimeInputError` for one with a mistake. ``rehearsals``: how many variations of a take-off or a
    slowing-down a person tries at most. ``rehearsal_ticks``: how many ticks of their trials all people
    simulate in each tick of the world at most. Who has to decide before it could rehearse takes what has held
    so far; who stands before an obstacle tries again at its next step. None: as many as they need at that
    moment, so that skills hold most often, but a tick takes up to a second. 0 of either: nobody rehearses.

    ``walk``: "learned": where the ground is level, people walk as a network has learned it from people
    (`locomotion.human.learned_walk`); or "planned": without it. A state is restored in a world with the same
    ``walk``.

    ``sizes``: least and greatest size of the people that `spawn` makes, by the seed and the place, in steps
    of 1 %; 1 is 1.76 m, (0.88, 1.08) is 1.55 to 1.90 m (`Agent.set_style`). Each size takes load time once.

    ``threads``: how many advance people side by side; the run is the same with any number, but not with other
    ``rehearsals`` or ``rehearsal_ticks``.

    ``agents``: by name, in order of their making. ``random``: the
    `numpy.random.Generator` for whatever chance the host needs, saved, restored and hashed with the rest.
    """

    def __init__(
        self,
        terrain: navmesh.Terrain | navmesh.NodeGraph | navmesh.OpenWorld,
        seed: int = 0,
        skills: Sequence[str | os.PathLike[str]] = (),
        rehearsals: int = REHEARSALS,
        walk: str = "learned",
        rehearsal_ticks: int | None = REHEARSAL_TICKS,
        threads: int = 1,
        sizes: tuple[float, float] = (1.0, 1.0),
    ) -> None:
        checked_whole(rehearsals, "rehearsals")
        if rehearsal_ticks is not None:
            checked_whole(rehearsal_ticks, "rehearsal_ticks")
        if walk not in WALKS:
            raise RuntimeInputError(f"walk must be one of {', '.join(map(repr, WALKS))}, not {walk!r}")
        self._sizes = Sizes.checked(sizes, checked_whole(seed, "seed"))
        prepare_once()
        self._skills = checked_files(skills, "skills")
        own: Mapping[str, tuple[float, float]] = {}
        if self._skills:
            try:
                own = described_ranges(load_run_skill(), self._skills)
                learned_skills(load_run_skill(), self._skills)
            except LocomotionError as error:
                raise RuntimeInputError(str(error)) from None
        self._streaming: Streaming | None = None
        if isinstance(terrain, navmesh.OpenWorld):
            self._streaming = Streaming(terrain, self._foreseen)
            graph = self._streaming.level().graph
        elif isinstance(terrain, navmesh.NodeGraph):
            graph = copy(terrain) if terrain.zones else terrain  # its doors are its own
        elif isinstance(terrain, navmesh.Terrain):
            graph = navmesh.NodeGraph.build(terrain, person_walk_rules(), obstacle_rules(own))
        else:
            raise RuntimeInputError(
                "a world is made of a Terrain, a NodeGraph or an OpenWorld, "
                f"not of a {type(terrain).__name__}"
            )
        self.agents: dict[str, Agent] = {}
        self.random = np.random.default_rng(seed)
        self._level = Level.of(graph)
        self._changes = LevelChanges(self._changed)
        self._populations = Populations()
        self._traffic = Traffic(self._level, self._populations)
        around = Surroundings(
            self._level,
            self._traffic,
            self._populations,
            self._skills,
            rehearsals,
            rehearsal_ticks,
            checked_whole(threads, "threads", least=1),
            int(seed),
            walk,
        )
        self._homes: dict[BodyKind, Population] = {}
        for kind in sorted(body_kinds(), key=lambda kind: kind.avoids_all):
            self._homes[kind] = kind.populate(around)
            self._populations.extend(self._homes[kind].parts())
        self._clock, self._log = Clock(), EventLog()
        self._host = Host(
            self._clock,
            self._log,
            self._traffic,
            self.remove,
            self._at_level,
            lambda body: kind_of(body).levels,
            lambda: None if self._streaming is None else self._streaming.world,
        )
        self._viewers: tuple[Viewer, ...] = ()
        self._budget = Budget()
        self._stepping = False
        self._casts: list[_Drawn] | None = None
        """For `transforms`; None when somebody has come, gone, or changed."""
        self._roster: tuple[list[Agent], list[list[bodily.Event]]] | None = None
        """All agents and their news, in order; None as of `_casts`."""
        self._asked: float | None = None
        """[s] when `transforms` was asked for the first time after the last `restore`; None: not yet."""

    def __repr__(self) -> str:
        level, agents = Path(self.graph.terrain.name).name, several(len(self.agents), "agent")
        return f"<World on {level}: {agents}, {self.time:.2f} s>"

    @property
    def graph(self) -> navmesh.NodeGraph:
        """The graph of the level as it is now."""
        return self._level.graph

    @property
    def level_digest(self) -> str:
        """Hexadecimal digest of the level and the rules of its graph; of an open world that of all of it."""
        if self._streaming is not None:
            return self._streaming.world.digest
        rules = repr(sorted(self.graph.rules.to_dict().items()))
        return hashlib.sha256(f"{self.graph.terrain.digest}{rules}".encode()).hexdigest()[:32]

    @property
    def time(self) -> float:
        """Simulated time [s]: whole ticks of 10 ms."""
        return self._clock.time

    @property
    def blend(self) -> float:
        """How far between the last tick but one (0) and the last (towards 1) to draw: the share of a tick
        that is owed."""
        return self._clock.blend

    @property
    def events(self) -> list[Event]:
        """What has happened since this was last read, in order; reading empties it. Of more than 100,000 the
        last ones."""
        return self._log.read()

    def listen(self, callback: Callable[[_E], object], kind: type[_E] = Event) -> Callable[[], None]:
        """Have ``callback(event)`` called for each event of type ``kind``; returns a function that ends it.

        Callbacks are called by `step`, at the end of the tick, in order of the events and then of `listen`,
        also for what happened between steps. What they cause themselves is told at the end of the next tick.
        They may do with the world what they like, except step or restore it. An error in one comes out of
        `step`, which can be called again.
        """
        return self._log.listen(callback, kind)

    @property
    def viewers(self) -> tuple[Viewer, ...]:
        """Who looks on, from where: people whose detail is "auto" go by it. Part of the input of a run, saved
        with it. Can be set to a list of `runtime.Viewer`; raises `RuntimeInputError` for anything else."""
        return self._viewers

    @viewers.setter
    def viewers(self, viewers: Sequence[Viewer]) -> None:
        if not isinstance(viewers, Sequence) or not all(isinstance(each, Viewer) for each in viewers):
            raise RuntimeInputError(f"viewers must be a list of runtime.Viewer, not {viewers!r}")
        self._viewers = tuple(viewers)

    @property
    def budget(self) -> Budget:
        """How many people there are at each level of detail at most. Can be set to a `runtime.Budget`; raises
        `RuntimeInputError` for anything else."""
        return self._budget

    @budget.setter
    def budget(self, budget: Budget) -> None:
        if not isinstance(budget, Budget):
            raise RuntimeInputError(f"budget must be a runtime.Budget, not {budget!r}")
        self._budget = budget

    @property
    def players(self) -> tuple[Agent | tuple[float, float, float], ...]:
        """Around whom chunks of an open world are kept loaded: agents, wherever they go, and places (3,) [m].

        Every half second of simulated time up to two chunks are loaded or dropped as `navmesh.OpenWorld` has
        it, and the ground and the graph change together. None is dropped that is at most 20 m away from an
        agent, whether it is a player or not, so nobody loses the ground under its feet. With no players
        nothing changes. Part of the input of a run, saved with it. Can be set to a list; raises
        `RuntimeInputError` for anything else, and where the world is not open.
        """
        if self._streaming is None:
            return ()
        return tuple(self.agents[each] if isinstance(each, str) else each for each in self._streaming.players)

    @players.setter
    def players(self, players: Sequence[Agent | ArrayLike]) -> None:
        self._open_world().players = checked_players(players, self.agents)

    @property
    def loaded(self) -> tuple[str, ...]:
        """Names of the chunks of an open world that are loaded, in alphabetical order."""
        return () if self._streaming is None else self._streaming.world.loaded

    @property
    def open_world(self) -> navmesh.OpenWorld | None:
        """A copy of the open world that the level is, with the same chunks loaded; None where the level is
        loaded as a whole. Takes constant time."""
        return None if self._streaming is None else copy(self._streaming.world)

    def keep_around(self, places: ArrayLike, changes: int = 1) -> dict[str, navmesh.Terrain | None]:
        """Load and drop up to so many ``changes`` of an open world's chunks at once, as ``places`` (3,) or
        (k, 3) [m] want it, such as while a level is loaded or before an agent appears elsewhere; `players` do
        that by themselves. Takes load time.

        Returns what has changed, as `navmesh.OpenWorld.keep_around`: empty when nothing is left to do. What
        agents stand on is not dropped, nor the last that one can walk on. Raises `RuntimeInputError` where
        the world is not open, and what `navmesh.OpenWorld.keep_around` raises.
        """
        level, found = self._open_world().keep_around(places, changes, self.agents)
        if level is not None:
            self._go_on_on(level)
        return found

    def _open_world(self) -> Streaming:
        if self._streaming is None:
            raise RuntimeInputError(
                "the level is loaded as a whole; make the world of a navmesh.OpenWorld to have chunks of it "
                "loaded and dropped"
            )
        return self._streaming

    def spawn(
        self,
        body: str,
        at: ArrayLike,
        facing: float = 0.0,
        name: str | None = None,
        radius: float | None = None,
        detail: str = PHYSICS,
        bravery: float | None = None,
    ) -> Agent:
        """Put a standing ``body`` on the walkable surface at ``at`` (3,) [m], facing ``facing`` [rad].

        ``body`` is "human", "dog", "cat" or "horse", or "walker": a cheap body that slides over the surface
        and avoids others, by the thousand; or the path of a YAML file with a quadruped of your own (see
        `locomotion.quadruped.load_body`); or what was added by `runtime.bodies.registry.register`. A
        quadruped stands with its rear feet there. ``radius`` [m] is for walkers only, by default a person's.
        The place is moved to the nearest one where the body fits (see `NodeGraph.find_path`). ``name`` is
        its own in this world; by default "human1" and so on. The first of a kind takes load time, the others
        constant time. ``detail`` is for humans, as of `Agent.detail`:
        "physics", or for those who play recorded motion "full", "medium" or "low", or "auto", the first of
        which in a process takes seconds. ``bravery`` is for humans, as of `Agent.bravery`. Raises
        `RuntimeInputError` for an unknown body, a body file with a mistake, a taken name, a place off the
        walkable surface, a quadruped without room for its head, or a detail or bravery that the body cannot
        have.
        """
        if not isinstance(body, str) or not isinstance(name, str | None) or name == "":
            raise RuntimeInputError(
                f"body and name must be text that is not empty, not {body!r} and {name!r}"
            )
        kind = kind_of(body)
        if not kind.spawned:
            raise RuntimeInputError(f"a {body} body is not spawned; it comes in from another simulator")
        kind.check(body)
        if name is None:
            numbered = (f"{Path(body).stem}{number}" for number in count(len(self.agents) + 1))
            name = next(each for each in numbered if each not in self.agents)
        if name in self.agents:
            raise RuntimeInputError(f"name {name!r} is taken; names are unique in a world")
        place = checked_points(at, "at")
        if len(place) != 1 or np.ndim(at) != 1:
            raise RuntimeInputError(f"at must be one point (3,) [m], not {at!r}")
        place, facing = place[0], checked_number(facing, "facing", "rad")
        if radius is not None and not kind.sized:
            sized = " or a ".join(name for each in body_kinds() if each.sized for name in each.names)
            raise RuntimeInputError(f"a {body} has a radius of its own; only a {sized} can be given one")
        if radius is not None and checked_number(radius, "radius", "m") <= 0.0:
            raise RuntimeInputError(f"radius must be above 0 m, not {radius!r}")
        size = kind.radius(body) if radius is None else float(radius)
        self._check_open_to(body, place, size)
        here = self.graph.find_path(place, place, radius=size)
        if here.status != "complete":
            raise RuntimeInputError(f"{place.tolist()} is not near a place where a {body} fits")
        detail = checked_detail(detail, kind.levels, body)
        level = LEVELS[-1] if detail == AUTO else detail
        driver = kind.spawn(self._population(body), body, here.waypoints[0], facing, size, level)
        agent = Agent(self._host, name, body, driver)
        if bravery is not None:
            try:
                agent.bravery = bravery
            except RuntimeInputError:
                self._population(body).remove(driver)
                raise
        if agent.has_levels and self._sizes.vary:
            agent.set_style(size=self._sizes.at(here.waypoints[0]))
        self.agents[name] = agent
        self._forget_order()
        if detail == AUTO:
            self._population(body).prepare_levels()
            agent.detail = detail
        return agent

    def _check_open_to(self, body: str, place: np.ndarray, size: float) -> None:
        """Raises `RuntimeInputError` where an open world has nothing loaded for a body of a ``size`` [m]."""
        if self._streaming is None:
            return
        world = self._streaming.world
        if size > world.radii[-1]:
            raise RuntimeInputError(
                f"a {body} has a radius of {size:g} m, the open world was baked for bodies of up to "
                f"{world.radii[-1]:g} m; bake it with radii=(..., {size:g})"
            )
        if not world.is_loaded(place)[0]:
            raise RuntimeInputError(
                f"{place.tolist()} is not loaded; call keep_around(places) of the world first, or let a "
                "player be there"
            )

    def admit(self, body: str, name: str, state: Any) -> Agent:
        """Add an agent that comes in from elsewhere, in the ``state`` that its population revives it from
        (`runtime.bodies.remote_figures.RemoteState` for a "remote" body); for gateways to other simulators.
        It may be off the walkable surface. Raises `RuntimeInputError` for a taken name or another state."""
        if not name or name in self.agents:
            raise RuntimeInputError(f"name {name!r} is taken or empty; names are unique in a world")
        agent = self.agents[name] = Agent(self._host, name, body, self._population(body).revive(body, state))
        self._forget_order()
        return agent

    def transforms(self, since: float | None = None) -> dict[str, np.ndarray]:
        """Where the bodies of agents' skeletons are: by name (n, 7) as of `Agent.pose`. Of many people who
        play recorded motion it takes a fraction of the time that their poses take one by one.

        Those of all agents; or, with ``since``, the `time` [s] when this was last asked, of those only whose
        turn has come after it: of people in medium detail 30 times a second, of those in low detail 15
        times, each at moments of its own, so that all frames have equally much to do; of everybody else
        always, and at once of those who have come, or got another body or level of detail, since then. It is
        of all agents, too, when this is asked for the first time after `restore`, and for a ``since`` that is
        later than now or earlier than that. Raises `RuntimeInputError` for a ``since`` that is not finite.
        """
        after = None if since is None else checked_number(since, "since", "s")
        if self._asked is None:
            after, self._asked = None, self.time
        elif after is not None and not self._asked <= after <= self.time:
            after = None
        if self._casts is None:
            homes: dict[Population, list[tuple[int, Agent]]] = {}
            for number, agent in enumerate(self.agents.values()):
                homes.setdefault(self._population(agent.body), []).append((number, agent))
            self._casts = [_drawn(home, members) for home, members in homes.items()]
        numbers: list[np.ndarray] = [np.empty(0, np.int64)]
        names: list[str] = []
        places: list[np.ndarray] = []
        for drawn in self._casts:
            each = None if after is None else np.where(drawn.changed >= after, -np.inf, after)
            which, there = drawn.cast.transforms(each, self.time)
            numbers.append(drawn.numbers[which])
            names += [drawn.names[k] for k in which]
            places += there
        order = np.argsort(np.concatenate(numbers)).tolist()
        return {names[k]: places[k] for k in order}

    def remove(self, agent: Agent) -> None:
        """Take an agent out of the world; it cannot be used any more. Raises `RuntimeInputError` for one that
        is not in it."""
        if not isinstance(agent, Agent):
            raise RuntimeInputError(f"an Agent is removed, such as world.agents['human1'], not {agent!r}")
        if self.agents.get(agent.name) is not agent:
            raise RuntimeInputError(f"{agent.name} is not in this world")
        self._population(agent.body).remove(agent.driver)
        del self.agents[agent.name]
        if self._streaming is not None:
            self._streaming.forget(agent.name)
        self._forget_order()
        agent.leave()

    def change_level(self, changes: Mapping[str, navmesh.Terrain | None], within: float = 0.0) -> None:
        """Change the level's chunks, between two ticks: by name, a `navmesh.Terrain` to be added or to
        replace the one of that name, None to remove it; see `navmesh.NodeGraph.update`.

        Takes load time; or, with ``within`` [s] of simulated time, constant time: the change is then worked
        out in a thread while the world goes on, and comes before the last tick of that time, for which `step`
        waits if need be. So a run is the same on any machine. Changes come in the order in which they were
        asked for: those before this one come with it at the latest. Zones can be blocked and opened
        meanwhile, and `save` keeps changes that are still to come.

        Nobody is moved. Agents whose route is still valid keep walking; the others look for another route to
        the same goals, and stop, with `Blocked`, where there is none. If its ground is removed, a quadruped
        stops and a walker stays where it is (both with `Lost`), and a person falls, with `Lost` if nothing is
        below. Raises `navmesh.NavmeshError` for the removal of a chunk that is not there and when nothing
        walkable is left, `RuntimeInputError` for what is no mapping or no time, and in an open world, which
        changes by `keep_around` and `players`; the world is then as it was. What only turns out when the
        change is worked out, such as that nothing walkable is left, `step` raises before the tick for which
        it is due; that change is dropped, and the world can be stepped on.
        """
        if self._streaming is not None:
            raise RuntimeInputError(
                "an open world is as it was baked; its chunks come and go with players and keep_around"
            )
        if not isinstance(changes, Mapping):
            raise RuntimeInputError(f"changes are a {type(changes).__name__}; give {{chunk's name: Terrain}}")
        within = checked_number(within, "within", "s", 0.0)
        if within > 0.0:
            due = self._clock.ticks + max(math.ceil(within / CONTROL_DT - 1e-6), 1) - 1
            self._changes.begin(self._level, changes, due)
            return
        self._changes.check(self._level, changes)
        self._take_changes(math.inf)
        self._go_on_on(self._changed(self._level, changes))

    def _changed(self, level: Level, changes: Mapping[str, navmesh.Terrain | None]) -> Level:
        """The ``level`` after ``changes``, worked out in any thread."""
        graph = level.graph.update(changes)
        if graph is level.graph:
            return level
        graph.prepare_like(level.graph)
        return self._foreseen(graph)

    def _foreseen(self, graph: navmesh.NodeGraph) -> Level:
        """The level of another ``graph``, with what those who will go on on it can work out in any thread."""
        for population in self._populations:
            population.foresee(graph)
        return Level.of(graph)

    def _take_changes(self, tick: float) -> None:
        """Go on on the level as it is after all changes that are to come before a ``tick``."""
        level = self._level
        try:
            while self._changes.due(tick):
                level = self._changes.end()
        finally:
            self._go_on_on(level)

    def _go_on_on(self, level: Level) -> None:
        """Let all go on on a level, if it is another."""
        if level.graph is self.graph:
            return
        zones = self.graph.zones  # those of the other are as they were when its work began
        for name in [name for name, blocked in level.graph.zones.items() if blocked != zones[name]]:
            (level.graph.block if zones[name] else level.graph.open)(name)
        self._level.graph, self._level.ground = level.graph, level.ground
        for population in self._populations:
            population.change_level()
        for agent in self.agents.values():
            agent.look_at_way()

    def block(self, *zones: str) -> None:
        """Block zones of the level's graph, by name, between two ticks, such as doors that are shut; see
        `navmesh.NodeGraph.with_zones` and `navmesh.NodeGraph.block`. Takes constant time, and that of
        `Agent.go_to` for each agent that has to look for another route. The world has its own copy of a graph
        with zones: block them here, not there.

        Agents whose route is still valid keep walking; the others look for another route to the same goals,
        and stop, with `Blocked`, where there is none. Nobody is moved, and nothing is put into the level:
        whoever stands in a zone stays there until it is opened or the agent is removed. Raises
        `navmesh.NavmeshError` for a zone that there is not.
        """
        self._turn_zones(zones, True)

    def open(self, *zones: str) -> None:
        """Open zones of the level's graph, as `block`. Agents keep their routes; those that have stopped wait
        for another order."""
        self._turn_zones(zones, False)

    def _turn_zones(self, zones: tuple[str, ...], blocked: bool) -> None:
        before = self.graph.zones
        (self.graph.block if blocked else self.graph.open)(*zones)
        if self.graph.zones == before:
            return
        for population in self._populations:
            population.change_zones()
        if blocked:
            for agent in self.agents.values():
                agent.look_at_way()

    def _forget_order(self) -> None:
        self._casts = self._roster = None

    def _at_level(self, agent: Agent, level: str, at_once: bool) -> Driver | None:
        self._forget_order()
        return self._population(agent.body).at_level(agent.driver, level, at_once)

    def _choose_levels(self) -> None:
        """Bring people to the levels of detail that they should have, some of them in each call."""
        chosen: list[tuple[Agent, str]] = []
        waiting = [each for each in self.agents.values() if each.waits_for_level and each.has_levels]
        unsettled = [each for each in waiting if each.detail != AUTO]
        if len(unsettled) < len(waiting):
            people = [agent for agent in self.agents.values() if agent.has_levels]
            automatic = np.array([agent.detail == AUTO for agent in people], np.bool_)
            now = np.array([LEVELS.index(agent.level) for agent in people])
            places = np.array([agent.position for agent in people])
            levels = levels_for(places, now, ~automatic, self._viewers, self._budget)
            wanted = np.flatnonzero(automatic & (levels != now))
            chosen = [
                (people[k], LEVELS[levels[k]]) for k in wanted[np.argsort(levels[wanted], kind="stable")]
            ]
        for each in unsettled:
            each.waits_for_level = each.detail != each.level
            if each.waits_for_level:
                chosen.append((each, each.detail))
        changed = 0
        for agent, level in chosen:
            heavy = PHYSICS in (level, agent.level)
            if heavy and changed >= _CHANGES:
                continue
            changed += agent.change_level(level) and heavy

    def _population(self, body: str) -> Population:
        population = self._homes.get(kind_of(body))
        if population is None:
            raise RuntimeInputError(f"the body {body!r} was registered after this world was made")
        return population

    def step(self, dt: float) -> int:
        """Advance by ``dt`` [s] ≥ 0, in whole ticks of 10 ms; the rest is owed to later calls. A tick takes
        constant time for each agent; people rehearse in slices (see ``rehearsal_ticks``).

        It can be interrupted between short pieces, see `surefoot.pausing`. Returns how many ticks were
        made. Raises `RuntimeInputError` for a ``dt`` below 0 or not finite.
        """
        dt = checked_number(dt, "dt", "s", 0.0)
        self._refuse_in_callback("step")
        clock = self._clock
        total = clock.owed + dt
        due = math.floor(total / CONTROL_DT + 1e-6)
        clock.owed = total
        self._stepping = True
        try:
            for made in range(1, due + 1):
                if made == due:
                    for population in self._populations:
                        population.remember()
                if self._changes.due(clock.ticks):
                    self._take_changes(clock.ticks)
                if self._streaming is not None and clock.ticks % CHANGES_CHUNKS == 0:
                    level = self._streaming.turn(self.agents)
                    if level is not None:
                        self._go_on_on(level)
                if clock.ticks % EVERY == 0:
                    self._traffic.direct(clock.ticks)
                clock.ticks += 1
                clock.owed = max(total - made * CONTROL_DT, 0.0)
                self._populations.tick()
                if clock.ticks % LOOKS == 0:
                    self._choose_levels()
                if self._roster is None:
                    everybody = list(self.agents.values())
                    self._roster = everybody, [agent.news for agent in everybody]
                agents, news = self._roster
                for agent in compress(agents, news):  # those with any
                    agent.notice()
                    pause()
                for agent in agents[clock.ticks % _LOOKS :: _LOOKS]:
                    agent.watch()
                    pause()
                self._log.tell()
        finally:
            self._stepping = False
        return due

    def report(self, event: Event) -> None:
        """Add an event to `events`, and tell who listens at the end of the tick. Raises `RuntimeInputError`
        for what is none."""
        self._log.report(event)

    def _refuse_in_callback(self, what: str) -> None:
        if self._stepping:
            raise RuntimeInputError(f"a callback may not {what} its world; do it when step has returned")

    def state_hash(self) -> str:
        """Hexadecimal digest of everything that decides how the world goes on; equal for equal runs."""
        checksum = hashlib.sha256(repr((self._clock.ticks, self._clock.owed)).encode())
        checksum.update(repr(self.random.bit_generator.state).encode())
        if self._viewers:
            checksum.update(repr((self._viewers, self._budget)).encode())
        for name, agent in self.agents.items():
            checksum.update(f"{name}:{agent.state_hash()}".encode())
            pause()
        if self._blocked:
            checksum.update(repr(self._blocked).encode())
        if self._streaming is not None:
            checksum.update(repr(self._streaming.save()).encode())
        if coming := self._changes.digest():
            checksum.update(repr(coming).encode())
        order = _by_arrival(self.agents)
        if order != list(self.agents):
            checksum.update(repr(order).encode())
        return checksum.hexdigest()[:32]

    @property
    def _blocked(self) -> tuple[str, ...]:
        """The zones that are blocked, in the order of their names."""
        return tuple(sorted(name for name, blocked in self.graph.zones.items() if blocked))

    @property
    def _arrivals(self) -> dict[str, int]:
        """Of each agent how many bodies came before its own: in this order populations have them. It differs
        from that of the agents once somebody has gone over to another level of detail and back."""
        return {name: k for k, name in enumerate(_by_arrival(self.agents))}

    def save(self) -> WorldState:
        """This moment, for `restore`. Takes load time."""
        agents, arrivals = {}, self._arrivals
        for name, agent in self.agents.items():
            agents[name] = agent.save(arrivals[name])
            pause()
        return WorldState(
            level=self.level_digest,
            skills=learned_digest(self._skills)
            if any(kind_of(each.body).uses_skill_files for each in self.agents.values())
            else "",
            ticks=self._clock.ticks,
            owed=self._clock.owed,
            events=tuple(self._log.unread),
            untold=tuple(self._log.untold),
            random=self.random.bit_generator.state,
            agents=agents,
            viewers=self._viewers,
            budget=self._budget,
            blocked=self._blocked,
            streaming=None if self._streaming is None else self._streaming.save(),
            coming=self._changes.save(),
        )

    def restore(self, state: WorldState) -> None:
        """Go back to a moment that `save` gave, in this world or any other with the same level; the run then
        goes on bit for bit as it did. Agents are made and removed as needed; those that were there by the
        same name and body stay the same objects. Takes load time, and so does the next tick: people rehearse
        again what they had rehearsed.

        Raises `RuntimeInputError` when the level or the release is another, or from within a callback; the
        world is then as it was.
        """
        self._refuse_in_callback("restore")
        if not isinstance(state, WorldState):
            raise RuntimeInputError(f"a world is restored from what save gave, not from {state!r}")
        if state.level != self.level_digest:
            raise RuntimeInputError(
                f"the state is of the level {state.level[:12]}…, this world's is {self.level_digest[:12]}…; "
                "restore it in a world of the same mesh and walk rules"
            )
        unknown = sorted(set(state.blocked) - set(self.graph.zones))
        if unknown:
            raise RuntimeInputError(
                f"the state has a blocked zone {unknown[0]!r}, this world's graph has none of that name; "
                "restore it in a world of a graph with the same zones"
            )
        own = learned_digest(self._skills)
        if state.skills not in ("", own):
            others = different(state.skills, own)
            raise RuntimeInputError(
                f"the state is of people with other {' and other '.join(others)}, who would go on in another "
                f"way; restore it {' and '.join(_AS_SAVED[each] for each in others)}"
            )
        before, agents = self.save(), dict(self.agents)
        try:
            state.check()
            self._become(state, agents)
        except (
            ValueError, TypeError, IndexError, KeyError, AttributeError, OverflowError, ArithmeticError,
        ) as error:  # fmt: skip
            self._become(before, agents)
            raise RuntimeInputError(f"the state does not fit this release: {error}") from error

    def _become(self, state: WorldState, known: Mapping[str, Agent]) -> None:
        """Go to ``state``; those of its agents that are ``known`` by name and body are the same objects."""
        if self._streaming is not None:
            self._reload(self._streaming, state)
        if state.blocked != self._blocked:
            self.graph.open(*set(self._blocked) - set(state.blocked))
            self.graph.block(*state.blocked)
            for population in self._populations:
                population.change_zones()
        here = [(name, agent.body) for name, agent in self.agents.items()]
        same = here == [(name, saved.body) for name, saved in state.agents.items()]
        same = same and _by_arrival(self.agents) == _by_arrival(state.agents)
        if not same or not all(self.agents[name].fits(saved) for name, saved in state.agents.items()):
            self._populate(state, known)
        for name, saved in state.agents.items():
            self.agents[name].restore(saved)
            pause()
        self.random.bit_generator.state = dict(state.random)
        self._clock.ticks, self._clock.owed = state.ticks, state.owed
        self._changes.load(self._level, state.coming, state.ticks)
        self._asked = None
        self._forget_order()
        self._log.become(state.events, state.untold)
        self._viewers, self._budget = state.viewers, state.budget
        if self._streaming is not None and state.streaming is not None:
            self._streaming.players = state.streaming.players

    def _reload(self, streaming: Streaming, state: WorldState) -> None:
        """Have loaded what was loaded in ``state``. Who was on something else is made anew."""
        if state.streaming is None:
            raise RuntimeInputError("the state does not say what of the open world was loaded")
        players = [each for each in state.streaming.players if isinstance(each, str)]
        if not set(players) <= set(state.agents):
            raise RuntimeInputError("the state has players that are none of its agents")
        level = streaming.load(state.streaming)
        if level is None:
            return
        for agent in tuple(self.agents.values()):
            self.remove(agent)
        self._go_on_on(level)

    def _populate(self, state: WorldState, known: Mapping[str, Agent]) -> None:
        """Make the agents those of ``state``, in their order, whose bodies come in the order in which they
        came there."""
        for agent in tuple(self.agents.values()):
            self.remove(agent)
        self._forget_order()
        for name in _by_arrival(state.agents):
            saved = state.agents[name]
            driver = self._population(saved.body).revive(saved.body, saved.driver)
            agent = known.get(name)
            if agent is not None and agent.body == saved.body:
                agent.take(driver)
            else:
                agent = Agent(self._host, name, saved.body, driver)
            self.agents[name] = agent
            pause()
        for name in state.agents:
            self.agents[name] = self.agents.pop(name)


def _by_arrival(agents: Mapping[str, Agent] | Mapping[str, AgentState]) -> list[str]:
    """Their names, in the order in which their bodies came into the world."""
    return sorted(agents, key=lambda name: agents[name].arrival)
