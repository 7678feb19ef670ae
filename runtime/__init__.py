"""Worlds with agents, missions, playtests, and ways to see them.

    import navmesh, runtime

    runtime.prepare()    # compiles all kernels, once on a machine: 1 to 4 minutes
    world = runtime.World(navmesh.Terrain.load("level.obj", up="z"), seed=0)
    ada = world.spawn("human", at=(6.0, 4.0, 0.0))
    ada.go_to((46.0, 4.0, 0.3), speed=3.3)
    while ada.moving:
        world.step(1 / 60)

Everywhere: metres, seconds, radians; Z up, X forward; quaternions (w, x, y, z).
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from surefoot import __version__
from surefoot.preparing import prepare_with

if TYPE_CHECKING:
    from runtime.bodies.pose import Pose
    from runtime.errors import RuntimeInputError
    from runtime.events import (
        Arrived,
        BackedOut,
        Blocked,
        Departed,
        Event,
        Fell,
        GotUp,
        Hindered,
        Lost,
        PostureReached,
        SkillFinished,
        SkillStarted,
        Stuck,
        TurnedAway,
        Waiting,
    )
    from runtime.views.live import LiveView
    from runtime.warmup import prepare
    from runtime.world.agent import Agent
    from runtime.world.level_of_detail import Budget, Viewer
    from runtime.world.world import World, WorldState

__all__ = [
    "Agent",
    "Arrived",
    "BackedOut",
    "Blocked",
    "Budget",
    "Departed",
    "Event",
    "Fell",
    "GotUp",
    "Hindered",
    "LiveView",
    "Lost",
    "Pose",
    "PostureReached",
    "RuntimeInputError",
    "SkillFinished",
    "SkillStarted",
    "Stuck",
    "TurnedAway",
    "Viewer",
    "Waiting",
    "World",
    "WorldState",
    "__version__",
    "prepare",
]

_MODULES = (
    "errors", "events", "world.agent", "world.level_of_detail", "bodies.pose", "world.world", "world.state",
    "views.live", "warmup",
)  # fmt: skip


def __getattr__(name: str) -> Any:
    # imported when first asked for: `surefoot --help` needs neither physics nor kernels
    if name in __all__:
        for module in (
            "errors",
            "events",
            "world.agent",
            "world.level_of_detail",
            "bodies.pose",
            "world.world",
            "views.live",
            "warmup",
        ):
            found = getattr(import_module(f"runtime.{module}"), name, None)
            if found is not None:
                return found
    raise AttributeError(f"module 'runtime' has no attribute {name!r}")


def _prepare() -> None:
    import_module("runtime.warmup").prepare()


def _is_prepared() -> bool:
    return import_module("runtime.warmup").is_compiled()


prepare_with(_prepare, _is_prepared)  # for worlds, which import nothing of the warm-up: it makes worlds


def __dir__() -> list[str]:
    return sorted(__all__)
