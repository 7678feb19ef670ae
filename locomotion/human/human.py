"""One simulated person that follows paths: physics, running controller and path tracking put together.

    human = Human(ground)
    human.reset(position=(x, y, z), yaw=0.0)
    human.follow(path, speed=3.5)                       # obstacles=... where the path crosses some
    while human.status == "running":
        human.tick()                                    # 10 ms

A person stands and walks by `locomotion.gaits.walk.controller`, and runs by
`locomotion.gaits.run.controller`: it runs where its path allows it and a run is worth it, slows down
(`locomotion.gaits.slow_down`) and walks elsewhere (`make_path`), and comes to a stand at its goal. On ground
that is too steep for that it goes on hands and feet, and after a fall it gets up, if it is told to
(`locomotion.recovery.on_all_fours`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from locomotion.avoidance.yielding import Course
from locomotion.body.hand_hold import let_go_both
from locomotion.body.person import CONTROL_DT, STEPS_PER_TICK
from locomotion.errors import LocomotionError
from locomotion.events import Arrived, Cleared, GotStuck, SetOff, TookOff
from locomotion.gaits.brake import BRAKING, BrakeSkill, load_brake_skill
from locomotion.gaits.limits import PERSON_RULES
from locomotion.gaits.run import controller
from locomotion.gaits.run.controller import observe
from locomotion.gaits.run.skill import RunSkill, load_run_skill
from locomotion.gaits.slow_down import SlowDownSkill, load_slow_down_skill
from locomotion.gaits.speed_up import SpeedUpSkill, load_speed_up_skill
from locomotion.gaits.walk.layout import WALK_HEADING
from locomotion.gaits.walk.skill import WalkSkill, load_walk_skill, rise_walking
from locomotion.ground.ground import Ground
from locomotion.human.falls import fall, tick_on_all_fours
from locomotion.human.gait_changes import GaitChanges
from locomotion.human.headway import ARRIVAL_DISTANCE, STRAYED, notice
from locomotion.human.intent import course_on_way, course_to_rest
from locomotion.human.on_feet import OnFeet
from locomotion.human.person import Person
from locomotion.human.state import CLEARING, MOVING, HumanState, Status
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.paths.tracking import make_path
from locomotion.recovery.on_all_fours import OnAllFours
from locomotion.rehearsal.deciding import Decider
from locomotion.rehearsal.lookahead import Lookahead
from locomotion.rehearsal.trials import REHEARSALS
from locomotion.skills.interface import ClearingSkill
from locomotion.skills.library import learned_skills
from locomotion.skills.obstacle_check import check_obstacles
from locomotion.skills.run_up import TakeOff
from surefoot.numeric import as_floats, is_finite, is_whole

__all__ = ["ARRIVAL_DISTANCE", "PERSON_RULES", "Human", "HumanState", "Status"]

_CHANGE = 0.01  # [m] by which the ground under a person at rest may change unnoticed


class Human(Person):
    """A person under physics. `tick` advances it by 10 ms.

    Attributes:
        status: "standing", "walking", "running", "jumping", "vaulting", "dropping", "leaping", "scrambling",
            "getting up", "fallen" (for good), "arrived", "lost" (strayed from its path or missed its goal) or
            "stuck".
            `held` tells whether it is simulated.
        events: list of `locomotion.events.Event` in order of time.
        decider: who chooses among variations of what it is about to do.
    """

    status: Status

    def __init__(
        self,
        ground: Ground | None = None,
        skill: RunSkill | None = None,
        clearing: Sequence[ClearingSkill] | None = None,
        walk: WalkSkill | None = None,
        slow_down: SlowDownSkill | None = None,
        rehearsals: int = REHEARSALS,
        gets_up: bool = False,
        speed_up: SpeedUpSkill | None = None,
        brake: BrakeSkill | None = None,
    ) -> None:
        """``ground``: None is the endless plane z = 0. ``skill``: how it runs; None loads the package's.
        ``clearing``: how it clears obstacles; None: by what comes with the package (`learned_skills`).
        ``walk``, ``slow_down``, ``brake``: how it walks, how it comes to it from a run, and how to a stand;
        None loads the package's.
        ``rehearsals``: how many variations of a take-off it tries out at most before it takes off
        (`locomotion.rehearsal.trials`); 0: none. ``gets_up``: whether it gets up after a fall and goes on;
        else a fall is the end. Raises `LocomotionError` for a ground or a number of rehearsals that is
        none."""
        if ground is not None and not isinstance(ground, Ground):
            raise LocomotionError(f"ground must be a Ground, or None for a plane, not {ground!r}")
        if not is_whole(rehearsals):
            raise LocomotionError(f"rehearsals must be a whole number of at least 0, not {rehearsals!r}")
        run = load_run_skill() if skill is None else skill
        on_feet = OnFeet(
            run,
            load_walk_skill() if walk is None else walk,
            load_slow_down_skill() if slow_down is None else slow_down,
            load_speed_up_skill() if speed_up is None else speed_up,
            load_brake_skill() if brake is None else brake,
        )
        super().__init__(ground, on_feet, learned_skills(run) if clearing is None else clearing)
        self.gets_up = gets_up
        self.decider = Decider()
        self._changes = GaitChanges(self, self.decider)
        self._lookahead = Lookahead(self, self._double, rehearsals) if rehearsals else None
        if self._lookahead is not None:
            self.decider.answer = self._lookahead.decide

    def restore_state(self, state: HumanState) -> None:
        """Continue from a state of a person on the same ground with the same skills. Raises
        `LocomotionError`, and changes nothing, for what is no such state."""
        if not isinstance(state, HumanState):
            raise LocomotionError(f"a person goes on from a HumanState, not from a {type(state).__name__}")
        self.become(state)
        self.decider.predicted.forget()

    # --- what it is told
    def reset(self, position: ArrayLike, yaw: float, speed: float = 0.0) -> None:
        """Put the person on the ground point ``position`` (3,) [m], facing ``yaw`` [rad]: standing, or
        running at ``speed`` [m/s]. It forgets its path; events and time go on.

        Raises `LocomotionError` for numbers that are not finite, a speed below 0, or a position more than
        0.5 m off the ground.
        """
        place = as_floats(position)
        if place is None or place.shape != (3,) or not np.isfinite(place).all() or not is_finite(yaw):
            raise LocomotionError(f"position and yaw must be finite (3,) and (), not {position} and {yaw}")
        if not (is_finite(speed) and speed >= 0.0):
            raise LocomotionError(f"speed must be a finite number >= 0 m/s, not {speed}")
        self.put(self.simulation.on_ground(place), yaw, speed)
        self.follower.forget()
        self.run_up.begin(())
        self.status = "standing" if speed == 0.0 else "running"

    def follow(
        self, path: ArrayLike, speed: float, obstacles: Sequence[ObstacleAhead] = (), hesitates: float = 0.0
    ) -> None:
        """Go along ``path`` (n, 3) [m, on the ground] at up to ``speed`` [m/s]; slower in bends, on slopes
        and before the end. ``obstacles``: what the path crosses, in order. ``hesitates``: [s] after which one
        that stands sets out.

        It walks and runs as the module's text says. Raises
        `LocomotionError` for a bad path or speed, a path that begins more than 2 m from the person, an
        obstacle with a mistake or that none of its skills clears, or a person that has fallen.
        """
        if self.status == "fallen":
            raise LocomotionError("the person has fallen for good; reset it")
        check_obstacles(obstacles, self.clearing)
        edges = [obstacle.arc_length for obstacle in obstacles]
        running = not self.on_feet.walks and not self.held
        pace = float(np.linalg.norm(self.velocity[:2]))
        table = make_path(path, speed, self.on_feet.limits, pace, edges, self.on_feet.walk_limits, running)
        start, here = table.table[0, :3], self.position
        gap = float(np.linalg.norm(start[:2] - here[:2]))
        if gap > STRAYED or abs(start[2] - here[2]) > STRAYED:
            raise LocomotionError(f"the path begins at {start.round(2)}, the person is at {here.round(2)}")
        if not self.on_feet.walks and not running:
            self.put(here, self.yaw, 0.0)
        stands = self.status not in MOVING and self.on_feet.walks
        self.follower.begin(table, self.ticks)
        self.follower.starts = self.ticks + round(hesitates / CONTROL_DT) if stands else 0
        self.run_up.begin(obstacles)
        let_go_both(self.data)
        self.fours.on_way = 1.0
        if not self.fours.active:
            self.status = "running" if running else "walking"
        elif self.status != "getting up":
            self.status = "scrambling"
        goal = (float(table.goal[0]), float(table.goal[1]), float(table.goal[2]))
        self.events.append(SetOff(self.time, self.point, goal, table.length))

    def arrive(self) -> None:
        """Take where it is for its goal."""
        goal = self.position if self.follower.path is None else self.follower.path.goal
        distance = float(np.linalg.norm(goal[:2] - self.position[:2]))
        self.end("arrived", Arrived(self.time, self.point, distance))

    def give_up(self, reason: str = "it and those around it wait for each other") -> None:
        """Be stuck where it is."""
        self.end("stuck", GotStuck(self.time, self.point, among_others=True, reason=reason))

    def stop(self) -> None:
        """Give up the path and come to a stand, as soon as it can without falling; what is being cleared is
        cleared first. A person that does not rehearse slows down and walks first."""
        self.fours.on_way = 0.0
        if self.status in MOVING and self.status != "getting up":
            self.status, self.ended_at = "standing", self.ticks
            if not self.run_up.clearing:
                self.run_up.begin(())

    def change_ground(self, ground: Ground) -> None:
        """Go on as it is on another ground. One at rest whose footing has changed by more than 1 cm is
        simulated again; one with no ground at all below it counts as fallen from now on, and so does one
        that is held though it did not come to rest from a run and whose footing has changed. Raises
        `LocomotionError` for one on the endless plane, and for what is no ground."""
        if self.ground is None or not isinstance(ground, Ground):
            here = "the endless plane" if self.ground is None else "a ground"
            raise LocomotionError(f"a person on {here} cannot go on on a {type(ground).__name__}")
        before, state = self.simulation.footing, self.save_state()
        self.simulation.stand_on(ground)
        self.fours = OnAllFours(self.model, self.index)
        self.restore_state(state)
        now = self.simulation.footing
        bottomless = bool(np.isnan(now).all() and not np.isnan(before).all())
        if bottomless or (self.held and not np.all(np.abs(now - before) <= _CHANGE)):
            if self.status != "fallen" and (bottomless or not self.on_feet.walks):
                fall(self, self.gets_up)
            self.ended_at = self.ticks
            self.on_feet.stir(self.control)

    def course(self) -> Course | None:
        """What it is about to do; None for one that is not on its way, clears an obstacle, or is going over
        from a walk to a run or back."""
        if self.follower.path is None or self.status not in ("walking", "running"):
            return None
        if self.on_feet.changes(self.control):
            return None
        return self.prospect()

    def prospect(self) -> Course | None:
        """What it will do on its feet, whether that can be changed or not; None for one that is not on
        them."""
        feet, follower, here, velocity = self.on_feet, self.follower, self.position, self.velocity
        if self.fours.active or self.status in CLEARING.values():
            return None
        if follower.path is None or self.status not in ("walking", "running"):
            limits = feet.walk_limits if feet.walks else feet.limits
            will_brake = feet.runs and self.decider.answer is not None
            if feet.brakes or will_brake:
                limits = replace(limits, deceleration=BRAKING)
            return course_to_rest(here, velocity, limits)
        walks = self.status == "walking"
        limits, facing = feet.walk_limits, float(feet.walk[WALK_HEADING])
        if not walks:
            limits, facing = feet.limits, math.atan2(velocity[1], velocity[0])
        aside = self.run_up.ahead is None
        course = course_on_way(follower, limits, here, velocity, walks, facing, aside)
        if feet.slowing == 0.0:
            return course
        return replace(course, slowest=0.0, braking=BRAKING if feet.brakes else feet.slowing)

    def give_way(self, pace: float, shift: NDArray[np.float64] | None) -> None:
        """Go at a share of the planned speed; with ``shift`` (k, 2) [m] change the path by it, one row for
        every 0.1 m from where it is."""
        self.follower.pace = pace
        if shift is not None:
            self.run_up.disturb()
            walk = self.on_feet.walk_limits if self.status == "walking" else None
            self.follower.shift(shift, self.on_feet.limits, walk)

    # --- time
    def tick(self) -> None:
        """Advance by 10 ms: track the path, control, physics, observe, notice what happened."""
        came_true = self.decider.predicted.comes_true(self)
        if not came_true:
            self._tick()
        if self._lookahead is not None:
            self._lookahead.go_on(came_true)

    def _tick(self) -> None:
        """A tick that was not foreseen."""
        self.ticks += 1
        if self.held:
            return
        if self.fours.active:
            tick_on_all_fours(self, self.gets_up)
            return
        state, data, feet, follower = self.control, self.data, self.on_feet, self.follower
        if follower.path is not None and self.status != "fallen":
            moving = self.status in MOVING and self.ticks >= follower.starts
            planned = self.run_up.planned
            feet.steer(follower, state, moving, planned, self.ticks, self.command)
        feet.tick(self.simulation.lookup, state, self.command, data)
        if feet.runs and self.status != "fallen":
            self._clear()
        if self.run_up.rehearsed and data.xfrc_applied.any():
            self.run_up.disturb()
        mujoco.mj_step(self.model, data, STEPS_PER_TICK)
        observe(self.index, self.model, data, state)
        feet.observe(self.index, state, self.command, data)
        if self.status == "fallen":
            return
        if self.run_up.clearing:
            state[controller.FALLEN] = float(self.run_up.fell(state))
        elif feet.rises:
            state[controller.FALLEN] = 0.0  # after a roll it begins to walk from a crouch
        if state[controller.FALLEN] > 0.0:
            fall(self, self.gets_up)
            return
        if follower.path is not None and self.status in MOVING:
            notice(self)
        if follower.path is not None and not self.run_up.clearing:
            if feet.walks:
                self._changes.run_if_due()
                self._changes.choose_step()
            else:
                self._changes.walk_if_due()
                self._changes.choose_take_off()

    def _clear(self) -> None:
        """After the run's tick: what has to be done for the obstacle ahead."""
        happened = self.run_up.tick(self.arc_length, self.control, self.data)
        obstacle = self.run_up.ahead
        if isinstance(happened, TakeOff):
            assert obstacle is not None
            kind, size = obstacle.affordance, obstacle.size
            self.status = CLEARING[kind]
            self.events.append(TookOff(self.time, self.point, kind, size, happened.early, happened.fast))
        elif happened is not None:
            ends = self.run_up.skill_for(happened).ends
            if self.status in MOVING:
                self.status = ends
            else:
                self.run_up.begin(())  # it was told to stop meanwhile
            if ends == "walking":
                rise_walking(self.on_feet.walk, self.control, self.yaw)
            self.events.append(Cleared(self.time, self.point, happened.affordance, happened.size))

    def _double(self) -> Human:
        """One that moves as it does, on the same ground, and does not rehearse."""
        feet = self.on_feet
        return Human(
            self.ground, feet.run_skill, self.clearing, feet.walk_skill, feet.slow_down_skill, 0,
            speed_up=feet.speed_up_skill, brake=feet.brake_skill,
        )  # fmt: skip
