"""Record a running world as a `runtime.traces.trace.Trace`."""

import numpy as np

import navmesh
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
        self._agents: dict[str, Agent] = {}
        self.events: list[Event] = []

    def sample(self) -> list[Event]:
        """Record the present poses; returns the events since the last call."""
        fresh = self._world.events
        self.events += fresh
        self._times.append(self._world.time)
        for name, transforms in self._world.transforms().items():
            now = transforms.astype(np.float32)
            self._agents[name] = self._world.agents[name]
            # who comes later stands at its first place until then
            poses = self._poses.setdefault(name, [now] * (len(self._times) - 1))
            poses.append(now)
        for poses in self._poses.values():
            poses += poses[-1:] * (len(self._times) - len(poses))
        return fresh

    def trace(self, report: dict) -> Trace:
        """The whole recording, with a ``report`` of plain values."""
        agents = tuple(
            AgentTrace(
                name=name,
                figure=agent.figure,
                poses=np.stack(self._poses[name]),
                paths=tuple(
                    PathTrace(plan.raw, plan.pulled, plan.points)
                    for plan in (agent.plans if self._world.agents.get(name) is agent else ())
                ),
            )
            for name, agent in self._agents.items()
        )
        return Trace(
            level=level_trace(self._world.graph),
            times=np.array(self._times),
            agents=agents,
            events=tuple(event.to_dict() for event in self.events),
            state_hash=self._world.state_hash(),
            report=report,
        )


def level_trace(graph: navmesh.NodeGraph) -> LevelTrace:
    """What is drawn of a graph."""
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
