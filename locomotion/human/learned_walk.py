"""The learned walk of a person: when it takes over from the planned one, and when it gives back.

It stands, sets off, walks, turns, also on the spot, and stops where the ground is level all around the path
ahead. Slopes, stairs and rubble are walked as planned, and so are the last steps before a run. Both change
over where a foot has just come down, or in a stand.
"""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import PersonIndex
from locomotion.gaits.policy import layout as at
from locomotion.gaits.policy.kernel import Parts, feel, feet_yaw, new_memory
from locomotion.gaits.policy.law import BRAKING, LIFT_OFF, RUNS_FROM
from locomotion.gaits.policy.level_ground import is_level, is_level_around
from locomotion.gaits.policy.skill import PolicySkill
from locomotion.gaits.policy.stand import stand_still
from locomotion.gaits.policy.style import style_of
from locomotion.gaits.run.controller import observe
from locomotion.gaits.run.layout import COM_VELOCITY, FEET, PLANTED
from locomotion.gaits.run.layout import HEADING as RUN_HEADING
from locomotion.gaits.run.layout import STANCE as RUN_STANCE
from locomotion.gaits.run.layout import TURN_RATE as RUN_TURN_RATE
from locomotion.gaits.walk.layout import (
    PHASE,
    SEEN,
    STANDING,
    WALK_HEADING,
    WALK_SPEED,
    WALK_STANCE,
    WALK_STEPS,
    WALK_TICKS,
    WALK_TURN_RATE,
    new_walk,
    wrap,
)
from locomotion.human.learned_tick import (
    ACTIVE,
    CALM_SPEED,
    CALM_TURN,
    CALMS,
    MAY_RUN,
    MEMORY_SIZE,
    MOST_TURN,
    OWN_STYLE,
    SLOWEST,
    TICKS,
    decide_and_walk_on,
    walk_on,
)
from locomotion.human.simulation import Simulation
from locomotion.paths import table as path
from locomotion.paths.command import HEADING_ASKED, SPEED_ASKED
from locomotion.paths.follower import PathFollower

__all__ = ["RUN_STOPS", "LearnedWalk", "memory_of", "memory_of_run"]

_SEES, _LEAVES, _LATEST = 2.6, 1.6, 0.9
# [m] of level ground ahead with which it takes over; without which, once it is calm, it gives back; and
# without which it gives back in any case
_BEHIND = 0.5  # [m] behind it that have to be level, too: a foot is still there
_AT_LEAST, _ASKEW = 0.5, 0.25  # [m/s] and [rad] off its way with which it takes over
_SHARP = 0.6  # [rad] off its way from which it turns only where the ground is level all around
_DROPS = 2.0  # [m/s] downwards with which the ground has gone
RUN_STOPS = 1.2
"""[m/s^2] with which it comes to rest out of a run."""
_REACTS = 0.3  # [s] before that
_RUN_SEES = 4.0  # [m] of level ground more, for it to run
_ROOM = 0.8  # [m] more to where a run begins
_WALKS_FIRST = 60  # ticks before it begins a run


def memory_of_run(run: NDArray[np.float64], qvel: NDArray[np.float64]) -> NDArray[np.float64]:
    """The policy's memory, (STATE_SIZE,), with which it takes over from a ``run`` (its controller's state)
    that has just put a foot down."""
    heading = float(run[RUN_HEADING])
    memory = new_memory(heading)
    memory[[at.RUNNING, at.FAST]] = 1.0
    memory[at.PHASE] = 0.0 if run[RUN_STANCE] < 0.0 else 0.5
    speed = math.cos(heading) * qvel[0] + math.sin(heading) * qvel[1]
    memory[[at.SPEED, at.TOLD]] = max(speed, SLOWEST)
    memory[at.TURN_RATE] = min(max(run[RUN_TURN_RATE], -MOST_TURN), MOST_TURN)
    return memory


def memory_of(walk: NDArray[np.float64], qvel: NDArray[np.float64]) -> NDArray[np.float64]:
    """The policy's memory, (STATE_SIZE,), with which it takes over from a planned ``walk`` that has just put
    a foot down, or stands."""
    heading = float(walk[WALK_HEADING])
    memory = new_memory(heading)
    if walk[PHASE] != STANDING:
        memory[at.RUNNING] = 1.0
        memory[at.PHASE] = 0.0 if walk[WALK_STANCE] < 0.0 else 0.5
        speed = math.cos(heading) * qvel[0] + math.sin(heading) * qvel[1]
        memory[[at.SPEED, at.TOLD]] = max(speed, SLOWEST)
        memory[at.TURN_RATE] = min(max(walk[WALK_TURN_RATE], -MOST_TURN), MOST_TURN)
    return memory


def _is_level_ahead(way: path.PathTable, arc: float, far: float, body: Simulation) -> bool:
    """Whether the ground is level along the ``way`` from a little behind ``arc`` to ``far`` ahead of it
    [m]."""
    begin, z = max(arc - _BEHIND, 0.0), float(body.position[2])
    return bool(is_level(body.lookup, way.table, way.length, begin, arc + far, z))


class LearnedWalk:
    """``skill``: the networks. ``memory``: (MEMORY_SIZE,), all that has to be saved."""

    def __init__(self, skill: PolicySkill) -> None:
        self.skill = skill
        self.memory = np.zeros(MEMORY_SIZE)
        self._state, self._felt = self.memory[: at.STATE_SIZE], self.memory[at.STATE_SIZE : ACTIVE]
        self._parts: tuple[mujoco.MjModel, Parts] | None = None

    @property
    def active(self) -> bool:
        """Whether it moves the person."""
        return self.memory.item(ACTIVE) > 0.0

    @property
    def runs(self) -> bool:
        """Whether it runs, or has not slowed down from a run yet."""
        return self.active and self._state.item(at.FAST) > 0.0

    @property
    def stands(self) -> bool:
        """Whether it stands, on both feet."""
        return self.active and self._state.item(at.RUNNING) == 0.0

    @property
    def has_walked(self) -> bool:
        """Whether it has moved the person for long enough to begin a run."""
        return self.memory.item(TICKS) >= _WALKS_FIRST

    @property
    def may_run(self) -> bool:
        """Whether it is to run where the path says so."""
        return self.memory.item(MAY_RUN) > 0.0

    def wear(self, traits: NDArray[np.float64]) -> None:
        """Move in the style of these ``traits`` (7,) on the next ways (`locomotion.body.traits`)."""
        self.memory[OWN_STYLE] = style_of(traits)

    def show_style(self, shows: bool) -> None:
        """Move in its own style from now on, or as the usual person: planned gaits take over from that more
        surely."""
        self._state[at.STYLE] = self.memory[OWN_STYLE] if shows else 0.0

    def step(self) -> None:
        """Make steps from now on until it can stand again, the first with the foot that bears less."""
        right, left = self._felt[at.FORCES].reshape(2, 2).sum(axis=1).tolist()
        self._state[at.RUNNING], self._state[at.RESTED] = 1.0, 0.0
        self._state[at.PHASE] = LIFT_OFF + 0.5 * (left > right)

    def leave(self) -> None:
        """Something else moves the person now."""
        self.memory[ACTIVE] = 0.0

    def drops(self, data: mujoco.MjData) -> bool:
        """Whether the ground has gone from under the person that it moves: it has not learned to land."""
        return self.active and data.qvel.item(2) < -_DROPS

    @property
    def speed(self) -> float:
        """[m/s] of its reference."""
        return self._state.item(at.TOLD)

    def suits(
        self,
        follower: PathFollower,
        moving: bool,
        body: Simulation,
        command: NDArray,
        walk: NDArray[np.float64],
    ) -> bool:
        """Whether it can go on from here, or take over from the planned ``walk``; ``moving``: whether the
        person is to go on along its path."""
        if self.runs:
            return True  # nothing else can go on from here
        way, active, arc = follower.path, self.active, follower.arc
        if (not moving and walk[PHASE] == STANDING) or (way is None and active):
            return bool(is_level_around(body.lookup, *body.position.tolist()))
        if way is None:
            return False
        far = self._leaves if active else _SEES
        off = abs(wrap(command[HEADING_ASKED] - walk[WALK_HEADING]))
        if active and off > _SHARP and not is_level_around(body.lookup, *body.position.tolist()):
            return False  # it drifts as it turns
        if not active and walk[PHASE] != STANDING:
            if not moving or command[SPEED_ASKED] < SLOWEST or follower.remaining < far:
                return False  # it will stand before long
            if off > _ASKEW or body.ground_speed < _AT_LEAST:
                return False  # it turns on the spot
        rows = way.table
        first = round(arc / way.length * (len(rows) - 1))
        ahead = rows[first : first + round((far + _ROOM) / path.SPACING)]
        if moving and not self.may_run and (ahead[:, path.GAIT] == path.RUN).any():
            return False
        return _is_level_ahead(way, arc, far, body)

    @property
    def _leaves(self) -> float:
        """[m] of level ground that it needs: it slows down before it gives back."""
        return _LEAVES + max(self.speed**2 - CALM_SPEED**2, 0.0) / (2.0 * BRAKING)

    def calms_down(self, follower: PathFollower, body: Simulation) -> bool:
        """Whether it has to become slower or straighter before planned steps can go on from here, and has the
        room for that. From now on it does so."""
        way, turns = follower.path, abs(self._state.item(at.TURN_RATE)) > CALM_TURN
        hasty = not self.stands and (turns or self.speed > CALM_SPEED)
        calms = way is not None and hasty and _is_level_ahead(way, follower.arc, _LATEST, body)
        self.memory[CALMS] = float(calms)
        return calms

    def go_on(self) -> None:
        """It need not calm down any more."""
        self.memory[CALMS] = 0.0

    def holds_along(self, way: path.PathTable, body: Simulation) -> bool:
        """Whether it can move a person along the whole ``way``, which begins where the person is."""
        z = float(body.position[2])
        return bool(is_level(body.lookup, way.table, way.length, 0.0, way.length, z))

    def look_ahead(self, follower: PathFollower, body: Simulation, free: bool) -> None:
        """Find out whether it may run from here: on level ground, where a foot has just come down. ``free``:
        whether no obstacle has to be cleared on the way."""
        way, arc = follower.path, follower.arc
        self.memory[MAY_RUN] = 0.0
        if way is None or not free:
            return
        speed = body.ground_speed
        far = _RUN_SEES + speed * (_REACTS + speed / (2.0 * RUN_STOPS))
        rows = way.table
        first = round(arc / way.length * (len(rows) - 1))
        ahead = rows[first : first + round(far / path.SPACING)]
        runs = ahead[:, path.SPEED] > RUNS_FROM if self.runs else ahead[:, path.GAIT] == path.RUN
        self.memory[MAY_RUN] = float(runs.any() and _is_level_ahead(way, arc, far, body))

    def stand(self, body: Simulation, position: NDArray[np.float64], yaw: float) -> None:
        """Let a person that has been put down as planned stand as learned instead, on the ground point
        ``position`` (3,), if the ground there is level."""
        if not is_level_around(body.lookup, *position.tolist()):
            return
        parts = self._feet(body.index, body.data)
        style = self._state[at.STYLE]
        stand_still(body.model, body.data, parts, self.skill.motion, position, yaw, self._felt, style)
        observe(body.index, body.model, body.data, body.control, fresh=True)
        body.control[PLANTED] = body.control[FEET]
        self._begin(new_memory(yaw))

    def can_end_run(self, body: Simulation) -> bool:
        """Whether the ground is level where a running person is, and where it would come to rest."""
        x, y, z = body.position.tolist()
        vx, vy = body.control[COM_VELOCITY][:2]
        far = _REACTS + math.hypot(vx, vy) / (2.0 * RUN_STOPS)
        shares = np.linspace(0.0, 1.0, 2 + int(far * math.hypot(vx, vy)))
        ways = [far * share for share in shares.tolist()]
        return all(is_level_around(body.lookup, x + t * vx, y + t * vy, z) for t in ways)

    def end_run(self, body: Simulation) -> None:
        """Move a person from now on that runs, and has just put a foot down."""
        self._begin(memory_of_run(body.control, body.data.qvel))
        feel(self._feet(body.index, body.data), body.data, self._felt)

    def take_over(self, body: Simulation, walk: NDArray) -> None:
        """Move a person from now on that walks as planned and has just put a foot down, or stands."""
        memory = memory_of(walk, body.data.qvel)
        if walk[PHASE] == STANDING:
            memory[at.HEADING] = feet_yaw(self._felt)
        self._begin(memory)

    def _begin(self, memory: NDArray[np.float64]) -> None:
        """Move a person from now on, in its style, as of this ``memory`` (STATE_SIZE,) of a usual one."""
        style = self._state[at.STYLE].copy()
        self._state[:] = memory
        self._state[at.STYLE] = style
        self.memory[[ACTIVE, TICKS, CALMS]] = 1.0, 0.0, 0.0

    def give_back(self, body: Simulation, walk: NDArray, fastest: float) -> None:
        """Let the planned walk go on, at ``fastest`` [m/s] at most, just after a foot came down, or in a
        stand."""
        data, phase = body.data, walk[PHASE]
        stance, steps, ticks = walk[WALK_STANCE], walk[WALK_STEPS], walk[WALK_TICKS]
        heading = float(self._state[at.HEADING])
        seen = walk[SEEN].copy()
        walk[:] = new_walk(heading)
        walk[SEEN] = seen
        walk[PHASE], walk[WALK_STANCE], walk[WALK_STEPS], walk[WALK_TICKS] = phase, stance, steps, ticks
        speed = math.cos(heading) * data.qvel[0] + math.sin(heading) * data.qvel[1]
        walk[WALK_SPEED] = min(max(speed, 0.0), fastest)
        self.leave()

    def tick(self, ground: tuple[NDArray, ...], command: NDArray, data: mujoco.MjData, walk: NDArray) -> None:
        """One control tick: write the targets ``data.ctrl``, and what others read into ``walk``."""
        if self.memory.item(TICKS) % at.TICKS_PER_DECISION == 0.0:
            decide_and_walk_on(
                ground, *self.skill.tables, self.memory, command, walk, data.qpos, data.qvel, data.ctrl
            )
        else:
            walk_on(self.memory, command, walk, data.qpos, data.ctrl)

    def observe(self, index: PersonIndex, data: mujoco.MjData) -> None:
        """After the physics, while it moves the person, and when it may take over next."""
        if not self.active or self.memory.item(TICKS) % at.TICKS_PER_DECISION == 0.0:
            feel(self._feet(index, data), data, self._felt)

    def _feet(self, index: PersonIndex, data: mujoco.MjData) -> Parts:
        if self._parts is None or self._parts[0] is not data.model:
            self._parts = data.model, Parts(index, data.model)
        return self._parts[1]
