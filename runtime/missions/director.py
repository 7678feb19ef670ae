"""The director of a mission: lets every agent perform its script, and gives the orders of triggers."""

from collections.abc import Sequence

import numpy as np

from runtime.events import Arrived, Event, Fell, SkillFinished, Told
from runtime.missions.actions import Action, Clear, Follow, Go, Patrol, Progress, TakePosture, Wait
from runtime.missions.mission import Address, LoadedMission, places_of
from runtime.missions.model import Region, Step, Trigger
from runtime.world.agent import Agent
from runtime.world.world import World

__all__ = ["Director", "Performer", "inside"]


class Performer:
    """One agent and what is left of its script.

    ``state`` is "idle" (nothing to do yet), "going", "done" or "failed"; ``finished`` [s] is when its script
    was done, None before.
    """

    def __init__(self, agent: Agent) -> None:
        self.agent = agent
        self.state = "idle"
        self.finished: float | None = None
        self._actions: Sequence[Action] = ()
        self._at = 0

    @property
    def endless(self) -> bool:
        """Whether it performs something that never ends by itself."""
        return self.state == "going" and self._actions[self._at].endless

    @property
    def share(self) -> float:
        """How much of its script is done, 0 to 1."""
        if self.state != "going":
            return 1.0
        return (self._at + self._actions[self._at].share) / len(self._actions)

    def perform(self, actions: Sequence[Action], now: float) -> None:
        """Do ``actions`` from ``now`` [s] on, instead of anything else."""
        self._actions, self._at, self.finished = actions, -1, None
        self._next(now)

    def go_on(self, now: float, events: Sequence[Event]) -> None:
        """After a step of the world; ``events`` are its own since the last."""
        if self.state == "going":
            self._take(self._actions[self._at].go_on(self.agent, now, events), now)

    def _next(self, now: float) -> None:
        self._at += 1
        if self._at == len(self._actions):
            self.state, self.finished = "done", now
        else:
            self._take(self._actions[self._at].begin(self.agent, now), now)

    def _take(self, progress: Progress, now: float) -> None:
        if progress == "done":
            self._next(now)
        else:
            self.state = progress


class Director:
    """Runs the scripts and triggers of a mission in its world: `begin`, then `go_on` after every step.

    ``clearings``: for every `use` step, by its address, the run-up and the place beyond, (2, 3) [m].
    """

    def __init__(self, loaded: LoadedMission, world: World, clearings: dict[Address, np.ndarray]) -> None:
        self._loaded, self._world, self._clearings = loaded, world, clearings
        self._speeds = {spec.name: spec.speed for spec in loaded.mission.agents}
        self._waiting = list(enumerate(loaded.mission.triggers))
        self.performers = {name: Performer(agent) for name, agent in world.agents.items()}

    @property
    def over(self) -> bool:
        """Whether nobody has anything left to do, and nothing is left that could give orders."""
        if any(p.state == "going" and not p.endless for p in self.performers.values()):
            return False
        if any(trigger.when.after is not None for _, trigger in self._waiting):
            return False
        on_and_on = [name for name, performer in self.performers.items() if performer.endless]
        finite = any(performer.state in ("done", "failed") for performer in self.performers.values())
        heard = any(_watched(trigger) in on_and_on for _, trigger in self._waiting)
        return not on_and_on or (finite and not heard)

    @property
    def share(self) -> float:
        """How much of the scripts is done, 0 to 1."""
        return float(np.mean([performer.share for performer in self.performers.values()]))

    def begin(self) -> None:
        """Let everybody begin."""
        for i, spec in enumerate(self._loaded.mission.agents):
            if spec.steps:
                self._order(spec.name, spec.steps, ("agents", i, "script"))

    def go_on(self, events: Sequence[Event]) -> None:
        """After a step of the world, with its events since the last."""
        for name, performer in self.performers.items():
            performer.go_on(self._world.time, [event for event in events if event.agent == name])
        for entry in list(self._waiting):
            index, trigger = entry
            why = self._happened(trigger, events)
            if why is None:
                continue
            self._waiting.remove(entry)
            for o, order in enumerate(trigger.then):
                position = self._world.agents[order.agent].position
                place = (float(position[0]), float(position[1]), float(position[2]))
                self._world.report(Told(self._world.time, order.agent, place, why))
                self._order(order.agent, order.do, ("triggers", index, "then", o, "do"))

    def _order(self, name: str, steps: Sequence[Step], address: Address) -> None:
        actions = [self._action(step, self._speeds[name], (*address, k)) for k, step in enumerate(steps)]
        self.performers[name].perform(actions, self._world.time)

    def _action(self, step: Step, speed: float, address: Address) -> Action:
        point = self._loaded.point
        speed = speed if step.speed is None else step.speed
        if step.wait is not None:
            return Wait(step.wait)
        if step.follow is not None:
            target = self._world.agents[step.follow.agent]
            return Follow(target, step.follow.distance, speed, step.follow.seconds)
        if step.patrol is not None:
            points = np.array([point(place) for place in step.patrol.points])
            return Patrol(points, speed, step.patrol.rounds, step.patrol.seconds)
        if step.posture is not None:
            return TakePosture(step.posture)
        if step.hold is not None:
            return TakePosture(None, step.hold.object, step.hold.state)
        if step.use is not None:
            return Clear(self._clearings[address], speed, step.use.skill)
        return Go(np.array([point(place) for _, place in places_of(step.goto)]), speed)

    def _happened(self, trigger: Trigger, events: Sequence[Event]) -> str | None:
        """What the trigger waited for, in words; None while it has not happened."""
        when = trigger.when
        if when.after is not None:
            return f"{when.after:g} s are over" if self._world.time >= when.after - 1e-9 else None
        if when.enters is not None:
            region = self._loaded.mission.regions[when.enters.region]
            position = self._world.agents[when.enters.agent].position
            return f"{when.enters.agent} enters {when.enters.region}" if inside(region, position) else None
        for event in events:
            if isinstance(event, Arrived) and event.agent == when.arrives:
                return f"{event.agent} arrives"
            if isinstance(event, Fell) and event.agent == when.falls:
                return f"{event.agent} falls"
            if (
                when.uses is not None
                and isinstance(event, SkillFinished)
                and (event.agent, event.skill) == (when.uses.agent, when.uses.skill)
            ):
                return f"{event.agent} uses skill {event.skill}"
        return None


def inside(region: Region, position: np.ndarray) -> bool:
    """Whether ``position`` (3,) [m] is in ``region``."""
    if region.center is not None and region.radius is not None:
        return bool(np.linalg.norm(position - np.array(region.center)) <= region.radius)
    return bool(np.all(position >= np.array(region.min)) and np.all(position <= np.array(region.max)))


def _watched(trigger: Trigger) -> str | None:
    """The agent whose doings the trigger waits for."""
    when = trigger.when
    if when.enters is not None:
        return when.enters.agent
    return when.uses.agent if when.uses is not None else when.arrives or when.falls
