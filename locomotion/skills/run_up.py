"""Running up to the obstacles of a path and clearing them, one after the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.gaits.run import controller
from locomotion.gaits.run.skill import RunSkill
from locomotion.ground.ground import FRICTION
from locomotion.paths.follower import PathFollower
from locomotion.paths.gait_plan import RUN_UP, SET_OFF
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.skills.approach import ApproachPlan
from locomotion.skills.interface import ClearingSkill, distance_to, foot_distance, plan_run_up, skill_for
from locomotion.skills.run_up_layout import (
    BALKED,
    BEND,
    FARTHER,
    FASTER,
    NEXT,
    PLANNED,
    REHEARSED,
    RETURNS,
    RUN_UP_SIZE,
    STEPS_SEEN,
)

__all__ = ["RUN_UP_SIZE", "RunUp", "TakeOff"]

_MOST_RETURNS = 8
_ROOM = 5.2  # [m] before an obstacle in which a body that begins to run comes to its entry speed
_SETTING_OFF = SET_OFF - _ROOM  # [m] that it walks before it runs
_OFF_EDGE, _WORTH_IT = 0.8, 0.7  # [m] kept from the obstacle behind it; that it goes back at least


@dataclass(frozen=True)
class TakeOff:
    """A skill has begun. early [m]: how far the stance foot is before its mark; fast [m/s]: how much faster
    than the entry speed the last step was."""

    early: float
    fast: float


class RunUp:
    """The obstacles of a path, and how far the body has come with them. ``plan``: what it remembers of
    the run-up (`locomotion.skills.run_up_layout`); ``at_work``: what the skill that is at work remembers,
    None where there is none."""

    def __init__(self, skills: Sequence[ClearingSkill], run: RunSkill) -> None:
        """``skills``: to clear them with, on top of ``run``."""
        self.skills, self._run = tuple(skills), run
        self.obstacles: tuple[ObstacleAhead, ...] = ()
        self.plan = np.zeros(RUN_UP_SIZE)
        self.at_work: NDArray[np.float64] | None = None

    def begin(self, obstacles: Sequence[ObstacleAhead]) -> None:
        """Be about to clear ``obstacles``, in order of their arc lengths."""
        self.obstacles, self.at_work = tuple(obstacles), None
        self.plan[:] = 0.0

    def give_up(self) -> None:
        """The body has fallen: what was being cleared is not, and there is no run-up."""
        self.at_work = None
        self.balk()

    def comes_within(self, arc: float, distance: float) -> bool:
        """Whether the next obstacle ahead of arc length ``arc`` is nearer than ``distance`` [m]."""
        while self.ahead is not None and self.ahead.arc_length < arc:
            self._pass()
        return self.ahead is not None and self.ahead.arc_length - arc < distance

    @property
    def ahead(self) -> ObstacleAhead | None:
        """The next obstacle, or the one that is being cleared."""
        if not self.obstacles:
            return None
        number = int(self.plan[NEXT])
        return self.obstacles[number] if number < len(self.obstacles) else None

    def has_little_room(self, arc: float) -> bool:
        """Whether the next obstacle ahead of arc length ``arc`` is nearer than the way in which a body that
        begins to run comes to its entry speed."""
        return self.comes_within(arc, _ROOM)

    @property
    def passed(self) -> float:
        """Arc length [m] to which it can go back: behind the obstacle that it has cleared last, or 0."""
        if self.plan[NEXT] == 0.0:
            return 0.0
        behind = self.obstacles[int(self.plan[NEXT]) - 1]
        return behind.far_side + _OFF_EDGE

    @property
    def clearing(self) -> bool:
        """Whether a skill is at work."""
        return self.at_work is not None

    @property
    def planned(self) -> float:
        """Speed [m/s] planned for this step; 0 where there is no run-up."""
        return self.plan.item(PLANNED)

    @property
    def skill(self) -> ClearingSkill:
        """The skill for the obstacle ahead."""
        assert self.ahead is not None
        return self.skill_for(self.ahead)

    def skill_for(self, obstacle: ObstacleAhead) -> ClearingSkill:
        """The skill for one of the obstacles."""
        skill = skill_for(self.skills, obstacle)
        assert skill is not None
        return skill

    def tick(
        self, arc: float, state: NDArray[np.float64], data: mujoco.MjData, grip: float = FRICTION
    ) -> TakeOff | ObstacleAhead | None:
        """After the run's tick: plan the run-up at each stance switch, start the skill at its mark, tick it.

        arc: length [m] of the path behind the body; state: the running controller's; grip: coefficient of
        friction of the ground. Returns a `TakeOff` when a skill begins, and the obstacle when it has been
        cleared.
        """
        obstacle, began = self.ahead, None
        if obstacle is None:
            return None
        if self.at_work is None:
            if obstacle.arc_length < arc:
                self._pass()
            elif obstacle.arc_length - arc < RUN_UP and state[controller.STEPS] != self.plan[STEPS_SEEN]:
                self.plan[STEPS_SEEN] = state[controller.STEPS]
                straight = distance_to(obstacle, *state[controller.COM][:2])
                self.plan[BEND] = max(obstacle.arc_length - arc - straight, 0.0)
                began = self._plan_step(replace(obstacle, friction=grip), state)
        if self.at_work is not None and self.skill.tick(obstacle, self.at_work, state, data):
            self.at_work = None
            self._pass()
            return obstacle
        return began

    def turning_point(self, arc: float, follower: PathFollower) -> float | None:
        """Arc length [m] to which a body that walks at ``arc`` of ``follower`` should go back so that its
        run-up is long enough, or as long as the obstacle behind and the last bend of the way allow; None: it
        need not, cannot, or has been back often enough."""
        if self.ahead is None or self.plan[RETURNS] >= _MOST_RETURNS:
            return None
        edge = self.ahead.arc_length
        to = max(edge - _ROOM - _SETTING_OFF, self.passed, follower.straight_before(edge))
        room = edge - to - _SETTING_OFF  # with less than `_ROOM` it tries what there is
        if not arc < edge or (edge - arc > room and self.plan[BALKED] == 0.0):
            return None
        return to if arc - to > _WORTH_IT else None

    def go_back(self) -> None:
        """It goes back for another run-up."""
        self.plan[RETURNS] += 1.0
        self.plan[BALKED] = 0.0

    def balk(self) -> None:
        """It breaks the run-up off."""
        self.plan[PLANNED:RETURNS] = 0.0
        self.plan[BALKED] = 1.0

    @property
    def balked(self) -> bool:
        """Whether it has broken the run-up off, and has not begun another."""
        return self.plan.item(BALKED) > 0.0

    def set_off(self, choice: Sequence[float], goes_well: bool) -> None:
        """It begins to run towards the obstacle ahead; arguments as of `vary`."""
        self.plan[[FARTHER, FASTER, REHEARSED, BALKED, STEPS_SEEN]] = *choice, goes_well, 0.0, 0.0

    def fell(self, state: NDArray[np.float64]) -> bool:
        """Whether a body has fallen whose skill is at work."""
        assert self.at_work is not None
        return self.skill.fell(self.at_work, state)

    def rehearses_within(self, arc: float, distance: float) -> bool:
        """Whether it comes to the run-up to an obstacle, which was not rehearsed yet, within ``distance`` [m]
        from arc length ``arc``; behind another obstacle when it is about to clear that."""
        number = int(self.plan[NEXT])
        if self.clearing or (self.rehearsed and self.obstacles[number].arc_length - arc < distance):
            number += 1
        elif self.rehearsed:
            return False
        return number < len(self.obstacles) and self.obstacles[number].arc_length - arc < RUN_UP + distance

    def to_rehearse(self, state: NDArray[np.float64]) -> bool:
        """Whether a step of a run-up has just begun, and the rest was not rehearsed yet."""
        if self.ahead is None or self.clearing or self.planned == 0.0 or self.rehearsed:
            return False
        return bool(state[controller.STEP_TIME] == 0.0)

    def vary(self, choice: Sequence[float], state: NDArray[np.float64], goes_well: bool) -> None:
        """Plan the step that has just begun anew, with a mark that is ``choice[0]`` [m] farther from the
        obstacle and an entry that is ``choice[1]`` [m/s] faster; ``goes_well``: as was seen in rehearsal."""
        assert self.ahead is not None
        self.plan[[FARTHER, FASTER, REHEARSED]] = *choice, goes_well
        speeds = self._plan_of(self.ahead, state).speeds
        if len(speeds):
            self.plan[PLANNED] = speeds[0]

    @property
    def rehearsed(self) -> bool:
        """Whether a choice has gone well in rehearsal."""
        return self.plan.item(REHEARSED) > 0.0

    def disturb(self) -> None:
        """Something may make it come otherwise than in rehearsal."""
        self.plan[REHEARSED] = 0.0

    def _plan_of(self, obstacle: ObstacleAhead, state: NDArray[np.float64]) -> ApproachPlan:
        farther, faster, bend = self.plan[[FARTHER, FASTER, BEND]]
        return plan_run_up(state, obstacle, self.skill, self._run, farther, faster, bend)

    def _plan_step(self, obstacle: ObstacleAhead, state: NDArray[np.float64]) -> TakeOff | None:
        """At a stance switch: the speed of the step that begins, or the start of the skill."""
        speeds = self._plan_of(obstacle, state).speeds
        if len(speeds):
            self.plan[PLANNED] = speeds[0]
            return None
        entry, mark = self.skill.approach(obstacle.size, obstacle.depth)
        self.at_work = self.skill.start(obstacle, state)
        self.plan[PLANNED] = entry
        fast = float(state[controller.STEP_SPEED]) - entry - self.plan[FASTER]
        return TakeOff(foot_distance(state, obstacle) - mark - self.plan[FARTHER], fast)

    def _pass(self) -> None:
        """Have the obstacle ahead behind it."""
        self.plan[NEXT] += 1.0
        self.plan[PLANNED:] = 0.0
