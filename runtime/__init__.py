"""Worlds with agents, missions, and what a user sees of them."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from runtime.agent import Agent
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
        SkillFinished,
        SkillStarted,
        Stuck,
    )
    from runtime.live import LiveView
    from runtime.pose import Pose
    from runtime.world import World, WorldState

__all__ = [
    "Agent",
    "Arrived",
    "BackedOut",
    "Blocked",
    "Departed",
    "Event",
    "Fell",
    "GotUp",
    "Hindered",
    "LiveView",
    "Lost",
    "Pose",
    "RuntimeInputError",
    "SkillFinished",
    "SkillStarted",
    "Stuck",
    "World",
    "WorldState",
]


def __getattr__(name: str) -> Any:
    # imported when first asked for: `surefoot --help` needs neither physics nor kernels
    if name in __all__:
        for module in ("errors", "events", "agent", "pose", "world", "live"):
            found = getattr(import_module(f"runtime.{module}"), name, None)
            if found is not None:
                return found
    raise AttributeError(f"module 'runtime' has no attribute {name!r}")
