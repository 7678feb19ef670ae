"""Worlds with agents, missions, and what a user sees of them."""

from runtime.agent import Agent, Pose
from runtime.errors import RuntimeInputError
from runtime.events import (
    Arrived,
    BackedOut,
    Blocked,
    Departed,
    Event,
    Fell,
    Lost,
    SkillFinished,
    SkillStarted,
    Stuck,
)
from runtime.world import World, WorldState

__all__ = [
    "Agent",
    "Arrived",
    "BackedOut",
    "Blocked",
    "Departed",
    "Event",
    "Fell",
    "Lost",
    "Pose",
    "RuntimeInputError",
    "SkillFinished",
    "SkillStarted",
    "Stuck",
    "World",
    "WorldState",
]
