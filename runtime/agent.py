"""An agent: a body in a world that is told where to go."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from locomotion import PERSON_RULES, Human, HumanState
from locomotion import events as bodily
from locomotion.clearing import HEIGHT_TOLERANCE
from runtime.errors import RuntimeInputError
from runtime.events import Arrived, Blocked, Departed, Event, Fell, Lost, SkillFinished, SkillStarted, Stuck
from runtime.figure import Figure
from runtime.planning import NoWay, Plan, make_plan

if TYPE_CHECKING:
    from runtime.world import World

__all__ = ["Agent", "AgentState", "Pose"]


@dataclass(frozen=True)
class Pose:
    """Where the bodies of an agent's skeleton are.

    ``names`` of the n bodies, ``parents`` (n,) int32 (-1 for the root), ``transforms`` (n, 7) float64 in the
    world: position [m] and quaternion (w, x, y, z).
    """

    names: tuple[str, ...]
    parents: np.ndarray
    transforms: np.ndarray


@dataclass(frozen=True)
class AgentState:
    """What `World.save` keeps of an agent."""

    human: HumanState
    plans: tuple[Plan, ...]
    blocked: bool
    reported: int


class Agent:
    """One person in a world; made by `World.spawn`.

    ``name`` is unique in its world, ``body`` is "human". ``plans`` are the paths it has been given so far.
    """

    def __init__(self, world: "World", name: str, human: Human) -> None:
        self.name = name
        self.body = "human"
        self.human = human
        self.figure = Figure.from_model(human.model)
        self.plans: list[Plan] = []
        self._world = world
        self._blocked = False
        self._born = world.time - human.time
        self._reported = len(human.events)

    @property
    def status(self) -> str:
        """What it does, as `locomotion.Human.status` says, or "blocked": the last goal cannot be reached."""
        return "blocked" if self._blocked else self.human.status

    @property
    def position(self) -> np.ndarray:
        """(3,) float64 [m]: the point of the ground under its centre of mass."""
        return self.human.position

    @property
    def facing(self) -> float:
        """[rad, -π to π] counter-clockwise from the X axis."""
        return self.human.yaw

    @property
    def radius(self) -> float:
        """[m] that the graph's queries keep free around it."""
        return PERSON_RULES["radius"]

    @property
    def skills(self) -> Mapping[str, tuple[float, float]]:
        """For each affordance that it can clear the least and the greatest height [m]."""
        return {
            skill.affordance: (skill.heights[0] - HEIGHT_TOLERANCE, skill.heights[1] + HEIGHT_TOLERANCE)
            for skill in self.human.clearing
        }

    @property
    def pose(self) -> Pose:
        """Where its skeleton is now."""
        transforms = self.human.body_transforms()[1:]
        return Pose(self.figure.bodies, self.figure.parents, transforms)

    def go_to(self, point: ArrayLike, speed: float = 3.5) -> str:
        """Set out for ``point`` (3,) [m], or through several (k, 3) in order, at up to ``speed`` [m/s].

        Returns the status: "running", or "blocked" when there is no way (an event says why; the agent then
        keeps doing what it did). Raises `RuntimeInputError` for a point that is not finite numbers or
        an agent that has fallen, and `locomotion.LocomotionError` for a speed that is not above 0.
        """
        goals = (
            np.asarray(point, dtype=np.float64).reshape(-1, 3)
            if np.size(point) % 3 == 0
            else np.empty((0, 3))
        )
        if len(goals) == 0 or not np.isfinite(goals).all():
            raise RuntimeInputError(f"point must be finite numbers (3,) or (k, 3), not {point!r}")
        if self.human.status == "fallen":
            raise RuntimeInputError(f"{self.name} has fallen and cannot go anywhere")
        velocity = self.human.velocity[:2]
        moving = velocity if np.linalg.norm(velocity) > 0.5 else None
        goal = _triple(goals[-1])
        try:
            plan = make_plan(self._world.graph, self.position, list(goals), self.radius, self.skills, moving)
        except NoWay as error:
            self._blocked = True
            here = _triple(self.position)
            self._world.report(
                Blocked(self._world.time, self.name, here, _triple(goals[error.goal]), error.reason)
            )
            return self.status
        self.human.follow(plan.points, speed, plan.obstacles)
        self.plans.append(plan)
        self._blocked = False
        here = _triple(self.position)
        self._world.report(Departed(self._world.time, self.name, here, goal, plan.length, plan.skills))
        self._reported = len(self.human.events)
        return self.status

    def tick(self) -> None:
        """Advance by 10 ms; `World.step` calls this."""
        self.human.tick()
        for event in self.human.events[self._reported :]:
            told = self._translated(event)
            if told is not None:
                self._world.report(told)
        self._reported = len(self.human.events)

    def save(self) -> AgentState:
        """Everything needed to continue from here."""
        return AgentState(self.human.save_state(), tuple(self.plans), self._blocked, self._reported)

    def restore(self, state: AgentState) -> None:
        """Continue from a state of this agent."""
        self.human.restore_state(state.human)
        self.plans, self._blocked, self._reported = list(state.plans), state.blocked, state.reported

    def _translated(self, event: bodily.Event) -> Event | None:
        """A body's event as one of the world's, None for what the world reports on its own."""
        base: dict[str, Any] = {
            "time": event.time + self._born, "agent": self.name, "position": _triple(event.position)
        }  # fmt: skip
        if isinstance(event, bodily.Arrived):
            return Arrived(**base, goal=_triple(self.plans[-1].points[-1]))
        if isinstance(event, bodily.Fell):
            return Fell(**base)
        if isinstance(event, bodily.TookOff):
            return SkillStarted(**base, skill=event.affordance, height=event.height)
        if isinstance(event, bodily.Cleared):
            return SkillFinished(**base, skill=event.affordance, height=event.height)
        if isinstance(event, bodily.GotStuck):
            return Stuck(**base)
        if isinstance(event, bodily.MissedGoal):
            return Lost(**base, reason=f"passed the goal at a distance of {event.distance:.1f} m")
        if isinstance(event, bodily.StrayedFromPath):
            return Lost(**base, reason=f"is {event.distance:.1f} m beside its path")
        return None


def _triple(point: ArrayLike) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in np.asarray(point))
    return x, y, z
