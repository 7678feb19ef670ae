"""A person on its feet: walking, running and changing between them.

    feet = OnFeet(run, walk, slow_down, speed_up)
    feet.steer(way, state, moving, planned, tick, command)
    feet.choose_walk(way, moving, simulation, command)
    feet.tick(simulation, command)
    mujoco.mj_step(model, data, STEPS_PER_TICK)
    feet.observe(index, state, command, data)

``state`` is the running controller's memory, and what is observed, also while the person walks (fields:
`locomotion.gaits.run.layout`).
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.avoidance.yielding import TURNING_SPEED
from locomotion.body.person import CONTROL_DT, PersonIndex
from locomotion.gaits.brake import SLOWEST, BrakeSkill
from locomotion.gaits.limits import run_limits, walk_limits
from locomotion.gaits.policy.law import BRAKING
from locomotion.gaits.policy.skill import PolicySkill
from locomotion.gaits.residual.skill import ResidualSkill
from locomotion.gaits.run import controller
from locomotion.gaits.run.controller import run_tick
from locomotion.gaits.run.skill import RunSkill, run_on
from locomotion.gaits.slow_down import SlowDownSkill, can_walk_on, walk_on
from locomotion.gaits.speed_up import HASTE, SpeedUpSkill, is_fast_enough
from locomotion.gaits.walk.controller import observe_walk, walk_tick
from locomotion.gaits.walk.layout import (
    CAUGHT,
    CLOCK,
    DOUBLE,
    LONGER,
    PHASE,
    SINGLE,
    STANDING,
    STRAINS,
    SUDDEN,
    UNEVEN,
    WALK_HEADING,
    WALK_SPEED,
    WALK_STANCE,
    WALK_STEPS,
    WALK_TICKS,
    WALK_TURN_RATE,
    WALKS,
    new_walk,
)
from locomotion.gaits.walk.skill import RISING, STEADYING_SPEED, WalkSkill
from locomotion.gaits.walk.steps import TURN_TIME
from locomotion.gaits.walk.strain import FORESEEN, STRAINED, USUAL, note_strain, slope_ahead
from locomotion.ground.ground import FRICTION
from locomotion.human.intent import TURN_FIRST
from locomotion.human.landing import Landing
from locomotion.human.learned_tick import MOST_TURN, SIDEWAYS
from locomotion.human.learned_walk import LearnedWalk
from locomotion.human.residual import Residual
from locomotion.human.simulation import Simulation
from locomotion.paths.command import HEADING_ASKED, SIDEWAYS_ASKED, SPEED_ASKED
from locomotion.paths.follower import PathFollower
from locomotion.paths.table import TrackingLimits
from locomotion.skills.drop_roll.slippery import load_slippery_roll

__all__ = ["RUN_GAINS", "OnFeet"]

RUN_GAINS = np.array([0.35, 1.2, 0.15, 0.45, 0.5, 0.05])
"""Gains of `tracking.track`; hardly any sideways speed, which the run was not trained with."""
_WALK_GAINS = np.array([0.5, 0.6, 0.05, 0.3, 0.8, 0.25])
_HASTE = 1.3  # [m/s] asked for above the last step's speed at most, lest it trip
_FAST, _FAST_HASTE = 3.7, 0.8  # [m/s] from the first speed on, only this much above
_CHANGED = 4.0  # steps after which a change of gait is complete
_CAME_UP = -1.0  # the step of one that came up from a crouch where it may go on as learned
_HELD_UP = 12.0  # steps after which a pushed person that has braked need not come to rest
_GENTLY, _RESTS = 1.7, 0.9  # [m/s^2] of slowing down as learned on its way, and [m] walked at its end
_RUNS_WITHIN = 0.4  # [rad] off its way with which a run begins
_TURN_ROUND, _TURNING, _MOVES = 2.4, 0.5, 0.4
# [rad] off its way up to which the learned walk turns on its way, [m/s] of it meanwhile and at least
_NOTHING = np.zeros(0)
_UPRIGHT = 0.8  # [m] of the centre of mass over the lower foot of one that stands
_CALM, _THROWN = 0.1, 0.12  # [m/s] of one that may stand as learned, and that has been thrown off that
_BACKWARDS = -0.6  # cosine of the angle off its heading of one that is thrown backwards
_STILL = 0.03  # [m/s] of the centre of mass at rest


class _Made(NamedTuple):
    """What is worked out from skills: tables of the controllers, and limits of paths."""

    quick_run: tuple[NDArray, ...]
    slow_run: tuple[NDArray, ...]
    braking_run: tuple[NDArray, ...]
    first_steps: tuple[NDArray, ...]
    braking_steps: tuple[NDArray, ...]
    limits: TrackingLimits
    learned_limits: TrackingLimits
    mixed_limits: TrackingLimits
    walk_limits: TrackingLimits
    learned_walk_limits: TrackingLimits


@lru_cache(maxsize=8)
def _made_of(
    run: RunSkill,
    walk: WalkSkill,
    slow_down: SlowDownSkill,
    speed_up: SpeedUpSkill,
    brake: BrakeSkill,
    learned: bool,
) -> _Made:
    """Made once for all people with the same skills, which never change. ``learned``: whether they have the
    learned walk, too."""
    runs, walks = run_limits(run), walk_limits(walk)
    if learned:
        walks = replace(walks, tight=(walks.tight[0], MOST_TURN))
    return _Made(
        speed_up.run_tables(run), slow_down.run_tables(run), brake.run_tables(run),
        slow_down.walk_tables(walk), brake.walk_tables(walk), runs,
        replace(runs, sideways=SIDEWAYS, deceleration=_GENTLY, slowing=_GENTLY, rest=_RESTS),
        replace(runs, steps=0.0), walks,
        replace(walks, deceleration=BRAKING),
    )  # fmt: skip


class OnFeet:
    """``run_skill``, ``walk_skill``, ``slow_down_skill``, ``speed_up_skill``, ``brake_skill``: how it moves.
    ``limits``, ``learned_limits``, ``mixed_limits``, ``walk_limits``: paths that it can follow running, as
    planned, as learned, and partly as learned, and walking. ``walk``: memory of the walking controller
    (`locomotion.gaits.walk.layout`). ``learned``: the learned walk, None if all walking is planned.
    ``slowing``: [m/s^2] of slowing down to a walk, 0 if it does not.
    ``brakes``: whether it stops in the shortest distance. ``hurries``: whether it accelerates into its
    run. ``speed``: [m/s] reference speed of the controller that moved it last.
    """

    def __init__(
        self,
        run: RunSkill,
        walk: WalkSkill,
        slow_down: SlowDownSkill,
        speed_up: SpeedUpSkill,
        brake: BrakeSkill,
        policy: PolicySkill | None = None,
        residual: ResidualSkill | None = None,
        landing: ResidualSkill | None = None,
    ) -> None:
        self.run_skill, self.walk_skill = run, walk
        self.slow_down_skill, self.speed_up_skill, self.brake_skill = slow_down, speed_up, brake
        made = _made_of(run, walk, slow_down, speed_up, brake, policy is not None)
        self._quick_run, self._slow_run, self._braking_run = made.quick_run, made.slow_run, made.braking_run
        self._first_steps, self._braking_steps = made.first_steps, made.braking_steps
        self.limits, self.learned_limits, self.mixed_limits, self.walk_limits = (
            made.limits, made.learned_limits, made.mixed_limits, made.walk_limits
        )  # fmt: skip
        self._learned_walk_limits = made.learned_walk_limits
        self._slippery = load_slippery_roll()
        self.walk = new_walk()
        self.learned = None if policy is None else LearnedWalk(policy)
        self.residual = Residual(residual)
        self.landing = Landing(landing)
        self.slowing, self.brakes, self.hurries, self.speed = 0.0, False, False, 0.0

    @property
    def walks(self) -> bool:
        """Whether it walks or stands."""
        return self.walk.item(WALKS) > 0.0

    @property
    def walks_as_learned(self) -> bool:
        """Whether the learned walk moves it."""
        return self.walks and self.learned is not None and self.learned.active

    @property
    def runs_as_learned(self) -> bool:
        """Whether it runs as learned, or has not slowed down from that yet."""
        return self.walks and self.learned is not None and self.learned.runs

    @property
    def walks_within(self) -> TrackingLimits:
        """Limits of how it walks just now: as learned it may slow down faster than paths are planned."""
        return self._learned_walk_limits if self.walks_as_learned else self.walk_limits

    @property
    def learned_memory(self) -> NDArray[np.float64]:
        """What the learned walk remembers, empty without one."""
        return _NOTHING if self.learned is None else self.learned.memory

    @property
    def runs(self) -> bool:
        """Whether it runs without slowing down."""
        return not self.walks and self.slowing == 0.0

    def changes(self, state: NDArray[np.float64]) -> bool:
        """Whether it is changing gait; reversing the change now could make it fall."""
        if self.walks:
            return self.brakes or bool(self.walk[CAUGHT] > 0.0 and self.walk[WALK_STEPS] < _CHANGED)
        return self.slowing > 0.0 or bool(state[controller.STEPS] < _CHANGED)

    @property
    def rises(self) -> bool:
        """Whether it starts to walk from a crouch."""
        return self.walks and self.walk.item(WALK_TICKS) < RISING

    @property
    def turns_first(self) -> float:
        """[rad] off its way from which it turns on the spot, if need be after a stop."""
        learned = self.learned
        on_its_way = learned is not None and learned.active and not learned.runs and learned.speed > _MOVES
        return _TURN_ROUND if on_its_way else TURN_FIRST

    @property
    def on_uneven_ground(self) -> bool:
        """Whether it walks on steep ground or stairs."""
        return self.walks and self.walk.item(UNEVEN) > 0.0

    def strained_soon(self, command: NDArray[np.float64]) -> bool:
        """Whether it walks on steep ground or stairs and may have to rehearse one of its next steps."""
        if not self.on_uneven_ground:
            return False
        return bool(max(*self.walk[STRAINS], USUAL + slope_ahead(self.walk, command)) > FORESEEN)

    @property
    def begins_step(self) -> bool:
        """Whether a foot has just come down."""
        return self.walks and self.walk.item(PHASE) == DOUBLE and self.walk.item(CLOCK) == 0.0

    @property
    def begins_strained_step(self) -> bool:
        """Whether a foot has just come down on steep ground or stairs, and it is strained, or was at the step
        before."""
        return self.on_uneven_ground and self.begins_step and bool(self.walk[STRAINS].max() > STRAINED)

    def catch(self, body: Simulation, pushed: bool) -> None:
        """While a person is ``pushed``, and just after: one that is thrown off its learned stand steps at
        once, before it tips over. Thrown backwards it steps as planned, after the push, and falls less
        often."""
        learned = self.learned
        if learned is None or not learned.stands or body.ground_speed < _THROWN:
            return
        vx, vy = body.data.qvel[:2].tolist()
        heading = self.walk.item(WALK_HEADING)
        if math.cos(heading) * vx + math.sin(heading) * vy > _BACKWARDS * math.hypot(vx, vy):
            learned.step()
        elif not pushed:
            learned.give_back(body, self.walk, self.walk_skill.speed)

    def vary_step(self, longer: Sequence[float]) -> None:
        """Lengthen the transfer and the swing of the step that has just begun [s]."""
        self.walk[LONGER] = longer

    def at_rest(self, state: NDArray[np.float64]) -> bool:
        """Whether it stands still, and does not have to stand up straight yet."""
        return self.stands_still(state) and (
            self.learned is None or self.learned.active or self._upright(state)
        )

    def stands_still(self, state: NDArray[np.float64]) -> bool:
        """Whether it stands still, if only in a crouch."""
        if not (self.walks and self.walk.item(PHASE) == STANDING and self.walk.item(CLOCK) == 0.0):
            return False
        x, y, z = state[controller.COM_VELOCITY].tolist()
        return -_STILL < x < _STILL and -_STILL < y < _STILL and -_STILL < z < _STILL

    def _upright(self, state: NDArray[np.float64]) -> bool:
        """Whether it is as high as it stands: behind a stop it crouches."""
        return float(state[controller.COM][2] - state[controller.FEET][2::3].min()) > _UPRIGHT

    def stir(self, state: NDArray[np.float64]) -> None:
        """End its rest."""
        state[controller.COM_VELOCITY] = 0.0, 0.0, -_STILL

    # --- a tick
    def steer(
        self,
        follower: PathFollower,
        state: NDArray,
        moving: bool,
        planned: float,
        tick: int,
        command: NDArray,
    ) -> None:
        """Track the path: write the wanted heading and speeds into ``command`` (4,).

        moving: whether to continue along the path. planned: speed [m/s] of this step of a run-up, 0 outside
        of one.
        """
        x, y, _ = state[controller.COM].tolist()
        on_walk = self.walks
        walks = on_walk and not self.runs_as_learned
        follower.track(_WALK_GAINS if walks else RUN_GAINS, x, y, self.speed, tick, command)
        if on_walk:
            most = self.walk_skill.speed if follower.walks_fast else self.walk_limits.calm
            if self._runs_on(follower, command):
                most = self.limits.speeds[1]
            self._steer_walk(state, moving, follower.pace, most, command)
        elif self.slowing > 0.0:
            slower = state[controller.SPEED] - self.slowing * CONTROL_DT
            command[SPEED_ASKED], command[SIDEWAYS_ASKED] = slower, 0.0
            if self.brakes:  # straight ahead; the reference itself would follow too slowly
                state[controller.SPEED] = max(slower, SLOWEST)
                command[HEADING_ASKED] = state[controller.HEADING]
        else:
            if state[controller.STEPS] >= 2.0:
                haste = HASTE if self.hurries else _HASTE
                made = state[controller.STEP_SPEED]
                command[SPEED_ASKED] = min(
                    command[SPEED_ASKED], max(min(made + haste, _FAST), made + _FAST_HASTE)
                )
            slowest = min(command[SPEED_ASKED], self.limits.speeds[0])
            command[SPEED_ASKED] = (
                planned if planned > 0.0 else max(follower.pace * command[SPEED_ASKED], slowest)
            )

    def _runs_on(self, follower: PathFollower, command: NDArray) -> bool:
        """Whether the learned walk is to run: who does not yet, walks for a moment and turns towards its way
        first."""
        learned = self.learned
        if learned is None or not learned.may_run:
            return False
        off = math.remainder(command.item(HEADING_ASKED) - self.walk.item(WALK_HEADING), 2.0 * math.pi)
        return learned.runs or (follower.runs and learned.has_walked and abs(off) < _RUNS_WITHIN)

    def _steer_walk(self, state: NDArray, moving: bool, pace: float, most: float, command: NDArray) -> None:
        """``pace``: share of the wanted speed; ``most``: upper limit [m/s]."""
        walk = self.walk
        heading = walk.item(WALK_HEADING)
        if walk.item(WALK_STEPS) < 0.0 and not self.walks_as_learned:
            command[:] = heading, STEADYING_SPEED, 0.0, 0.0
            return
        off = command.item(HEADING_ASKED) - heading
        if walk.item(SUDDEN) == 0.0:
            off -= TURN_TIME * walk.item(WALK_TURN_RATE)  # it is already turning in a bend
        off = abs(math.remainder(off, 2.0 * math.pi))
        if not moving or off > self.turns_first:
            command[SPEED_ASKED] = command[SIDEWAYS_ASKED] = 0.0
            if np.hypot(*state[controller.COM_VELOCITY][:2]) > TURNING_SPEED:
                command[HEADING_ASKED] = heading
        elif off > TURN_FIRST:
            command[SPEED_ASKED] = min(command.item(SPEED_ASKED), _TURNING)
            command[SIDEWAYS_ASKED] = 0.0
        if self.brakes:
            pace = 0.0  # despite new commands: it has rehearsed this stop
        command[SPEED_ASKED] = pace * min(command.item(SPEED_ASKED), most)
        if pace == 0.0:  # waiting: a person stepping in place drifts into those ahead
            command[HEADING_ASKED], command[SIDEWAYS_ASKED] = heading, 0.0

    @property
    def _may_change_over(self) -> bool:
        """Whether a walk has just put a foot down, or stands: the learned one may take over, or give back."""
        return self.walk.item(PHASE) != SINGLE and self.walk.item(CLOCK) == 0.0

    def choose_walk(
        self, follower: PathFollower, moving: bool, body: Simulation, command: NDArray, free: bool
    ) -> None:
        """Where a foot has just come down, or in a stand: go on as learned, or as planned. ``moving``:
        whether to continue along the path; ``free``: whether no obstacle has to be cleared on it."""
        learned, walk = self.learned, self.walk
        if learned is None or not self.walks or not self._may_change_over:
            return
        came_up = walk.item(WALK_STEPS) == _CAME_UP and moving
        ready = came_up or walk[WALK_STEPS] >= _CHANGED
        if walk[PHASE] == STANDING:  # out of a crouch it straightens up, but the planned walk sets off
            ready = self._upright(body.control) or (ready and not moving)
            ready = ready and (moving or body.ground_speed < _CALM)
        usual = learned.active or ready
        fades = self.residual.acts and walk[PHASE] != STANDING  # what is left in a stand is no more needed
        usual = usual and not self.brakes and not fades and (came_up or not self.landing.acts)
        if usual:
            learned.look_ahead(follower, body, free and moving)
        suits = usual and learned.suits(follower, moving, body, command, walk)
        if suits and not learned.active:
            self.residual.forget()
            self.landing.forget()
            learned.take_over(body, walk)
        elif suits:
            learned.go_on()
        elif learned.active and not (usual and learned.calms_down(follower, body)):
            learned.give_back(body, walk, self.walk_skill.speed)

    def tick(self, body: Simulation, command: NDArray) -> None:
        """Control: write the PD targets into ``body.data.ctrl``."""
        lookup, state, data = body.lookup, body.control, body.data
        if self.learned is not None and self.walks_as_learned:
            self.learned.tick(lookup, command, data, self.walk)
            self.speed = self.learned.speed
        elif self.walks:
            tables = self._walk_tables(body.grip)
            observed = state[controller.OBSERVED]
            walk_tick(tables, lookup, self.walk, observed, command, data.qpos, data.qvel, data.ctrl)
            self.speed = float(self.walk[WALK_SPEED])
        else:
            tables = self._quick_run if self.hurries else self.run_skill.tables
            if self.slowing > 0.0:
                tables = self._braking_run if self.brakes else self._slow_run
            run_tick(*tables, state, command, data.qpos, data.qvel, data.ctrl)
            self.speed = float(state[controller.SPEED])
        self.residual.tick(self.brakes, state, self.walk, data)

    def _walk_tables(self, grip: float) -> NDArray[np.float64]:
        """The gains of its present walk, on ground with a coefficient of friction ``grip``."""
        steps = int(self.walk[WALK_STEPS])
        if steps < 0 and grip < FRICTION:
            return self._slippery.walk_tables(self.walk_skill, self._slippery.share(grip))
        first_steps = self._braking_steps if self.brakes else self._first_steps
        if self.walk[CAUGHT] > 0.0 and steps < len(first_steps):
            return first_steps[steps]
        return self.walk_skill.tables

    def observe(self, index: PersonIndex, state: NDArray, command: NDArray, data: mujoco.MjData) -> None:
        """After the physics and `controller.observe`."""
        if self.hurries and (self.walks or is_fast_enough(state, float(command[SPEED_ASKED]))):
            self.hurries = False
        if self.learned is not None and self.learned.drops(data):
            state[controller.FALLEN] = 1.0
        as_learned = self.walks_as_learned
        # not when it changes over: what is derived from the physics is neither saved nor restored
        changes = self.walks and self.learned is not None and self._may_change_over
        if self.learned is not None and (as_learned or changes):
            self.learned.observe(index, data)
        if self.walks and (changes or not as_learned):
            observe_walk(index, data, self.walk)
        if self.walks and not as_learned:
            note_strain(self.walk, state[controller.OBSERVED], command)
            if self.brakes and self.walk[PHASE] == STANDING:
                self.walk[CAUGHT] = 0.0
                self.brakes = not self.stands_still(state)
            self.brakes &= bool(self.walk[WALK_STEPS] < _HELD_UP)

    # --- from one gait to the other
    def run(self, state: NDArray, targets: NDArray, quickly: bool, speed: float) -> None:
        """Change from walking to running, from ``speed`` [m/s]; ``targets`` (39,) [rad]: the last
        tick's."""
        run_on(state, targets, self.walk[WALK_STANCE], self.walk[WALK_HEADING], speed)
        self.walk[WALKS] = 0.0
        self.stop_learned()
        self.hurries, self.brakes, self.speed = quickly, False, speed

    def stop_learned(self) -> None:
        """Something else than the learned walk moves it now."""
        self.residual.forget()
        if self.learned is not None:
            self.learned.leave()

    def slow_down(self, deceleration: float, brakes: bool = False) -> None:
        """Begin to slow down from the run to a walk [m/s^2]; ``brakes``: stop in the shortest distance
        instead."""
        self.slowing, self.brakes = deceleration, brakes

    def can_end_run(self, body: Simulation) -> bool:
        """Whether the learned walk could take over from its run here, once a foot has come down."""
        return self.learned is not None and self.learned.can_end_run(body)

    def end_run(self, body: Simulation) -> None:
        """Let the learned walk take over from a run whose foot has just come down."""
        assert self.learned is not None
        state = body.control
        self.residual.forget()
        self.walk[:] = new_walk(float(state[controller.HEADING]))
        observe_walk(body.index, body.data, self.walk)
        self.walk[CAUGHT], self.walk[WALK_STANCE] = 1.0, state[controller.STANCE]
        self.slowing, self.brakes = 0.0, False
        self.learned.end_run(body)

    def walk_if_slow(self, index: PersonIndex, state: NDArray, data: mujoco.MjData) -> bool:
        """Change to walking if it is slowing down and on a suitable foot; return whether it did."""
        can = self.brake_skill.can_walk_on if self.brakes else can_walk_on
        if not (self.slowing > 0.0 and can(state)):
            return False
        if self.brakes:
            walk_on(data, index, self._braking_steps[0], 0.0, state, self.walk)
        else:
            walk_on(data, index, self._first_steps[0], self.walk_limits.calm, state, self.walk)
        self.slowing = 0.0
        return True
