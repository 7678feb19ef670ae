"""What happens to a body, as an event of its world."""

from typing import Any

from locomotion import body_events as bodily
from locomotion.skills.registry import skill_kind
from runtime.events import (
    Arrived,
    BackedOut,
    Event,
    Fell,
    GotUp,
    Lost,
    Point,
    PostureReached,
    SkillFinished,
    SkillStarted,
    Stuck,
    TurnedAway,
)

__all__ = ["news_of"]


def news_of(event: bodily.Event, agent: str, born: float, goal: Point) -> Event | None:
    """A body's ``event`` as one of the world's, of ``agent`` whose body was ``born`` at that time [s] and is
    on its way to ``goal``; None for what the world reports on its own."""
    x, y, z = event.position
    here = float(x), float(y), float(z)
    base: dict[str, Any] = {"time": event.time + born, "agent": agent, "position": here}
    if isinstance(event, bodily.Arrived):
        return Arrived(**base, goal=goal)
    if isinstance(event, bodily.Fell):
        return Fell(**base)
    if isinstance(event, bodily.GotUp):
        return GotUp(**base, seconds=event.seconds)
    if isinstance(event, bodily.TookOff):
        return SkillStarted(**base, skill=skill_kind(event.affordance).skill, height=event.height)
    if isinstance(event, bodily.Cleared):
        return SkillFinished(**base, skill=skill_kind(event.affordance).skill, height=event.height)
    if isinstance(event, bodily.TurnedAway):
        skill = skill_kind(event.affordance).skill
        return TurnedAway(**base, skill=skill, height=event.size, odds=event.odds)
    if isinstance(event, bodily.GotStuck):
        return Stuck(**base, reason=event.reason)
    if isinstance(event, bodily.MissedGoal):
        return Lost(**base, reason=f"passed the goal at a distance of {event.distance:.1f} m")
    if isinstance(event, bodily.PostureReached):
        return PostureReached(**base, posture=event.posture, holds=event.held)
    if isinstance(event, bodily.BackedOut):
        return BackedOut(**base, length=event.distance)
    if isinstance(event, bodily.LostGround):
        return Lost(**base, reason=event.reason)
    if isinstance(event, bodily.StrayedFromPath):
        return Lost(**base, reason=f"is {event.distance:.1f} m beside its path")
    return None
