"""A person's progress on its path: arrived, lost or stuck."""

from __future__ import annotations

import math

import numpy as np

from locomotion.body_events import Arrived, GotStuck, MissedGoal, StrayedFromPath
from locomotion.gaits.run import controller
from locomotion.human.person import Person

__all__ = ["ARRIVAL_DISTANCE", "STRAYED", "STUCK_TIME", "notice"]

ARRIVAL_DISTANCE = 0.5
"""A person has arrived when its centre of mass is within this horizontal distance of the goal [m]."""
STRAYED = 2.0
"""[m] beside the path at which a person gives up following it."""
STUCK_TIME = 8.0
"""[s] without progress along the path after which a person counts as stuck."""
_WALK_ARRIVAL = 0.15  # [m] before the end of its path at which a walking person stops
_STAYS = 1.0  # [m/s] a person slower than this stays at its goal
_COMES_BACK = 3.5  # [m] beside its path within which one not running may slow down and turn first
_CLIMBS_BACK = 6.0  # [m] beside its path, after sliding there, from which a person climbs back


def notice(person: Person) -> None:
    """End the path of a person that has arrived, is lost or is stuck."""
    follower = person.follower
    assert follower.path is not None
    if follower.interrupted is not None and follower.remaining < _WALK_ARRIVAL:
        follower.turn_again(person.ticks)
        return
    on_foot = person.status in ("walking", "scrambling")  # a runner overshoots and has to come back
    if on_foot and follower.remaining < _WALK_ARRIVAL:
        goal, com = follower.path.goal, person.control[controller.COM]
        distance = math.hypot(goal[0] - com[0], goal[1] - com[1])
        if distance <= ARRIVAL_DISTANCE and float(np.linalg.norm(person.velocity[:2])) <= _STAYS:
            person.end("arrived", Arrived(person.time, person.point, distance))
        elif distance > ARRIVAL_DISTANCE and follower.ended and person.status != "scrambling":
            person.end("lost", MissedGoal(person.time, person.point, distance))
    elif abs(follower.lateral) > _may_stray(person):
        person.end("lost", StrayedFromPath(person.time, person.point, abs(follower.lateral)))
    elif follower.pace < 1.0:
        follower.wait()
    elif follower.without_headway(person.ticks) > STUCK_TIME:
        person.end("stuck", GotStuck(person.time, person.point))


def _may_stray(person: Person) -> float:
    """[m] beside its path beyond which it is lost."""
    if person.fours.active:
        return _CLIMBS_BACK
    return STRAYED if person.on_feet.runs else _COMES_BACK
