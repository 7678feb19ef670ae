"""Watch a world while it runs.

view = runtime.LiveView(world)
print(view.address)                 # open it in a browser
while playing:
    world.step(1 / 60)
    view.show()
"""

import time

import numpy as np

from runtime.bodies.held_things import Looks
from runtime.planning.planning import Plan
from runtime.traces.recording import level_trace
from runtime.traces.trace import PathTrace
from runtime.views.window import Moment, Window
from runtime.world.world import World

__all__ = ["LiveView"]

_APART = 1 / 30  # [s] between moments passed to the page


class LiveView:
    """A page that shows ``world`` as of the last `show`: level, graph, obstacles with their tags, raw, pulled
    and smoothed paths, bodies, a time line of the last minute watched, and a camera that follows an agent.

    A thread draws it until `close`; the world never waits. ``address``: open it in a browser. ``host``: only
    this machine by default. ``port``: 0 for any free port.
    """

    def __init__(self, world: World, host: str = "127.0.0.1", port: int = 0) -> None:
        self._world = world
        self._graph, self._level = world.graph, level_trace(world.graph)
        self._window = Window(self._level, host, port)
        self.address = self._window.address
        self._last = -_APART
        self._ways: dict[str, tuple[Plan, PathTrace]] = {}
        self._looks = Looks()

    def show(self) -> None:
        """Show the world as it is now; call it after `World.step`, as often as you like. Copies the poses, at
        most thirty times a second and only while a browser shows the page."""
        now = time.monotonic()
        if now - self._last < _APART or not self._window.watched:
            return
        self._last = now
        if self._world.graph is not self._graph:
            self._graph, self._level = self._world.graph, level_trace(self._world.graph)
        figures, poses = {}, [np.empty((0, 7))]
        for name, transforms in self._world.transforms().items():
            agent = self._world.agents[name]
            figures[name], pose = self._looks.look(name, agent.figure, transforms, agent.held[0])
            poses.append(pose)
        joined = np.concatenate(poses)
        self._window.show(Moment(self._world.time, self._level, figures, joined, self._paths()))

    @property
    def watched(self) -> bool:
        """Whether a browser shows the page."""
        return self._window.watched

    @property
    def is_live(self) -> bool:
        """Whether the page shows the last moment passed to `show`, and not an earlier one."""
        return self._window.is_live

    def close(self) -> None:
        """Close the page."""
        self._window.close()

    def __enter__(self) -> "LiveView":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _paths(self) -> tuple[PathTrace, ...]:
        """Paths of the agents that are moving; the same objects as long as the paths are the same."""
        ways = {}
        for name, agent in self._world.agents.items():
            plan = agent.way
            if plan is not None:
                known = self._ways.get(name)
                same = known is not None and known[0] is plan
                ways[name] = known if same else (plan, PathTrace(plan.raw, plan.pulled, plan.points))
        self._ways = ways
        return tuple(path for _, path in ways.values())
