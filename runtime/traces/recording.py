"""Record a running world as a `runtime.traces.trace.Trace`."""

import numpy as np

import navmesh
from navmesh.level.chunks import chunks_of
from runtime.bodies.held_things import figure_with, thing_figure, things_in
from runtime.events import Event
from runtime.traces.trace import AgentTrace, LevelTrace, PathTrace, Trace
from runtime.world.agent import Agent
from runtime.world.world import World

__all__ = ["Recorder", "level_trace"]


class Recorder:
    """Collects poses and events of ``world``; call `sample` at each moment to record."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._times: list[float] = []
        self._poses: dict[str, list[np.ndarray]] = {}
        self._held: dict[str, list[str]] = {}
        self._agents: dict[str, Agent] = {}
        self.events: list[Event] = []
        self._graph: navmesh.NodeGraph | None = None
        self._chunks: dict[str, navmesh.Terrain] = {}

    def sample(self) -> list[Event]:
        """Record the present poses; returns the events since the last call."""
        fresh = self._world.events
        if self._world.graph is not self._graph and self._world.loaded:
            self._graph = self._world.graph
            self._chunks |= chunks_of(self._graph.terrain)
        self.events += fresh
        self._times.append(self._world.time)
        for name, transforms in self._world.transforms().items():
            now = transforms.astype(np.float32)
            self._agents[name] = self._world.agents[name]
            # who comes later stands at its first place until then
            poses = self._poses.setdefault(name, [now] * (len(self._times) - 1))
            poses.append(now)
            held = self._held.setdefault(name, [""] * (len(self._times) - 1))
            held.append(self._agents[name].held[0])
        for told in (*self._poses.values(), *self._held.values()):
            told += told[-1:] * (len(self._times) - len(told))
        return fresh

    def trace(self, report: dict) -> Trace:
        """The whole recording, with a ``report`` of plain values. Its level is the present one; of an
        open world it has every chunk that was loaded during the recording."""
        agents = tuple(self._agent(name, agent) for name, agent in self._agents.items())
        return Trace(
            level=level_trace(self._everything()),
            times=np.array(self._times),
            agents=agents,
            events=tuple(event.to_dict() for event in self.events),
            state_hash=self._world.state_hash(),
            report=report,
        )

    def _everything(self) -> navmesh.NodeGraph:
        graph = self._world.graph
        missing = {name: chunk for name, chunk in self._chunks.items() if name not in self._world.loaded}
        return graph.update(missing) if missing else graph

    def _agent(self, name: str, agent: Agent) -> AgentTrace:
        paths = tuple(
            PathTrace(plan.raw, plan.pulled, plan.points)
            for plan in (agent.plans if self._world.agents.get(name) is agent else ())
        )
        figure, poses, held = agent.figure, np.stack(self._poses[name]), np.array(self._held[name])
        things = [thing for thing in np.unique(held).tolist() if thing and thing_figure(thing) is not None]
        if not things:
            return AgentTrace(name, figure, poses, paths)
        places = things_in(figure.bodies, poses.astype(np.float64)).astype(np.float32)
        poses = np.concatenate([poses, *[places[:, None]] * len(things)], axis=1)
        return AgentTrace(
            name,
            figure_with(figure, things),
            poses,
            paths,
            np.stack([held == thing for thing in things], axis=1),
        )


def level_trace(graph: navmesh.NodeGraph) -> LevelTrace:
    """What is drawn of a graph."""
    graph = graph.without_zones()
    source = np.repeat(np.arange(len(graph), dtype=np.int32), np.diff(graph.edge_start))
    once = source < graph.edge_target
    obstacles = graph.obstacles
    return LevelTrace(
        vertices=graph.terrain.vertices,
        faces=graph.terrain.faces,
        positions=graph.positions,
        radii=graph.radii,
        edges=np.stack([source[once], graph.edge_target[once]], axis=1),
        affordances=tuple(str(each) for each in obstacles.affordance),
        rim=obstacles.rim,
        normal=obstacles.normal,
        height=obstacles.size,
    )
