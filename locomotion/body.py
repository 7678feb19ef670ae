"""One simulated person that follows paths: physics, running controller and path tracking put together.

    human = Human(ground)
    human.reset(position=(x, y, z), yaw=0.0)
    human.follow(path, speed=3.5)                       # obstacles=... where the path crosses some
    while human.status == "running":
        human.tick()                                    # 10 ms

A person stands and walks by `locomotion.walking`, and runs by `locomotion.controller`: it runs where its path
allows it and a run is worth it, slows down (`locomotion.slow_down`) and walks elsewhere (`make_path`), and
comes to a stand at its goal. On ground that is too steep for that it goes on hands and feet, and after a fall
it gets up, if it is told to (`locomotion.on_all_fours`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import TypeVar

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from locomotion import controller, path_tracking
from locomotion.clearing import ClearingSkill, skill_for
from locomotion.controller import observe, run_tick
from locomotion.errors import LocomotionError
from locomotion.events import (
    Arrived,
    Cleared,
    Event,
    Fell,
    GotStuck,
    GotUp,
    MissedGoal,
    SetOff,
    StrayedFromPath,
    TookOff,
)  # fmt: skip
from locomotion.gaits import PERSON_RULES, run_entry_speed, run_limits, walk_limits
from locomotion.giving_way import Course
from locomotion.ground import Ground
from locomotion.hand_hold import let_go_both
from locomotion.human_state import (
    CLEARING,
    MOVING,
    Gait,
    HumanState,
    Status,
    hash_of,
    restore_physics,
    save_physics,
)
from locomotion.library import learned_skills
from locomotion.obstacle_run import ObstacleRun, TakeOff
from locomotion.on_all_fours import SCRAMBLE_SPEED, OnAllFours, gentle_ahead, steer, too_steep_around
from locomotion.path_tracking import RUN_UP, PathTable, back_along, make_path, new_track, shifted, track
from locomotion.person import CONTROL_DT, STEPS_PER_TICK
from locomotion.person_course import course_on_path
from locomotion.rehearsal import (
    REHEARSALS,
    RUN_UPS,
    SETTING_OFF,
    SLOWINGS,
    clears,
    first_good,
    runs_on,
    walks_on,
)
from locomotion.route_smoothing import ObstacleAhead
from locomotion.simulated_person import SimulatedPerson
from locomotion.skill import RunSkill, load_run_skill, reset_running, run_on
from locomotion.slow_down import SlowDownSkill, can_walk_on, load_slow_down_skill, walk_on
from locomotion.speed_up import HASTE, SpeedUpSkill, is_fast_enough, load_speed_up_skill
from locomotion.walk_layout import (
    CAUGHT,
    CLOCK,
    PHASE,
    STANDING,
    WALK_HEADING,
    WALK_STANCE,
    WALK_STEPS,
    WALK_TICKS,
    WALKS,
    new_walk,
)
from locomotion.walk_skill import RISING, STEADYING_SPEED, WalkSkill, load_walk_skill, plant, rise_walking
from locomotion.walking import observe_walk, walk_tick

__all__ = ["ARRIVAL_DISTANCE", "PERSON_RULES", "Human", "HumanState", "Status"]

ARRIVAL_DISTANCE = 0.5
"""A person has arrived when its centre of mass is within this horizontal distance of the goal [m]."""
STRAYED = 2.0
"""[m] beside the path at which a person gives up following it."""
STUCK_TIME = 8.0
"""[s] without headway along the path after which a person counts as stuck."""
_WALK_ARRIVAL = 0.15  # [m] before the end of its path at which a walking person stops
_TURN_FIRST = 0.7  # [rad] off its way at which a walking person turns on the spot
_SLOW_ENOUGH = 0.5  # [m/s] at which it begins to turn so far
_SETTLING = 600  # ticks in which a person that has stopped walking comes to rest
_STILL = 0.03  # [m/s] of the centre of mass at rest
_HASTE = 1.3  # [m/s] that the speed asked for may exceed the last step's: more trips it in setting off
_CHANGE = 0.01  # [m] by which the ground under a person at rest may change unnoticed
_PATIENCE = 0.9  # of the time that it gives way does not count as being stuck
_LONGEST_DOWN = 12000  # ticks after which a body that has not got up stays down
_AT_WALL = 8.0  # [m] before an obstacle from which there is no run-up any more
_CLIMBS_BACK = 6.0  # [m] beside its path, where it has slid to, from which it climbs back
_SLOW_HEADWAY = 0.8  # of the time on hands and feet does not count as being stuck
_FALL_TICKS = 100  # a fallen body is simulated for this long, then held
_GAINS = np.array(
    [0.35, 1.2, 0.15, 0.45, 0.5, 0.05]
)  # hardly any sideways speed: the run was not learned with it
_WALK_GAINS = np.array([0.5, 0.6, 0.05, 0.3, 0.8, 0.25])

_T = TypeVar("_T")


class Human(SimulatedPerson):
    """A person under physics. `tick` advances it by 10 ms.

    Attributes:
        status: "standing", "walking", "running", "jumping", "vaulting", "dropping", "scrambling", "getting
            up", "fallen" (for good), "arrived", "lost" (strayed from its path or missed its goal) or "stuck".
            `held` tells whether it is simulated.
        events: list of `locomotion.events.Event` in order of time.
        model, data: the MuJoCo model (shared by all persons on the same ground) and this person's own data.
    """

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
    ) -> None:
        """``ground``: None is the endless plane z = 0. ``skill``: how it runs; None loads the package's.
        ``clearing``: how it clears obstacles; None: by what comes with the package (`learned_skills`).
        ``walk``, ``slow_down``: how it walks, and how it comes to it from a run; None loads the package's.
        ``rehearsals``: how many variations of a take-off it tries out at most before it takes off
        (`locomotion.rehearsal`); 0: none. ``gets_up``: whether it gets up after a fall and goes on; else a
        fall is the end."""
        super().__init__(ground)
        self.skill = load_run_skill() if skill is None else skill
        self.gait = load_walk_skill() if walk is None else walk
        slow_down = load_slow_down_skill() if slow_down is None else slow_down
        self._rehearsals, self.gets_up = rehearsals, gets_up
        self._speed_up = load_speed_up_skill() if speed_up is None else speed_up
        self._quick_run = self._speed_up.run_tables(self.skill)
        self._hurries = False  # it speeds up to its run
        self._slow_down = slow_down
        self._understudy: Human | None = None
        self._slow_run = slow_down.run_tables(self.skill)
        self._first_steps = slow_down.walk_tables(self.gait)
        self.limits = run_limits(self.skill)
        self._walk_limits = walk_limits(self.gait)
        self.events: list[Event] = []
        self._walk = new_walk()
        self._memory = new_track()
        self._command = np.zeros(4)
        self._path: PathTable | None = None
        self._interrupted: PathTable | None = None  # path to which it returns after having gone back along it
        self._back_to = 0.0  # [m] arc length there
        skills = learned_skills(self.skill) if clearing is None else clearing
        self._obstacle_run = ObstacleRun(skills, self.skill)
        self._fours = OnAllFours(self.model, self.index)
        self._slowing = 0.0  # [m/s^2] at which it slows down to a walk; 0: it does not
        self._ticks = 0
        self._ended_at = 0  # tick at which it fell or stopped
        self.status: Status = "standing"
        middle = np.zeros(3) if ground is None else 0.5 * (ground.low + ground.high)
        self._place(middle, 0.0, 0.0)

    # --- where it is
    @property
    def clearing(self) -> tuple[ClearingSkill, ...]:
        """How it clears obstacles."""
        return self._obstacle_run.skills

    @property
    def time(self) -> float:
        """Simulation time [s] since the person was made."""
        return self._ticks * CONTROL_DT

    @property
    def velocity(self) -> NDArray[np.float64]:
        """Velocity of the centre of mass, (3,) float64 [m/s]; zero while held."""
        return np.zeros(3) if self.held else self._control[controller.COM_VELOCITY].copy()

    @property
    def held(self) -> bool:
        """Whether the person is kept still: it stands at rest, did not come to rest, or lay for a second."""
        if self.status in MOVING:
            return False
        stopped = self._ticks - self._ended_at
        if self.status == "fallen":
            return stopped > _FALL_TICKS
        if self._fours.active:
            return stopped > _SETTLING and self._fours.borne
        at_rest = self._walk[PHASE] == STANDING and self._walk[CLOCK] == 0.0
        at_rest = at_rest and float(np.abs(self._control[controller.COM_VELOCITY]).max()) < _STILL
        return (self._walk[WALKS] > 0.0 and at_rest) or stopped > _SETTLING

    @property
    def gait_now(self) -> Gait:
        """How it moves now: "walk" (or stand), "run", "slow run" on its way from a run to a walk, or
        "scramble" (or getting up)."""
        if self._fours.active:
            return "scramble"
        if self._walk[WALKS] > 0.0:
            return "walk"
        return "slow run" if self._slowing > 0.0 else "run"

    @property
    def arc_length(self) -> float:
        """Length of the path behind the person [m]."""
        if self._interrupted is not None:
            return self._back_to + float(self._memory[path_tracking.REMAINING])
        return float(self._memory[path_tracking.ARC])

    @property
    def lateral_error(self) -> float:
        """Distance of the centre of mass to the left of the path [m]."""
        return float(self._memory[path_tracking.LATERAL])

    # --- what it is told
    def reset(self, position: ArrayLike, yaw: float, speed: float = 0.0) -> None:
        """Put the person on the ground point ``position`` (3,) [m], facing ``yaw`` [rad]: standing, or
        running at ``speed`` [m/s]. It forgets its path; events and time go on.

        Raises `LocomotionError` for numbers that are not finite, a speed below 0, or a position more than
        0.5 m off the ground.
        """
        place = np.asarray(position, dtype=np.float64)
        if place.shape != (3,) or not np.isfinite(place).all() or not np.isfinite(yaw):
            raise LocomotionError(f"position and yaw must be finite (3,) and (), not {position} and {yaw}")
        if not (np.isfinite(speed) and speed >= 0.0):
            raise LocomotionError(f"speed must be a finite number >= 0 m/s, not {speed}")
        self._place(place if self.ground is None else self._on_ground(place), yaw, speed)
        self._path = self._interrupted = None
        self._obstacle_run.begin(())
        self.status = "standing" if speed == 0.0 else "running"

    def follow(self, path: ArrayLike, speed: float, obstacles: Sequence[ObstacleAhead] = ()) -> None:
        """Go along ``path`` (n, 3) [m, on the ground] at up to ``speed`` [m/s]; slower in bends, on slopes
        and before the end. ``obstacles``: what the path crosses, in order.

        It walks and runs as the module's text says. Raises
        `LocomotionError` for a bad path or speed, a path that begins more than 2 m from the person, an
        obstacle that none of its skills clears, or a person that has fallen.
        """
        if self.status == "fallen":
            raise LocomotionError("the person has fallen for good; reset it")
        for obstacle in obstacles:
            if skill_for(self.clearing, obstacle) is None:
                wanted = f"{obstacle.affordance} {obstacle.height:.2f} m"
                offered = [f"{s.affordance} {s.heights[0]:g} to {s.heights[1]:g} m" for s in self.clearing]
                raise LocomotionError(f"no skill clears {wanted}; there are {offered or 'none'}")
        edges = [obstacle.arc_length for obstacle in obstacles]
        running = self._walk[WALKS] == 0.0 and not self.held
        pace = float(np.linalg.norm(self.velocity[:2]))
        table = make_path(path, speed, self.limits, pace, edges, self._walk_limits, running)
        start, here = table.table[0, :3], self.position
        gap = float(np.linalg.norm(start[:2] - here[:2]))
        if gap > STRAYED or abs(start[2] - here[2]) > STRAYED:
            raise LocomotionError(f"the path begins at {start.round(2)}, the person is at {here.round(2)}")
        if self._walk[WALKS] == 0.0 and not running:
            self._place(here, self.yaw, 0.0)
        self._path, self._interrupted = table, None
        self._obstacle_run.begin(obstacles)
        let_go_both(self.data)
        self._memory[:] = new_track()
        self._memory[path_tracking.HEADWAY_TICK] = self._ticks
        self._memory[path_tracking.REMAINING] = table.length
        self._fours.on_way = 1.0
        if not self._fours.active:
            self.status = "running" if running else "walking"
        elif self.status != "getting up":
            self.status = "scrambling"
        goal = (float(table.goal[0]), float(table.goal[1]), float(table.goal[2]))
        self.events.append(SetOff(self.time, self._point(), goal, table.length))

    def stop(self) -> None:
        """Give up the path and come to a stand; what is being cleared is cleared first."""
        self._fours.on_way = 0.0
        if self.status in MOVING and self.status != "getting up":
            self.status, self._ended_at = "standing", self._ticks
            if not self._obstacle_run.clearing:
                self._obstacle_run.begin(())

    def change_ground(self, ground: Ground) -> None:
        """Go on as it is on another ground. One at rest whose footing has changed by more than 1 cm is
        simulated again; one with no ground at all below it counts as fallen from now on, and so does one
        that is held though it did not come to rest from a run and whose footing has changed."""
        before, state = self._footing(), self.save_state()
        self._stand_on(ground)
        self._fours = OnAllFours(self.model, self.index)
        self.restore_state(state)
        now = self._footing()
        bottomless = bool(np.isnan(now).all() and not np.isnan(before).all())
        if bottomless or (self.held and not np.all(np.abs(now - before) <= _CHANGE)):
            if self.status != "fallen" and (bottomless or self._walk[WALKS] == 0.0):
                self._fall()
            self._ended_at = self._ticks
            self._control[controller.COM_VELOCITY] = 0.0, 0.0, -_STILL  # not at rest any more

    @property
    def pace(self) -> float:
        """Share of its planned speed at which it goes."""
        return float(self._memory[path_tracking.PACE])

    @property
    def path(self) -> NDArray[np.float64]:
        """(n, 3) float64 [m]: the path that it follows or followed last."""
        path = self._interrupted or self._path
        return np.empty((0, 3)) if path is None else path.table[:, :3].copy()

    def course(self) -> Course | None:
        """What it is about to do; None for one that is not on its way, or clears an obstacle."""
        if self._path is None or self.status not in ("walking", "running"):
            return None
        walks = self.status == "walking"
        limits, aside = self._walk_limits if walks else self.limits, self._obstacle_run.ahead is None
        speed = float(np.linalg.norm(self.velocity[:2]))
        return course_on_path(self._path, self._memory, limits, speed, walks, aside)

    def give_way(self, pace: float, shift: NDArray[np.float64] | None) -> None:
        """Go at a share of the planned speed; with ``shift`` (k, 2) [m] change the path by it, one row for
        every 0.1 m from where it is."""
        assert self._path is not None
        self._memory[path_tracking.PACE] = pace
        if shift is not None:
            self._obstacle_run.disturb()
            walk = self._walk_limits if self.status == "walking" else None
            self._path = shifted(self._path, self.arc_length, shift, self.limits, walk)

    # --- time
    def tick(self) -> None:
        """Advance by 10 ms: track the path, control, physics, observe, notice what happened."""
        self._ticks += 1
        if self.held:
            return
        if self._fours.active:
            self._tick_on_all_fours()
            return
        state, data = self._control, self.data
        walks = self._walk[WALKS] > 0.0
        if self._path is not None and self.status != "fallen":
            self._steer(self._path, walks)
        if walks:
            walk_tick(
                self._walk_tables(), self._lookup, self._walk, state, self._command, data.qpos, data.qvel,
                data.ctrl,
            )  # fmt: skip
        else:
            tables = self._quick_run if self._hurries else self.skill.tables
            tables = self._slow_run if self._slowing > 0.0 else tables
            run_tick(*tables, state, self._command, data.qpos, data.qvel, data.ctrl)
            if self.status != "fallen" and self.gait_now == "run":
                self._clear()
        if data.xfrc_applied.any():
            self._obstacle_run.disturb()
        mujoco.mj_step(self.model, data, STEPS_PER_TICK)
        observe(self.index, self.model, data, state)
        if self._hurries and (walks or is_fast_enough(state, float(self._command[1]))):
            self._hurries = False
        if self._walk[WALKS] > 0.0:
            observe_walk(self.index, data, self._walk)
        if self.status == "fallen":
            return
        if self._obstacle_run.clearing:
            state[controller.FALLEN] = float(self._obstacle_run.fell(state))
        elif self._walk[WALKS] > 0.0 and self._walk[WALK_TICKS] < RISING:
            state[controller.FALLEN] = 0.0  # after a roll it begins to walk from a crouch
        if state[controller.FALLEN] > 0.0:
            self._fall()
            return
        if self._path is not None and self.status in MOVING:
            self._notice()
        if self._path is not None and not self._obstacle_run.clearing:
            if self._walk[WALKS] > 0.0:
                self._run_if_due(self._path)
            else:
                self._walk_if_due(self._path)
                self._rehearse_take_off()

    def _fall(self) -> None:
        """It has lost its balance."""
        let_go_both(self.data)
        state, on_way = self._control, self.status in MOVING
        speed, slope = float(state[controller.SPEED]), float(self._memory[path_tracking.SLOPE_HERE])
        self._end("fallen", Fell(self.time, self._point(), speed, slope, self.arc_length))
        over_ground = self.ground is None or np.isfinite(self.ground.surface_below(self.com)[0][0])
        if self.gets_up and over_ground:
            self.status, self._slowing = "getting up", 0.0
            self._walk[:] = new_walk()
            self._obstacle_run.give_up()
            self._fours.fall(self.data)
            self._fours.fell_at, self._fours.on_way = float(self._ticks), float(on_way)

    def _tick_on_all_fours(self) -> None:
        """A tick on hands and feet, on the way to them after a fall, or from them to a stand."""
        fours, memory, on_way = self._fours, self._memory, self._fours.on_way > 0.0
        path = self._path if on_way and self.status in MOVING else None
        arc = float(memory[path_tracking.ARC])
        self._command[:] = fours.facing, 0.0, 0.0, 0.0
        if path is not None:
            x, y = self._control[controller.COM][:2]
            track(
                path.table, path.length, _WALK_GAINS, memory, x, y, SCRAMBLE_SPEED, self._ticks, self._command
            )
            waits = (self._ticks - memory[path_tracking.HEADWAY_TICK]) * CONTROL_DT / (1.0 - _SLOW_HEADWAY)
            steer(path, arc, self.com, waits, self._command)
        if self._ticks % 20 == 0:
            fours.gentle = float(gentle_ahead(self.ground, self.position, path, arc))
        fours.tick(self._lookup, self._command, self.data, fours.gentle > 0.0)
        mujoco.mj_step(self.model, self.data, STEPS_PER_TICK)
        observe(self.index, self.model, self.data, self._control)
        self._control[controller.FALLEN] = 0.0
        stands = fours.observe(self._lookup, self.data)
        if fours.fallen and self.status != "getting up":
            self._fall()
        elif stands:
            self._stand_up()
        elif fours.borne and fours.gentle == 0.0 and self.status == "getting up":
            self._got_up("scrambling")
        if self.status == "getting up":
            memory[path_tracking.HEADWAY_TICK] = self._ticks
            if self._ticks - fours.fell_at > _LONGEST_DOWN:
                self.status, self._ended_at = "fallen", self._ticks
                fours.leave()
        elif path is not None and self.status in MOVING:
            memory[path_tracking.HEADWAY_TICK] += _SLOW_HEADWAY
            self._notice()

    def _got_up(self, status: Status) -> None:
        self.status, self._ended_at = status if self._fours.on_way > 0.0 else "standing", self._ticks
        down = (self._ticks - self._fours.fell_at) * CONTROL_DT
        self.events.append(GotUp(self.time, self._point(), down))

    def _stand_up(self) -> None:
        """The walk takes over."""
        rise_walking(self._walk, self._control, self._fours.facing)
        observe_walk(self.index, self.data, self._walk)
        self._fours.leave()
        if self.status == "getting up":
            self._got_up("walking")
        elif self.status == "scrambling":
            self.status = "walking"
        at_wall = self.status == "walking" and self._obstacle_run.comes_within(self.arc_length, _AT_WALL)
        if at_wall and not (self._path is not None and self._go_back(self._path)):
            self._end("stuck", GotStuck(self.time, self._point()))

    def _walk_tables(self) -> NDArray[np.float64]:
        """The gains with which it walks now."""
        steps = int(self._walk[WALK_STEPS])
        if self._walk[CAUGHT] > 0.0 and steps < len(self._first_steps):
            return self._first_steps[steps]
        return self.gait.tables

    def _steer(self, path: PathTable, walks: bool) -> None:
        """Track the path: heading and speeds to ask of the controller."""
        state = self._control
        pace = float(self._memory[path_tracking.PACE])
        com = controller.COM.start
        track(
            path.table, path.length, _WALK_GAINS if walks else _GAINS, self._memory, state[com],
            state[com + 1], state[controller.SPEED], self._ticks, self._command,
        )  # fmt: skip
        if walks and self._walk[WALK_STEPS] < 0.0:
            self._command[:] = self._walk[WALK_HEADING], STEADYING_SPEED, 0.0, 0.0
            return
        if walks:
            off = self._command[0] - self._walk[WALK_HEADING]
            if self.status not in MOVING or abs(math.remainder(off, 2.0 * math.pi)) > _TURN_FIRST:
                self._command[1:3] = 0.0
                if np.hypot(*state[controller.COM_VELOCITY][:2]) > _SLOW_ENOUGH:
                    self._command[0] = self._walk[WALK_HEADING]
            self._command[1] = pace * min(self._command[1], self.gait.speed)
            return
        if self._slowing > 0.0:
            self._command[1:3] = state[controller.SPEED] - self._slowing * CONTROL_DT, 0.0
            return
        if state[controller.STEPS] >= 2.0:
            haste = HASTE if self._hurries else _HASTE
            self._command[1] = min(self._command[1], state[controller.STEP_SPEED] + haste)
        if self._obstacle_run.planned > 0.0:
            self._command[1] = self._obstacle_run.planned
        else:
            self._command[1] = max(pace * self._command[1], min(self._command[1], self.limits.speeds[0]))

    def _run_if_due(self, path: PathTable) -> None:
        """Go over from walking to running, just after a foot was put down."""
        walk = self._walk
        runs = path.runs(self._memory[path_tracking.ARC])
        if self.status not in MOVING or not runs or self._memory[path_tracking.PACE] < 1.0:
            return
        speed = run_entry_speed(walk, self._control, float(self._command[0]))
        if speed is None:
            return
        if self._go_back(path):
            return
        if not self._obstacle_run.comes_within(self.arc_length, RUN_UP):
            self.run(False, speed)
            return
        quickly, went = self._rehearse(SETTING_OFF, partial(Human.run, speed=speed), runs_on)
        if went > 0.0:
            self.run(quickly, speed)

    def _go_back(self, path: PathTable) -> bool:
        """Whether it turns round, for a longer run-up to the obstacle ahead."""
        arc = float(self._memory[path_tracking.ARC])
        back_to = None if self._interrupted is not None else self._obstacle_run.turning_point(arc)
        if back_to is None:
            return False
        self._obstacle_run.go_back()
        self._interrupted, self._back_to = path, back_to
        self._take(back_along(path, arc, back_to, self._walk_limits), 0.0)
        return True

    def run(self, quickly: bool, speed: float) -> None:
        """Go over from walking to running, from ``speed`` [m/s]."""
        run_on(self._control, self._walk[WALK_STANCE], self._walk[WALK_HEADING], speed)
        self._walk[WALKS] = 0.0
        self.status = "running"
        self._hurries = quickly

    def _take(self, path: PathTable, arc: float) -> None:
        """Go along another path from arc length ``arc`` [m] on."""
        pace = self._memory[path_tracking.PACE]
        self._path = path
        self._memory[:] = new_track()
        self._memory[[path_tracking.ARC, path_tracking.HEADWAY]] = arc
        self._memory[[path_tracking.HEADWAY_TICK, path_tracking.PACE]] = self._ticks, pace
        self._memory[path_tracking.REMAINING] = path.length - arc

    def _walk_if_due(self, path: PathTable) -> None:
        """Where the path is not run, slow down, and go over to walking just after a foot was put down."""
        state = self._control
        due = self.status not in MOVING or not path.runs(self._memory[path_tracking.ARC])
        due |= self._memory[path_tracking.PACE] == 0.0
        if due and self._slowing == 0.0:
            self.slow_down(self._rehearse(SLOWINGS, Human.slow_down, walks_on)[0])
        if self._slowing > 0.0 and can_walk_on(state):
            walk_on(self.data, self.index, self._first_steps[0], self.gait.speed, state, self._walk)
            self._slowing = 0.0
            self.status = "walking" if self.status in MOVING else self.status

    def slow_down(self, deceleration: float) -> None:
        """Begin to slow down from the run to a walk [m/s^2]."""
        self._slowing = deceleration

    def _clear(self) -> None:
        """After the run's tick: what has to be done for the obstacle ahead."""
        happened = self._obstacle_run.tick(self.arc_length, self._control, self.data)
        obstacle = self._obstacle_run.ahead
        if isinstance(happened, TakeOff):
            assert obstacle is not None
            kind, height = obstacle.affordance, obstacle.height
            self.status = CLEARING[kind]
            self.events.append(TookOff(self.time, self._point(), kind, height, happened.early, happened.fast))
        elif happened is not None:
            ends = self._obstacle_run.skill_for(happened).ends
            if self.status in MOVING:
                self.status = ends
            else:
                self._obstacle_run.begin(())  # it was told to stop meanwhile
            if ends == "walking":
                rise_walking(self._walk, self._control, self.yaw)
            self.events.append(Cleared(self.time, self._point(), happened.affordance, happened.height))

    # --- trying out
    @property
    def obstacle_ahead(self) -> ObstacleAhead | None:
        """The next obstacle on its path, or the one that it clears now."""
        return self._obstacle_run.ahead

    def _rehearse_take_off(self) -> None:
        """Just after one of the last steps of a run-up has begun: choose among its variations."""
        if self._rehearsals and self.gait_now == "run" and self._obstacle_run.to_rehearse(self._control):
            choice, went = self._rehearse(RUN_UPS, Human.vary_run_up, clears)
            self._obstacle_run.vary(choice, self._control, went > 0.0)

    def vary_run_up(self, choice: Sequence[float]) -> None:
        """Plan the step of the run-up that has just begun with a mark that is farther from the obstacle [m],
        and an entry that is faster [m/s]."""
        self._obstacle_run.vary(choice, self._control, True)

    def _rehearse(
        self, choices: Sequence[_T], choose: Callable[[Human, _T], None], goes_well: Callable[[Human], float]
    ) -> tuple[_T, float]:
        """The best of ``choices`` and how well it went, see `rehearsal.first_good`; without rehearsals the
        first is taken to go well."""
        if not self._rehearsals:
            return choices[0], 1.0
        if self._understudy is None or self._understudy.model is not self.model:
            self._understudy = Human(
                self.ground, self.skill, self.clearing, self.gait, self._slow_down, 0, speed_up=self._speed_up
            )
        return first_good(self, self._understudy, choices[: self._rehearsals], choose, goes_well)

    def _notice(self) -> None:
        """Arrived, lost, stuck?"""
        assert self._path is not None
        memory, com = self._memory, self._control[controller.COM]
        remaining = memory[path_tracking.REMAINING]
        if self._interrupted is not None and remaining < _WALK_ARRIVAL:
            path, self._interrupted = self._interrupted, None
            self._take(path, self._back_to)
            return
        if remaining < (_WALK_ARRIVAL if self.status in ("walking", "scrambling") else ARRIVAL_DISTANCE):
            goal = self._path.goal
            distance = math.hypot(goal[0] - com[0], goal[1] - com[1])
            if distance <= ARRIVAL_DISTANCE:
                self._end("arrived", Arrived(self.time, self._point(), distance))
            elif remaining <= 1e-9 and self.status != "scrambling":
                self._end("lost", MissedGoal(self.time, self._point(), distance))
        elif abs(memory[path_tracking.LATERAL]) > (_CLIMBS_BACK if self._fours.active else STRAYED):
            self._end("lost", StrayedFromPath(self.time, self._point(), abs(self.lateral_error)))
        elif memory[path_tracking.PACE] < 1.0:
            memory[path_tracking.HEADWAY_TICK] += _PATIENCE
        elif (self._ticks - memory[path_tracking.HEADWAY_TICK]) * CONTROL_DT > STUCK_TIME:
            self._end("stuck", GotStuck(self.time, self._point()))

    def _end(self, status: Status, event: Event) -> None:
        self.status = status
        self._ended_at = self._ticks
        self.events.append(event)

    # --- saving
    def save_state(self) -> HumanState:
        """Everything needed to continue from here."""
        return HumanState(
            save_physics(self.model, self.data), self._control.copy(), self._walk.copy(),
            np.concatenate([self._memory, self._command]), self._slowing, self._hurries,
            self._fours.save_state(), self._path, self._interrupted, self._back_to,
            self._obstacle_run.save_state(), self.status, self._ticks,
            self._ended_at, tuple(self.events),
        )  # fmt: skip

    def restore_state(self, state: HumanState) -> None:
        """Continue from a state of a person on the same ground with the same skill."""
        restore_physics(self.model, self.data, state.physics)
        self._control[:] = state.control
        self._walk[:] = state.walk
        self._memory[:] = state.tracking[: path_tracking.TRACK_SIZE]
        self._command[:] = state.tracking[path_tracking.TRACK_SIZE :]
        self._slowing, self._hurries = state.slowing, state.hurries
        self._path, self.status = state.path, state.status
        self._interrupted, self._back_to = state.interrupted, state.back_to
        self._fours.restore_state(state.on_all_fours)
        self._obstacle_run.restore_state(state.obstacle_run)
        self._ticks, self._ended_at = state.ticks, state.ended_at
        self.events[:] = state.events

    def state_hash(self) -> str:
        """Hex digest of the physical and mental state; equal for equal runs."""
        physics = save_physics(self.model, self.data)
        mood = np.array([self._slowing, self._hurries, self._back_to])
        parts = [physics, self._control, self._walk, self._memory, self._command, mood]
        parts.append(self._fours.save_state())
        return hash_of(self.status, [*parts, *self._obstacle_run.save_state().arrays])

    def _place(self, position: NDArray[np.float64], yaw: float, speed: float) -> None:
        self._fours.leave()
        if speed == 0.0 and too_steep_around(self.ground, position):
            self._fours.crouch(self._lookup, self.data, position, yaw)
            self._control[:] = controller.new_state()
            observe(self.index, self.model, self.data, self._control, fresh=True)
            self._walk[:] = new_walk(yaw)
        elif speed > 0.0:
            reset_running(self.skill, self.model, self.data, self.index, self._control, position, yaw, speed)
            self._walk[WALKS] = 0.0
        else:
            plant(self.model, self.data, self.index, self._lookup, self._control, self._walk, position, yaw)
        self._command[:] = yaw, speed, 0.0, 0.0
        self._slowing = 0.0
        self._memory[:] = new_track()
