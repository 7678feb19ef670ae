"""Trials of the drop-roll: a running person at a ledge, and figures of its landing, roll and rise."""

import math
from dataclasses import dataclass

import mujoco
import numpy as np

from locomotion.body.person import CONTROL_DT, MASS, STEPS_PER_TICK, PersonIndex
from locomotion.gaits.limits import run_entry_speed
from locomotion.gaits.run import controller as c
from locomotion.gaits.run.skill import RunSkill, run_on
from locomotion.gaits.walk.controller import observe_walk, walk_tick
from locomotion.gaits.walk.layout import WALK_HEADING, WALK_STANCE, WALK_STEPS, new_walk
from locomotion.gaits.walk.skill import RISING, STEADYING_SPEED, load_walk_skill, rise_walking
from locomotion.ground.ground import plane_lookup
from locomotion.paths.command import HEADING_ASKED, SPEED_ASKED
from locomotion.preconditions.moments import make_slippery
from locomotion.skills.drop_roll import kernel as dr
from locomotion.skills.learned_skill import LawTables
from locomotion.training.skills.jump_trial import StartState
from locomotion.training.skills.trial_scene import BOX_LENGTH, BOX_TOP, trial_scene
from surefoot.kernels import kernel

__all__ = ["DropOutcome", "DropSimulator"]

_STATE = mujoco.mjtState.mjSTATE_INTEGRATION
_UPRIGHT, _TALL = 0.8, 0.75  # of the chest's axis; [m] of the centre of mass: it stands
_STEERING, _MOST_STEERING = 0.4, 0.4  # [rad/m], [rad] back to the line
_ON, _HASTE = 3.5, 1.3  # [m/s] of the run after it; by which it may be asked for more than it makes
_HARD = 4.0  # body weights above which the ground's reaction is summed up


@dataclass(frozen=True)
class DropOutcome:
    """What a trial showed.

    rolled: it came up and is still on its feet at the end. rose: its feet carried it again. angle: by
    which the pelvis turned forward [rad]. time: share of the trial that it lasted. upright: the chest's
    axis upwards at the end. peak: highest reaction of the ground from the touchdown on, averaged over a
    tick's last physics step [body weights]. reaction: sum over the ticks of the excess above 4 body
    weights. head: ticks in which the head touched the ground. aside: sideways distance at the end [m].
    tilt: sum over the roll's ticks of the squares of the pelvis's tilt to the side and of its turn
    [rad^2]. lurch: sum over the ticks after the roll of the squared tilt of the chest. entry, exit:
    forward speed [m/s] at the touchdown and at the roll's end. As if over the right shoulder, at the
    roll's end: drift: speed to the left [m/s]; momentum: angular, about the way, to the left and up [Nms]
    (a body that comes up turning cannot be stopped by its feet); tilted: rise of the pelvis's left side.
    low: least height [m] of the head above the ground in the roll.
    """

    rolled: bool
    rose: bool
    angle: float
    time: float
    upright: float
    peak: float
    reaction: float
    head: int
    aside: float
    tilt: float
    lurch: float
    entry: float
    exit: float
    drift: float
    momentum: np.ndarray
    tilted: float
    low: float


@kernel
def _touches(ncon, geoms, addresses, forces, heads):
    """Sum of the normal forces [N], and whether a geom marked in ``heads`` touches."""
    total, head = 0.0, False
    for k in range(ncon):
        if addresses[k] >= 0:
            for j in range(4):
                total += forces[addresses[k] + j]
            head = head or heads[geoms[k, 0]] or heads[geoms[k, 1]]
    return total, head


class DropSimulator:
    """A person, a ledge and the ground below it that trials are run with; one per process."""

    def __init__(self, run: RunSkill) -> None:
        self.run, self.gait = run, load_walk_skill()
        self.model = trial_scene("ledge")
        self.data = mujoco.MjData(self.model)
        self.index = PersonIndex.of(self.model)
        self.ledge, self.ground = self.model.geom("ledge").id, self.model.geom("ground").id
        self.heads = self.model.geom_bodyid == self.index.head
        self.skull = np.flatnonzero(self.heads & (self.model.geom_conaffinity > 0))  # capsules
        self.state, self.walk = c.new_state(), new_walk()
        self.command, self.memory = np.zeros(4), np.zeros(dr.MEMORY_SIZE)
        self.rising = self.gait.tables
        self.place(0.0, 0.0)

    def become_slippery(self, friction: float, rising: np.ndarray) -> None:
        """Give all that is touched this coefficient of ``friction``; ``rising``: the walk's gains (5,
        len(GAINS)) while the person comes up."""
        make_slippery(self.model, friction)
        self.rising = rising

    def place(self, edge: float, height: float) -> None:
        """The ledge, at z = 0, ends at x = ``edge`` [m]; the ground is ``height`` [m] below it."""
        self.model.geom_pos[self.ledge] = [edge - BOX_LENGTH / 2, 0.0, -BOX_TOP]
        self.model.geom_pos[self.ground] = [0.0, 0.0, -height]
        self.height, self.lookup = height, (*plane_lookup()[:-1], np.array([0.0, 0.0, -height]))

    def trial(
        self,
        tables: LawTables,
        height: float,
        start: StartState,
        error: float,
        duration: float,
        on_tick=None,
        record: np.ndarray | None = None,
        rise: bool = True,
    ) -> DropOutcome:
        """Roll off a ledge of ``height`` [m] from a harvested state; the edge is put so that the distance
        misses the mark by ``error`` [m].

        duration: [s]. on_tick(simulator) is called after each tick. record: (11, 13) sums of the sensors by
        the share and their count, added to. rise: False ends the trial where the roll ends.
        """
        edge = float(start.planted[0]) + tables.mark + error
        self.place(edge, height)
        mujoco.mj_setState(self.model, self.data, start.physics, _STATE)
        self.state[:] = start.control
        self.command[:] = 0.0, tables.entry, 0.0, 0.0
        self.memory[:] = 0.0
        self.walk[:] = 0.0
        data, state, memory, steps = self.data, self.state, self.memory, self.state[c.STEPS]
        observed = state[c.OBSERVED]
        meter = _Meter(self, float(start.planted[1]))
        begun = walks = runs = False
        ticks = round(duration / CONTROL_DT)
        for _ in range(ticks):
            if walks or runs:
                self._steer(runs, float(start.planted[1]))
            if walks:
                tables_now = self.rising if self.walk[WALK_STEPS] < 0.0 else self.gait.tables
                walk_tick(
                    tables_now, self.lookup, self.walk, observed, self.command, data.qpos, data.qvel,
                    data.ctrl,
                )  # fmt: skip
            else:
                c.run_tick(*self.run.tables, state, self.command, data.qpos, data.qvel, data.ctrl)
            if not walks and not runs:
                if not begun and state[c.STEPS] != steps:
                    begun = True
                    side = 1.0 if state[c.STANCE] > 0 else -1.0
                    dr.start_drop_roll(memory, side, -height, edge, 0.0, 1.0, 0.0)
                if begun:
                    dr.drop_roll_tick(
                        tables.parameters, *tables.rest, memory, state, data.qpos, data.qvel, data.ctrl
                    )
                if memory[dr.ENDED] > 0.0:
                    walks = True
                    w, x, y, z = data.qpos[3:7]
                    yaw = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
                    rise_walking(self.walk, observed, yaw)
                    self.command[:] = yaw, STEADYING_SPEED, 0.0, 0.0
            mujoco.mj_step(self.model, data, STEPS_PER_TICK)
            c.observe(self.index, self.model, data, state)
            meter.tick(walks or runs)
            if walks:
                observe_walk(self.index, data, self.walk)
                speed = run_entry_speed(self.walk, observed, float(self.command[HEADING_ASKED]))
                if speed is not None:
                    run_on(state, data.ctrl, self.walk[WALK_STANCE], self.walk[WALK_HEADING], speed)
                    walks, runs = False, True
            if record is not None and memory[dr.ACTIVE] > 0.0 and memory[dr.PHASE] != dr.TAKE_OFF:
                place = min(int(memory[dr.SHARE] * (dr.BINS - 1) + 0.5), dr.BINS - 1)
                record[place, :-1] += memory[dr.SENSED]
                record[place, -1] += 1.0
            if on_tick is not None:
                on_tick(self)
            given_up = begun and memory[dr.ACTIVE] == 0.0 and memory[dr.ENDED] == 0.0
            on_feet = (memory[dr.PHASE] == dr.TAKE_OFF) or meter.walked >= RISING
            over = memory[dr.ENDED] > 0.0 and not rise
            if given_up or over or (on_feet and state[c.FALLEN] > 0.0):
                break
            state[c.FALLEN] = 0.0
        return meter.outcome(ticks)

    def _steer(self, runs: bool, line: float) -> None:
        """Command after the roll: on along the way at y = ``line`` [m], as the body does on a path."""
        state, walk = self.state, self.walk
        if not runs and walk[WALK_STEPS] < 0.0:
            self.command[:2] = walk[WALK_HEADING], STEADYING_SPEED
            return
        aside = float(state[c.COM][1]) - line
        self.command[HEADING_ASKED] = min(max(-_STEERING * aside, -_MOST_STEERING), _MOST_STEERING)
        self.command[SPEED_ASKED] = self.gait.speed
        if runs:
            haste = state[c.STEP_SPEED] + _HASTE if state[c.STEPS] >= 2.0 else _ON
            self.command[SPEED_ASKED] = min(_ON, haste)


class _Meter:
    """Collects the figures of a trial."""

    def __init__(self, simulator: DropSimulator, line: float) -> None:
        self.s, self.line = simulator, line
        self.ticks = self.head = self.walked = 0
        self.peak = self.reaction = self.tilt = self.lurch = self.angle = self.entry = self.exit = 0.0
        self.drift = self.tilted = 0.0
        self.momentum, self.low = np.zeros(3), 1.0

    def tick(self, after: bool) -> None:
        data, memory = self.s.data, self.s.memory
        self.ticks += 1
        self.walked += after
        if memory[dr.PHASE] not in (dr.ROLL, dr.RISE):
            self.entry = float(self.s.state[c.COM_VELOCITY][0])
            return
        contact = data.contact
        force, head = _touches(data.ncon, contact.geom, contact.efc_address, data.efc_force, self.s.heads)
        weights = force / (MASS * 9.81)
        self.peak = max(self.peak, weights)
        self.reaction += max(weights - _HARD, 0.0)
        self.head += head
        if after:
            up = data.xmat[self.s.index.chest]
            self.lurch += float((up[2] - 0.1) ** 2 + up[5] ** 2)
        else:
            sensed = memory[dr.SENSED]
            self.tilt += float(sensed[6] ** 2 + sensed[8] ** 2)
            self.angle = float(memory[dr.ANGLE])
            self.exit = float(sensed[1])
            self.drift, self.tilted = float(sensed[10]), float(sensed[6])
            if memory[dr.ENDED] == 0.0:
                mujoco.mj_subtreeVel(self.s.model, data)
                mirror = np.array([memory[dr.SIDE], 1.0, memory[dr.SIDE]])
                self.momentum = mirror * data.subtree_angmom[self.s.index.root]
                self.low = min(self.low, self._head_above_ground())

    def _head_above_ground(self) -> float:
        s = self.s
        up = np.abs(s.data.geom_xmat[s.skull, 8]) * s.model.geom_size[s.skull, 1]
        reach = s.data.geom_xpos[s.skull, 2] - up - s.model.geom_size[s.skull, 0]
        return float(reach.min()) + s.height

    def outcome(self, ticks: int) -> DropOutcome:
        com, upright = self.s.state[c.COM], float(self.s.data.xmat[self.s.index.chest][8])
        stands = upright > _UPRIGHT and float(com[2]) + self.s.height > _TALL
        return DropOutcome(
            rolled=bool(self.walked > 0 and self.ticks == ticks and stands),
            rose=self.walked > 0,
            angle=self.angle,
            time=self.ticks / ticks,
            upright=upright,
            peak=self.peak,
            reaction=self.reaction,
            head=self.head,
            aside=abs(float(com[1]) - self.line),
            tilt=self.tilt,
            lurch=self.lurch,
            entry=self.entry,
            exit=self.exit,
            drift=self.drift,
            momentum=self.momentum,
            tilted=self.tilted,
            low=self.low,
        )
