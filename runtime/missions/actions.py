"""Actions: what one step of a script makes an agent do, asked again after every step of the world."""

import math
from collections.abc import Sequence
from typing import Literal, Protocol

import numpy as np

from runtime.errors import RuntimeInputError
from runtime.events import Arrived, Event, PostureReached, SkillFinished
from runtime.planning.planning import NotLoaded, NoWay, Plan
from runtime.world.agent import Agent

__all__ = ["Action", "Clear", "Follow", "Go", "Patrol", "Progress", "TakePosture", "Wait", "first_far"]

THERE = 0.25
"""[m] An agent this near to a place is there and need not go."""
_LOOK = 0.5  # [s] between looks at the agent that is followed
_APART = 1.0  # [m] and two radii: so far a way may end beside a target that stands where one does not fit
_STIRRED = 0.5  # [m] that it has to move before the follower takes another way

Progress = Literal["going", "done", "failed"]
"""How an action goes: "going", "done" or "failed"."""


class Action(Protocol):
    """``endless``: whether it never ends by itself. ``share``: how much of it is done, 0 to 1."""

    endless: bool
    share: float

    def begin(self, agent: Agent, now: float) -> Progress: ...
    def go_on(self, agent: Agent, now: float, events: Sequence[Event]) -> Progress:
        """After a step of the world: ``now`` [s] and what has happened to ``agent`` since."""
        ...


class Go:
    """Go through ``points`` (k, 3) [m] in order; done on arrival at the last."""

    endless = False
    share = 0.0

    def __init__(self, points: np.ndarray, speed: float) -> None:
        self.points, self.speed = points, speed

    def begin(self, agent: Agent, now: float) -> Progress:
        left = self.points[first_far(agent.position, self.points) :]
        return _send(agent, left, self.speed) if len(left) else "done"

    def go_on(self, agent: Agent, now: float, events: Sequence[Event]) -> Progress:
        self.share = agent.progress
        if any(isinstance(event, Arrived) for event in events):
            return "done"
        return "going" if agent.moving or agent.status == "waiting" else "failed"


class Clear(Go):
    """Go through ``points``, over an obstacle between them; done on arrival if ``skill`` was used."""

    def __init__(self, points: np.ndarray, speed: float, skill: str) -> None:
        super().__init__(points, speed)
        self._skill, self._used = skill, False

    def go_on(self, agent: Agent, now: float, events: Sequence[Event]) -> Progress:
        self._used |= any(isinstance(each, SkillFinished) and each.skill == self._skill for each in events)
        progress = super().go_on(agent, now, events)
        return "failed" if progress == "done" and not self._used else progress


class Wait:
    """Stand for ``seconds``; an agent that is on its way comes to a stand first."""

    endless = False
    share = 0.0

    def __init__(self, seconds: float) -> None:
        self._seconds, self._begun = seconds, 0.0

    def begin(self, agent: Agent, now: float) -> Progress:
        self._begun = now
        agent.stop()
        return "going"

    def go_on(self, agent: Agent, now: float, events: Sequence[Event]) -> Progress:
        self.share = min((now - self._begun) / self._seconds, 1.0)
        return "done" if now >= self._begun + self._seconds - 1e-9 else "going"


class TakePosture:
    """Take ``posture``, or, if it is None, let the hands do something with an object: done when it is so."""

    endless = False
    share = 0.0

    def __init__(self, posture: str | None, held: str = "", state: str = "") -> None:
        self._posture, self._held, self._state = posture, held, state

    def begin(self, agent: Agent, now: float) -> Progress:
        try:
            if self._posture is not None:
                agent.take_posture(self._posture)
            else:
                agent.hold(self._held, self._state)
        except RuntimeInputError:  # it has no such posture, or no way there any more
            return "failed"
        return "going"

    def go_on(self, agent: Agent, now: float, events: Sequence[Event]) -> Progress:
        return "done" if any(isinstance(event, PostureReached) for event in events) else "going"


class Patrol:
    """Go through ``points`` (k, 3), ``rounds`` times, for ``seconds``, or for ever (both None)."""

    def __init__(self, points: np.ndarray, speed: float, rounds: int | None, seconds: float | None) -> None:
        self._points, self._speed = points, speed
        self._rounds, self._seconds = rounds or math.inf, seconds or math.inf
        self._ends, self._made = math.inf, 0
        self._round = Go(points, speed)
        self.endless = rounds is None and seconds is None
        self.share = 0.0

    def begin(self, agent: Agent, now: float) -> Progress:
        self._ends, self._made = now + self._seconds, 0
        return self._round.begin(agent, now)

    def go_on(self, agent: Agent, now: float, events: Sequence[Event]) -> Progress:
        progress = self._round.go_on(agent, now, events)
        if now >= self._ends - 1e-9:
            agent.stop()
            return "done"
        if progress == "done":
            self._made += 1
            if self._made >= self._rounds:
                return "done"
            self._round = Go(self._points, self._speed)
            progress = self._round.begin(agent, now)
        rounds = (self._made + self._round.share) / self._rounds
        self.share = max(rounds, 1.0 - (self._ends - now) / self._seconds if self._ends < math.inf else 0.0)
        return progress


class Follow:
    """Stay ``distance`` [m] behind ``target`` along the way to it, for ``seconds`` or for ever (None)."""

    def __init__(self, target: Agent, distance: float, speed: float, seconds: float | None) -> None:
        self._target, self._distance, self._speed = target, distance, speed
        self._seconds = seconds or math.inf
        self._ends, self._looks = math.inf, -math.inf
        self._seen = np.full(3, np.inf)
        self.endless = seconds is None
        self.share = 0.0

    def begin(self, agent: Agent, now: float) -> Progress:
        self._ends = now + self._seconds
        return self.go_on(agent, now, ())

    def go_on(self, agent: Agent, now: float, events: Sequence[Event]) -> Progress:
        if agent.status == "fallen":
            return "failed"
        if now >= self._ends - 1e-9:
            agent.stop()
            return "done"
        if self._ends < math.inf:
            self.share = 1.0 - (self._ends - now) / self._seconds
        if now >= self._looks - 1e-9:
            self._looks = now + _LOOK
            self._look(agent)
        return "going"

    def _look(self, agent: Agent) -> None:
        there = self._target.position
        if (agent.moving or agent.status == "arrived") and np.linalg.norm(there - self._seen) < _STIRRED:
            return  # one that has arrived farther off has found others in its place
        if not agent.moving and np.linalg.norm(there - agent.position) < self._distance + _STIRRED:
            return
        try:
            goal = self._behind(agent.plan(there), agent.radius)
        except NotLoaded:
            goal = there
        except NoWay:
            return
        if goal is None:
            agent.stop()
        elif _send(agent, goal[None], self._speed) == "going":
            self._seen = there

    def _behind(self, plan: Plan, radius: float) -> np.ndarray | None:
        """(3,) [m] Where one of ``radius`` [m] goes on its way to the target: that itself if only a part of
        the way is loaded, which ends short of it; None for one that is as near as it should be."""
        there = self._target.position
        if np.linalg.norm((plan.points[-1] - there)[:2]) > self._distance + 2.0 * radius + _APART:
            return there
        if plan.length < self._distance + THERE:
            return None
        return _along(plan.points, plan.length - self._distance)


def _send(agent: Agent, points: np.ndarray, speed: float) -> Progress:
    """Tell ``agent`` to go; "failed" when there is no way or it cannot go anywhere."""
    try:
        return "failed" if agent.go_to(points, speed) == "blocked" else "going"
    except RuntimeInputError:  # it has fallen
        return "failed"


def first_far(position: np.ndarray, points: Sequence[np.ndarray] | np.ndarray) -> int:
    """Index of the first of ``points``, (3,) each, that a body at ``position`` is not already at."""
    far = (k for k, point in enumerate(points) if np.linalg.norm(point - position) > THERE)
    return next(far, len(points))


def _along(points: np.ndarray, length: float) -> np.ndarray:
    """The (3,) point of a polyline at the horizontal arc length ``length`` [m]."""
    steps = np.linalg.norm(np.diff(points[:, :2], axis=0), axis=1)
    arc = np.concatenate([[0.0], np.cumsum(steps)])
    return np.array([np.interp(length, arc, points[:, axis]) for axis in range(3)])
