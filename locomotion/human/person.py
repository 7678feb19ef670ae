"""The parts of a person, its state, and the actions it can take; `locomotion.human.gait_changes` and
`locomotion.human.human` decide on them."""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import CONTROL_DT, PersonIndex
from locomotion.body_events import Event, WentBack
from locomotion.gaits.run import controller
from locomotion.gaits.run.controller import observe
from locomotion.gaits.run.skill import reset_running
from locomotion.gaits.walk.layout import WALKS, new_walk
from locomotion.gaits.walk.skill import plant
from locomotion.ground.ground import Ground
from locomotion.human import state as person_state
from locomotion.human.idle import idle_pose
from locomotion.human.on_feet import OnFeet
from locomotion.human.simulation import Simulation
from locomotion.human.state import MOVING, Gait, HumanState, Status
from locomotion.paths.follower import PathFollower
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.paths.tracking import new_track
from locomotion.recovery.on_all_fours import OnAllFours, too_steep_around
from locomotion.skills.interface import ClearingSkill
from locomotion.skills.run_up import RunUp

__all__ = ["Person"]

_SETTLING = 900  # ticks for a person that has stopped walking to come to rest
_FALL_TICKS = 100  # ticks for which a fallen body is simulated before it is held
_HEMMED_IN = 9.0  # [m] before an obstacle in which it may not change to a walk
_SOON_WALKED, _SOON_RUN, _SOON_SLOWS = 2.5, 4.0, 5.0
# [m] before something is to be rehearsed from which it looks ahead: a run-up, walking, running; slowing down


class Person:
    """The parts of a person.

    Attributes:
      simulation: its physics. on_feet: how it walks and runs. follower: the path that it follows.
      run_up: the obstacles on the path and how it clears them. fours: how it goes on hands and feet.
      command: heading and speeds for the controllers, (4,).
      status, events: see `locomotion.human.human.Human`. ticks: since the person was made. ended_at: the tick
        in which it fell or stopped. pushed_until: the tick at the end of which a push ends, 0 once it
        has swayed back from it, or without one. habit: 0 to 1, what makes it an individual at rest
        (`idle.idle_pose`); it does not change. size: how large it is in the world
        (`locomotion.human.measure`), for the reasons that it gives.
    """

    def __init__(self, ground: Ground | None, on_feet: OnFeet, clearing: Sequence[ClearingSkill]) -> None:
        self.simulation = Simulation(ground)
        self.on_feet, self.follower = on_feet, PathFollower()
        self.run_up = RunUp(clearing, on_feet.run_skill)
        self.fours = OnAllFours(self.model, self.index)
        self.command = np.zeros(4)
        self.events: list[Event] = []
        self.ticks = self.ended_at = self.pushed_until = 0
        self.status: Status = "standing"
        self.habit, self.size = 0.0, 1.0
        self.put(np.zeros(3) if ground is None else 0.5 * (ground.low + ground.high), 0.0, 0.0)

    def put(self, position: NDArray[np.float64], yaw: float, speed: float) -> None:
        """Let it stand, or run at ``speed`` [m/s], on the ground point ``position`` (3,) [m]; on hands and
        feet where it is too steep to stand."""
        self.fours.leave()
        self.on_feet.stop_learned()
        self.on_feet.landing.forget()
        body, walk = self.simulation, self.on_feet.walk
        if speed == 0.0 and too_steep_around(body.ground, position):
            self.fours.crouch(body.lookup, body.data, position, yaw)
            body.control[:] = controller.new_state()
            observe(body.index, body.model, body.data, body.control, fresh=True)
            walk[:] = new_walk(yaw)
        elif speed > 0.0:
            run = self.on_feet.run_skill
            reset_running(run, body.model, body.data, body.index, body.control, position, yaw, speed)
            walk[WALKS] = 0.0
        else:
            plant(body.model, body.data, body.index, body.lookup, body.control, walk, position, yaw)
            if self.on_feet.learned is not None:
                self.on_feet.learned.observe(body.index, body.data)
                self.on_feet.learned.stand(body, position, yaw)
        self.command[:] = yaw, speed, 0.0, 0.0
        self.on_feet.slowing, self.on_feet.brakes, self.on_feet.speed = 0.0, False, speed
        self.follower.memory[:] = new_track()

    # --- of its simulation
    @property
    def ground(self) -> Ground | None:
        """What it stands on; None is the endless plane z = 0."""
        return self.simulation.ground

    @property
    def model(self) -> mujoco.MjModel:
        """Its MuJoCo model, shared by all persons on the same ground."""
        return self.simulation.model

    @property
    def data(self) -> mujoco.MjData:
        """Its state in MuJoCo, current after a tick; derived values (contacts, places of bodies) may be
        outdated."""
        return self.simulation.data

    @property
    def index(self) -> PersonIndex:
        """Where its parts are in the model."""
        return self.simulation.index

    @property
    def control(self) -> NDArray[np.float64]:
        """What the running controller remembers (its fields: `locomotion.gaits.run.layout`)."""
        return self.simulation.control

    @property
    def observed(self) -> NDArray[np.float64]:
        """What is observed of the body (its fields: `locomotion.body.observed`)."""
        return self.simulation.control[controller.OBSERVED]

    @property
    def com(self) -> NDArray[np.float64]:
        """Centre of mass, (3,) float64 [m]."""
        return self.simulation.com

    @property
    def position(self) -> NDArray[np.float64]:
        """The point of the ground under the centre of mass, (3,) float64 [m]."""
        return self.simulation.position

    @property
    def yaw(self) -> float:
        """Direction that the pelvis faces [rad, -π to π]."""
        return self.simulation.yaw

    @property
    def slope_here(self) -> float:
        """Slope of the ground under the centre of mass [rise over run]; 0 where there is none."""
        return self.simulation.slope_here

    @property
    def qpos(self) -> NDArray[np.float64]:
        """(46,) float64: root position [m], quaternion (w, x, y, z), angles [rad] of `person.JOINT_NAMES`."""
        return self.data.qpos.copy()

    def pose(self) -> NDArray[np.float64]:
        """(46,) `qpos` as viewers see it. A person who stands as learned breathes and looks about."""
        return self.shown(self.qpos, self.idles_for)

    @property
    def idles_for(self) -> float:
        """[s] for which it has stood as learned; 0 if it does not."""
        if self.on_feet.walks_as_learned and self.status not in MOVING:
            return (self.ticks - self.ended_at) * CONTROL_DT
        return 0.0

    def shown(self, qpos: NDArray[np.float64], idles_for: float) -> NDArray[np.float64]:
        """Change ``qpos`` (46,) to how viewers see a person that has stood for so many seconds; return it."""
        if idles_for > 0.0:
            qpos[7:] = idle_pose(qpos[7:], idles_for, self.habit)
        return qpos

    @property
    def velocity(self) -> NDArray[np.float64]:
        """Velocity of the centre of mass, (3,) float64 [m/s]; zero while held."""
        return np.zeros(3) if self.held else self.control[controller.COM_VELOCITY].copy()

    def body_transforms(self) -> NDArray[np.float64]:
        """Position [m] and quaternion (w, x, y, z) of each body of the model, (nbody, 7) float64."""
        return self.simulation.body_transforms()

    # --- what it is doing
    @property
    def time(self) -> float:
        """Simulation time [s] since the person was made."""
        return self.ticks * CONTROL_DT

    @property
    def held(self) -> bool:
        """Whether the person is kept still and not simulated: at rest, or fallen for a second."""
        if self.status in MOVING or self.pushed_until:
            return False
        stopped = self.ticks - self.ended_at
        if self.status == "fallen":
            return stopped > _FALL_TICKS
        if self.fours.active:
            return stopped > _SETTLING and self.fours.borne
        return self.on_feet.at_rest(self.control) or stopped > _SETTLING

    @property
    def gait_now(self) -> Gait:
        """How it moves now: "walk" (or stand), "run", "slow run" on its way from a planned run to a walk, or
        "scramble" (or getting up)."""
        if self.fours.active:
            return "scramble"
        if self.on_feet.walks:
            return "run" if self.on_feet.runs_as_learned else "walk"
        return "run" if self.on_feet.runs else "slow run"

    @property
    def physics(self) -> mujoco.MjModel:
        """The model for its next tick: on hands and feet or after a fall, contacts with the ground are
        stiffer than in `model`. On hands and feet it looks at the ground five times a second, and may then
        change to another model in that very tick."""
        return self.fours.model if self.fours.active else self.model

    @property
    def clearing(self) -> tuple[ClearingSkill, ...]:
        """How it clears obstacles."""
        return self.run_up.skills

    @property
    def arc_length(self) -> float:
        """Length of the path behind the person [m]."""
        return self.follower.arc_length

    @property
    def lateral_error(self) -> float:
        """Distance of the centre of mass to the left of the path [m]."""
        return self.follower.lateral

    @property
    def pace(self) -> float:
        """Share of its planned speed at which it moves."""
        return self.follower.pace

    @property
    def path(self) -> NDArray[np.float64]:
        """(n, 3) float64 [m]: its present or last path."""
        return self.follower.points

    @property
    def obstacle_ahead(self) -> ObstacleAhead | None:
        """The next obstacle on its path, or the one that it is clearing."""
        return self.run_up.ahead

    @property
    def point(self) -> tuple[float, float, float]:
        """`position` as events report it."""
        x, y, z = self.position
        return float(x), float(y), float(z)

    def way_back(self) -> NDArray[np.float64] | None:
        """(k, 3) [m] the points of its path behind it, back to the last obstacle that it cleared, see
        `PathFollower.way_back`."""
        return self.follower.way_back(self.run_up.passed)

    # --- what it is about to decide
    @property
    def begins_run_up(self) -> bool:
        """Whether a step of a run-up has just begun and was not rehearsed yet."""
        return self.on_feet.runs and self.run_up.to_rehearse(self.control)

    @property
    def hemmed_in(self) -> bool:
        """Whether the next obstacle may be too near to slow down first."""
        return self.run_up.comes_within(self.arc_length, _HEMMED_IN)

    @property
    def decides_soon(self) -> bool:
        """Whether something may have to be rehearsed within the next seconds."""
        follower, feet, arc = self.follower, self.on_feet, self.arc_length
        if follower.stops_since and not feet.walks and (feet.brakes or feet.runs):
            return True
        if follower.tried_to_slow and feet.slowing > 0.0 and not feet.brakes:
            return True
        if feet.strained_soon(self.command) and not self.fours.active and not self.held:
            return True
        if follower.path is None or self.status not in MOVING or self.fours.active or feet.slowing > 0.0:
            return False
        if feet.walks:
            begins = follower.interrupted is None and follower.path.runs(follower.arc + _SOON_WALKED)
            turns = follower.interrupted is not None and follower.remaining < _SOON_WALKED
            return (begins or turns) and self.run_up.rehearses_within(arc, _SOON_WALKED)
        ends = not self.run_up.clearing and not follower.path.runs(follower.arc + _SOON_SLOWS)
        return ends or self.run_up.rehearses_within(arc, _SOON_RUN)

    # --- what it can be made to do
    def run(self, quickly: bool, speed: float) -> None:
        """Change from walking to running, from ``speed`` [m/s]."""
        self.on_feet.run(self.control, self.data.ctrl, quickly, speed)
        self.status = "running"

    def set_off(self, choice: tuple[bool, Sequence[float]], speed: float) -> None:
        """Begin to run towards the obstacle ahead, from ``speed`` [m/s]: whether it accelerates quickly, and
        its variation of the run-up (`vary_run_up`)."""
        quickly, run_up = choice
        self.run(quickly, speed)
        self.run_up.set_off(run_up, True)

    def vary_run_up(self, choice: Sequence[float]) -> None:
        """Plan the run-up step that has just begun with a take-off mark farther from the obstacle [m] and a
        faster entry [m/s]."""
        self.run_up.vary(choice, self.control, True)

    def balk(self, deceleration: float) -> None:
        """Abort the run-up, slowing down [m/s^2]."""
        self.run_up.balk()
        self.slow_down(deceleration)

    def slow_down(self, deceleration: float) -> None:
        """Begin to slow down from the run to a walk [m/s^2]; this will hold."""
        self.follower.tried_to_slow = 0
        self.on_feet.slow_down(deceleration)

    def brake(self, harder: float) -> None:
        """Begin to brake, ``harder`` than learned by that share; this will hold."""
        self.follower.stops_since = 0
        self.on_feet.slow_down(harder * self.on_feet.brake_skill.deceleration, brakes=True)

    def end_run(self) -> None:
        """Go over from the run to the learned walk, which slows down; this will hold."""
        self.follower.stops_since = self.follower.tried_to_slow = 0
        self.on_feet.end_run(self.simulation)
        if self.status in MOVING:
            self.status = "walking"

    def vary_step(self, longer: Sequence[float]) -> None:
        """Lengthen the transfer and the swing of the step that has just begun [s]."""
        self.on_feet.vary_step(longer)

    def go_back(self) -> bool:
        """Turn round for a longer run-up to the obstacle ahead; return whether there is one."""
        follower = self.follower
        to = None if follower.interrupted is not None else self.run_up.turning_point(follower.arc, follower)
        if follower.path is None or to is None:
            return False
        ahead = self.run_up.ahead
        assert ahead is not None
        self.events.append(WentBack(self.time, self.point, ahead.affordance, ahead.size, follower.arc - to))
        self.run_up.go_back()
        follower.go_back(to, self.on_feet.walk_limits, self.ticks)
        return True

    def end(self, status: Status, event: Event) -> None:
        """Its path has ended: set ``status`` and report ``event``."""
        self.status, self.ended_at = status, self.ticks
        self.events.append(event)

    # --- saving
    def save_state(self) -> HumanState:
        """Everything needed to continue from here."""
        return person_state.save(self)

    def become(self, state: HumanState) -> None:
        """Restore or advance to a ``state`` of a person on the same ground with the same skills. Raises
        `LocomotionError`, and changes nothing, if it belongs to another model."""
        person_state.restore(self, state)

    def state_hash(self) -> str:
        """Hex digest of the complete state; equal for equal runs."""
        return person_state.hash_of(self.save_state())
