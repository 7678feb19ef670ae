"""One simulated person that follows paths: physics, gaits and path tracking together.

    human = Human(ground)
    human.reset(position=(x, y, z), yaw=0.0)
    human.follow(path, speed=3.5)                       # obstacles=... if the path crosses some
    while human.status == "running":
        human.tick()                                    # 10 ms

A person stands and walks with `locomotion.gaits.walk.controller`, and runs with
`locomotion.gaits.run.controller`. It runs where its path allows it and running is worth it; elsewhere it
slows down (`locomotion.gaits.slow_down`) and walks (`make_path`); it stops at its goal. On ground too steep
to walk it goes on hands and feet, and after a fall it can get up (`locomotion.recovery.on_all_fours`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Literal, NamedTuple

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from locomotion.avoidance.yielding import Course
from locomotion.body.hand_hold import let_go_both
from locomotion.body.person import CONTROL_DT, STEPS_PER_TICK
from locomotion.body_events import Arrived, Cleared, GotStuck, SetOff, TookOff
from locomotion.errors import LocomotionError
from locomotion.gaits.brake import BRAKING, BrakeSkill, load_brake_skill
from locomotion.gaits.limits import PERSON_RULES
from locomotion.gaits.policy.skill import PolicySkill
from locomotion.gaits.residual.skill import ResidualSkill, load_brake_residual, load_landing_residual
from locomotion.gaits.run import controller
from locomotion.gaits.run.controller import observe
from locomotion.gaits.run.skill import RunSkill, load_run_skill
from locomotion.gaits.slow_down import SlowDownSkill, load_slow_down_skill
from locomotion.gaits.speed_up import SpeedUpSkill, load_speed_up_skill
from locomotion.gaits.walk.layout import WALK_HEADING
from locomotion.gaits.walk.skill import WalkSkill, load_walk_skill, rise_walking
from locomotion.ground.ground import Ground
from locomotion.human.arrived_or_stuck import ARRIVAL_DISTANCE, STRAYED, notice
from locomotion.human.balance import loses_balance
from locomotion.human.composition import Composition, checked_bravery
from locomotion.human.falls import fall, tick_on_all_fours
from locomotion.human.gait_changes import GaitChanges
from locomotion.human.intent import course_on_way, course_to_rest
from locomotion.human.learned_walk import RUN_STOPS
from locomotion.human.on_feet import OnFeet
from locomotion.human.person import Person
from locomotion.human.state import CLEARING, MOVING, HumanState, Status
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.paths.table import PathTable, TrackingLimits
from locomotion.paths.tracking import make_path
from locomotion.recovery.on_all_fours import OnAllFours
from locomotion.rehearsal.choices import REHEARSALS
from locomotion.rehearsal.deciding import Decider
from locomotion.rehearsal.lookahead import PER_TICK, Lookahead
from locomotion.skills.interface import ClearingSkill
from locomotion.skills.library import learned_skills
from locomotion.skills.obstacle_check import check_obstacles
from locomotion.skills.run_up import TakeOff
from surefoot.numeric import as_point, is_finite, is_whole

__all__ = ["ARRIVAL_DISTANCE", "PERSON_RULES", "BetweenGaits", "Human", "HumanState", "Status"]

_SWAYS = 100  # ticks behind a push before it may rest: it is still for a moment as it sways back
_CHANGE = 0.01  # [m] largest change of the ground under a person at rest that needs no new simulation


class BetweenGaits(NamedTuple):
    """How a person comes from a run to a walk, from a walk to a run, and from a run to a stand; None: as the
    package's skills say. ``residual``: the network that corrects it while it brakes (True: the package's), or
    None: none does; ``landing``: the same for what follows a landing behind an obstacle."""

    slow_down: SlowDownSkill | None = None
    speed_up: SpeedUpSkill | None = None
    brake: BrakeSkill | None = None
    residual: ResidualSkill | Literal[True] | None = True
    landing: ResidualSkill | Literal[True] | None = True


class Human(Person):
    """A simulated person. `tick` advances it by 10 ms.

    Attributes:
        status: "standing", "walking", "running", "jumping", "vaulting", "dropping", "leaping", "scrambling",
            "getting up", "fallen" (for good), "arrived", "lost" (strayed from its path or missed its goal) or
            "stuck". `held` says whether it is simulated.
        events: list of `locomotion.body_events.Event` in order of time.
        decider: chooses among variations of the next action.
        composition: decides by the odds of its skills.
    """

    status: Status

    def __init__(
        self,
        ground: Ground | None = None,
        skill: RunSkill | None = None,
        clearing: Sequence[ClearingSkill] | None = None,
        walk: WalkSkill | None = None,
        between: BetweenGaits | None = None,
        rehearsals: int = REHEARSALS,
        gets_up: bool = False,
        policy: PolicySkill | None = None,
    ) -> None:
        """``ground``: None is the endless plane z = 0. ``skill``, ``walk``: how it runs and walks; None loads
        the built-in skill. ``between``: how it changes from one gait to another. ``clearing``:
        skills for obstacles; None loads the built-in ones (`learned_skills`). ``rehearsals``: most
        variations of a take-off to try before it (`locomotion.rehearsal.trials`); 0 turns rehearsing off.
        ``gets_up``: whether it gets up after a fall and continues, or stays down. ``policy``: networks that
        walk where the ground is level (`locomotion.human.learned_walk`); None: all walking is planned.

        Raises `LocomotionError` if ``ground`` is not a ground, or ``rehearsals`` not a whole number of at
        least 0.
        """
        if ground is not None and not isinstance(ground, Ground):
            raise LocomotionError(f"ground must be a Ground, or None for a plane, not {ground!r}")
        if not is_whole(rehearsals):
            raise LocomotionError(f"rehearsals must be a whole number of at least 0, not {rehearsals!r}")
        run = load_run_skill() if skill is None else skill
        between = between or BetweenGaits()
        on_feet = OnFeet(
            run,
            load_walk_skill() if walk is None else walk,
            between.slow_down or load_slow_down_skill(),
            between.speed_up or load_speed_up_skill(),
            between.brake or load_brake_skill(),
            policy,
            load_brake_residual() if between.residual is True else between.residual,
            load_landing_residual() if between.landing is True else between.landing,
        )
        super().__init__(ground, on_feet, learned_skills(run) if clearing is None else clearing)
        self.gets_up = gets_up
        self.decider = Decider()
        self.composition = Composition(self)
        self._changes = GaitChanges(self, self.decider, self.composition)
        self._rehearsals = rehearsals
        self._lookahead = None
        if rehearsals:
            self.composition.get_ready()
            self._lookahead = Lookahead(self, self._double, rehearsals)
            self.decider.answer = self._lookahead.decide

    def restore_state(self, state: HumanState) -> None:
        """Continue from a state of a person on the same ground with the same skills. Raises
        `LocomotionError`, and changes nothing, if ``state`` is no such state."""
        if not isinstance(state, HumanState):
            raise LocomotionError(f"a person goes on from a HumanState, not from a {type(state).__name__}")
        self.become(state)
        self.decider.predicted.forget()
        if self._lookahead is not None:
            self._lookahead.recall(state)

    def save_state(self) -> HumanState:
        """Everything needed to continue from here."""
        state = super().save_state()
        return state if self._lookahead is None else state._replace(foresight=self._lookahead.memory(state))

    def get_ready(self) -> None:
        """Do what else would be done when it first has to look ahead, or comes to an obstacle."""
        if self._lookahead is not None:
            self._lookahead.get_ready()
        for skill in self.clearing:
            skill.approach(skill.heights[0])

    @property
    def waits(self) -> bool:
        """Whether a tick rehearses all that it has to decide, however long that takes. Else it does without
        what `look_ahead` has not rehearsed before, which its owner then calls after each tick. Can be set."""
        return self._lookahead is None or self._lookahead.waits

    @waits.setter
    def waits(self, waits: bool) -> None:
        if self._lookahead is not None:
            self.decider.waits = waits
            self._lookahead = Lookahead(self, self._double, self._rehearsals, waits)
            self.decider.answer = self._lookahead.decide

    @property
    def bravery(self) -> float | None:
        """Without rehearsals: from 0 to 1, it takes off where its odds are at least 1 less this, and turns
        away elsewhere (`locomotion.human.composition`). None: it does not ask for its odds. Can be set;
        raises `LocomotionError` for another value."""
        return self.composition.bravery

    @bravery.setter
    def bravery(self, bravery: float | None) -> None:
        self.composition.bravery = checked_bravery(bravery)

    @property
    def by_odds(self) -> bool:
        """Whether it decides by the odds of its skills: it has a `bravery`, and does not rehearse."""
        return self.bravery is not None and self._lookahead is None

    def wear(self, traits: NDArray[np.float64]) -> None:
        """Differ from others on the next ways that it goes as learned from end to end: ``traits`` (7,) are a
        row of `locomotion.body.traits`; size and phase do not show."""
        if self.on_feet.learned is not None:
            self.on_feet.learned.wear(traits)

    # --- what it is told
    def reset(self, position: ArrayLike, yaw: float, speed: float = 0.0) -> None:
        """Put the person on the ground point ``position`` (3,) [m], facing ``yaw`` [rad]: standing, or
        running at ``speed`` [m/s]. Its path is dropped; events and time continue.

        Raises `LocomotionError` for numbers that are not finite, a speed below 0, or a position more than 0.5
        m off the ground.
        """
        place = as_point(position)
        if place is None or not is_finite(yaw):
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
        """Follow ``path`` (n, 3) [m, on the ground] at up to ``speed`` [m/s]; slower in bends, on slopes and
        before the end. ``obstacles``: those that the path crosses, in order. ``hesitates``: [s] that a
        standing person waits before it starts.

        Raises `LocomotionError` for an invalid path, speed or obstacle, a path that begins more than 2 m from
        the person, an obstacle that none of its skills clears, or a person that has fallen.
        """
        if self.status == "fallen":
            raise LocomotionError("the person has fallen for good; reset it")
        check_obstacles(obstacles, self.clearing)
        edges = [obstacle.arc_length for obstacle in obstacles]
        running = (not self.on_feet.walks or self.on_feet.runs_as_learned) and not self.held
        pace = float(np.linalg.norm(self.velocity[:2]))
        table, as_learned = self._table(path, speed, pace, edges, running)
        start, here = table.table[0, :3], self.position
        gap = float(np.linalg.norm(start[:2] - here[:2]))
        if gap > STRAYED or abs(start[2] - here[2]) > STRAYED:
            raise LocomotionError(f"the path begins at {start.round(2)}, the person is at {here.round(2)}")
        if not self.on_feet.walks and not running:
            self.put(here, self.yaw, 0.0)
        stands = self.status not in MOVING and self.on_feet.walks
        if self.on_feet.learned is not None:
            self.on_feet.learned.show_style(as_learned)
        self.data.qpos[:] = self.pose()  # it sets off from how it has been seen to stand
        self.follower.begin(table, self.ticks, self.on_feet.slowing > 0.0)
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

    def _table(
        self, path: ArrayLike, speed: float, pace: float, edges: Sequence[float], running: bool
    ) -> tuple[PathTable, bool]:
        """The ``path`` as it will follow it, see `make_path`, and whether that is as learned on all of it."""
        feet = self.on_feet

        def make(limits: TrackingLimits) -> PathTable:
            return make_path(path, speed, limits, pace, edges, feet.walk_limits, running)

        if feet.learned is None or edges or not feet.walks:
            return make(feet.limits), False
        table = make(feet.learned_limits)
        if feet.learned.holds_along(table, self.simulation):
            return table, True
        return make(feet.mixed_limits), False

    def arrive(self) -> None:
        """Take its present position as its goal."""
        goal = self.position if self.follower.path is None else self.follower.path.goal
        distance = float(np.linalg.norm(goal[:2] - self.position[:2]))
        self.end("arrived", Arrived(self.time, self.point, distance))

    def give_up(self, reason: str = "it and those around it wait for each other") -> None:
        """Mark it as stuck where it is."""
        self.end("stuck", GotStuck(self.time, self.point, among_others=True, reason=reason))

    def stop(self) -> None:
        """Give up the path and stop as soon as it can without falling; an obstacle in progress is cleared
        first. A person without rehearsals slows down and walks first."""
        self.fours.on_way = 0.0
        if self.status in MOVING and self.status != "getting up":
            self.status, self.ended_at = "standing", self.ticks
            if not self.run_up.clearing:
                self.run_up.begin(())

    def push(self, force: ArrayLike, seconds: float = 0.1) -> None:
        """Push it at the waist with ``force`` (3,) [N] for so many ``seconds``, in whole ticks, instead of
        what pushes it now. One that is held is simulated again.

        Raises `LocomotionError` for a force that is not three finite numbers, and for less than a tick.
        """
        newtons = as_point(force)
        if newtons is None:
            raise LocomotionError(f"force must be three finite numbers [N], not {force!r}")
        if not (is_finite(seconds) and round(seconds / CONTROL_DT) >= 1):
            raise LocomotionError(f"a push lasts {CONTROL_DT:g} s or more, not {seconds!r}")
        if self.held:
            self.data.qpos[:] = self.pose()
            self.ended_at = self.ticks
            self.on_feet.stir(self.control)
        self.data.xfrc_applied[self.index.bodies["waist"], :3] = newtons
        self.pushed_until = self.ticks + round(seconds / CONTROL_DT)

    def change_ground(self, ground: Ground) -> None:
        """Continue on another ground. A person at rest is simulated again if its footing has changed by more
        than 1 cm. It counts as fallen if there is no ground below it, or if it is held without having come
        to rest and its footing has changed.

        Raises `LocomotionError` for a person on the endless plane, or if ``ground`` is not a ground.
        """
        if self.ground is None or not isinstance(ground, Ground):
            here = "the endless plane" if self.ground is None else "a ground"
            raise LocomotionError(f"a person on {here} cannot go on on a {type(ground).__name__}")
        before, state = self.simulation.footing, self.save_state()
        self.simulation.stand_on(ground)
        self.fours = OnAllFours(self.model, self.index)
        self.restore_state(state._replace(foresight=(0, 0)))
        now = self.simulation.footing
        bottomless = bool(np.isnan(now).all() and not np.isnan(before).all())
        if bottomless or (self.held and not np.all(np.abs(now - before) <= _CHANGE)):
            if self.status != "fallen" and (bottomless or not self.on_feet.walks):
                fall(self, self.gets_up)
            self.ended_at = self.ticks
            self.on_feet.stir(self.control)

    def course(self) -> Course | None:
        """What it is about to do; None if it is not on its way, is clearing an obstacle, or is changing
        between walking and running."""
        if self.follower.path is None or self.status not in ("walking", "running"):
            return None
        if self.on_feet.changes(self.control):
            return None
        return self.prospect()

    def prospect(self) -> Course | None:
        """What it will do on its feet, whether or not that can be changed; None if it is not on its feet."""
        feet, follower, here, velocity = self.on_feet, self.follower, self.position, self.velocity
        if self.fours.active or self.status in CLEARING.values():
            return None
        if follower.path is None or self.status not in ("walking", "running"):
            limits = feet.walks_within if feet.walks else feet.limits
            if feet.runs_as_learned:
                limits = replace(feet.limits, deceleration=RUN_STOPS)
            will_brake = feet.runs and self.decider.answer is not None
            if feet.brakes or will_brake:
                limits = replace(limits, deceleration=BRAKING)
            return course_to_rest(here, velocity, limits)
        walks = self.status == "walking"
        limits, facing = feet.walks_within, float(feet.walk[WALK_HEADING])
        if not walks:
            limits, facing = feet.limits, math.atan2(velocity[1], velocity[0])
        aside = self.run_up.ahead is None
        course = course_on_way(follower, limits, here, velocity, walks, facing, aside, feet.turns_first)
        if feet.slowing == 0.0:
            return course
        return replace(course, slowest=0.0, braking=BRAKING if feet.brakes else feet.slowing)

    def give_way(self, pace: float, shift: NDArray[np.float64] | None) -> None:
        """Move at a share of the planned speed; with ``shift`` (k, 2) [m] also shift the path ahead, one row
        for every 0.1 m."""
        self.follower.pace = pace
        if shift is not None:
            self.run_up.disturb()
            walk = self.on_feet.walk_limits if self.status == "walking" else None
            self.follower.shift(shift, self.on_feet.limits, walk)

    # --- time
    def tick(self, since_foresees: bool = False) -> None:
        """Advance by 10 ms: track the path, control, step the physics, observe, report events.
        ``since_foresees``: nothing can have happened to it since it was asked what it `foresees`."""
        lookahead, sure = self._lookahead, False
        if lookahead is not None:
            lookahead.catch_up()
            sure = since_foresees and lookahead.is_as_predicted
        came_true = self.decider.predicted.comes_true(self, sure)
        if not came_true:
            if lookahead is not None:
                lookahead.be_surprised()
            self._tick()
        if self.pushed_until:
            self.on_feet.catch(self.simulation, self.ticks < self.pushed_until)
            if self.ticks == self.pushed_until:
                self.data.xfrc_applied[self.index.bodies["waist"]] = 0.0
            if self.ticks >= self.pushed_until + _SWAYS:
                self.pushed_until = 0
        if lookahead is not None:
            lookahead.look_back()
            if lookahead.waits:
                lookahead.go_on(PER_TICK)

    @property
    def foresees(self) -> int | None:
        """How many ticks ahead what it rehearses is; None if it has nothing to rehearse."""
        return None if self._lookahead is None else self._lookahead.foresees()

    @property
    def needs(self) -> int:
        """Ticks that the answer to what it rehearses takes at least; 0 if it rehearses nothing now."""
        return 0 if self._lookahead is None else self._lookahead.needs

    def look_ahead(self, ticks: int) -> int:
        """Rehearse what it will have to decide, for up to ``ticks`` of its double; return how many it
        took."""
        return 0 if self._lookahead is None else self._lookahead.go_on(ticks)

    def _tick(self) -> None:
        """A tick that was not predicted."""
        self.ticks += 1
        if self.held:
            self.on_feet.landing.forget()
            return
        if self.fours.active:
            tick_on_all_fours(self, self.gets_up)
            return
        state, data, feet, follower = self.control, self.data, self.on_feet, self.follower
        if follower.path is not None and self.status != "fallen":
            moving = self.status in MOVING and self.ticks >= follower.starts
            planned = self.run_up.planned
            feet.steer(follower, state, moving, planned, self.ticks, self.command)
            free = self.run_up.ahead is None
            feet.choose_walk(follower, moving, self.simulation, self.command, free)
        elif self.status == "standing" and not self.pushed_until:
            feet.choose_walk(follower, False, self.simulation, self.command, True)
        feet.tick(self.simulation, self.command)
        if self.status != "fallen":
            if feet.runs:
                self._clear()
            feet.landing.tick(self.run_up, not feet.brakes, state, feet.walk, data)
        if self.run_up.rehearsed and data.xfrc_applied.any():
            self.run_up.disturb()
        mujoco.mj_step(self.model, data, STEPS_PER_TICK)
        observe(self.index, self.model, data, state)
        feet.observe(self.index, state, self.command, data)
        if feet.walks_as_learned and self.status in ("walking", "running"):
            self.status = "running" if feet.runs_as_learned else "walking"
        if self.status == "fallen":
            return
        if self.run_up.clearing:
            state[controller.FALLEN] = float(self.run_up.fell(state))
        elif feet.rises:
            state[controller.FALLEN] = 0.0  # after a roll it starts to walk from a crouch
        elif self.gets_up and loses_balance(self.index, data, self.observed):
            state[controller.FALLEN] = 1.0
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
        """After a running tick: act on the obstacle ahead."""
        happened = self.run_up.tick(self.arc_length, self.control, self.data, self.simulation.grip)
        obstacle = self.run_up.ahead
        if isinstance(happened, TakeOff):
            assert obstacle is not None
            self.on_feet.landing.takes_off(self.run_up.skill)
            kind, size = obstacle.affordance, obstacle.size
            self.status = CLEARING[kind]
            self.events.append(TookOff(self.time, self.point, kind, size, happened.early, happened.fast))
        elif happened is not None:
            self.on_feet.landing.cleared()
            ends = self.run_up.skill_for(happened).ends
            if self.status in MOVING:
                self.status = ends
            else:
                self.run_up.begin(())  # it was told to stop in the meantime
            if ends == "walking":
                rise_walking(self.on_feet.walk, self.observed, self.yaw)
            self.events.append(Cleared(self.time, self.point, happened.affordance, happened.size))

    def _double(self) -> Human:
        """A copy with the same skills on the same ground that does not rehearse."""
        feet = self.on_feet
        double = Human(
            self.ground, feet.run_skill, self.clearing, feet.walk_skill,
            BetweenGaits(feet.slow_down_skill, feet.speed_up_skill, feet.brake_skill, feet.residual.skill,
                         feet.landing.skill), 0,
            policy=None if feet.learned is None else feet.learned.skill,
        )  # fmt: skip
        double.on_feet.landing.behind = feet.landing.behind
        double.decider.waits = self.decider.waits
        double.composition.preconditions = self.composition.preconditions
        return double
