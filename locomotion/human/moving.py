"""A person under physics with all that moves it: its parts, what they remember, and what it is doing."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import CONTROL_DT
from locomotion.errors import LocomotionError
from locomotion.events import Event
from locomotion.gaits.run import controller
from locomotion.gaits.run.controller import observe
from locomotion.gaits.run.skill import reset_running
from locomotion.gaits.walk.layout import WALKS, new_walk
from locomotion.gaits.walk.skill import plant
from locomotion.ground.ground import Ground
from locomotion.human.on_feet import OnFeet
from locomotion.human.simulation import SimulatedPerson
from locomotion.human.state import MOVING, Gait, HumanState, Status, hash_of, restore_physics, save_physics
from locomotion.paths.follower import Way
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.paths.tracking import new_track
from locomotion.recovery.on_all_fours import OnAllFours, too_steep_around
from locomotion.skills.interface import ClearingSkill
from locomotion.skills.run_up import ObstacleRun

__all__ = ["MovingPerson"]

_SETTLING = 600  # ticks in which a person that has stopped walking comes to rest
_FALL_TICKS = 100  # a fallen body is simulated for this long, then held


class MovingPerson(SimulatedPerson):
    """``on_feet``: how it walks and runs. ``way``: the path that it follows. ``status``, ``events``: see
    `locomotion.human.human.Human`, which decides what they do."""

    def __init__(
        self,
        ground: Ground | None,
        on_feet: OnFeet,
        clearing: Sequence[ClearingSkill],
    ) -> None:
        super().__init__(ground)
        self.on_feet, self.way = on_feet, Way()
        self._command = np.zeros(4)
        self.events: list[Event] = []
        self._obstacle_run = ObstacleRun(clearing, on_feet.run_skill)
        self._fours = OnAllFours(self.model, self.index)
        self._ticks = 0
        self._ended_at = 0  # tick at which it fell or stopped
        self.status: Status = "standing"
        middle = np.zeros(3) if ground is None else 0.5 * (ground.low + ground.high)
        self._place(middle, 0.0, 0.0)

    @property
    def clearing(self) -> tuple[ClearingSkill, ...]:
        """How it clears obstacles."""
        return self._obstacle_run.skills

    @property
    def ticks(self) -> int:
        """Ticks made since the person was made."""
        return self._ticks

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
        return self.on_feet.at_rest(self._control) or stopped > _SETTLING

    @property
    def gait_now(self) -> Gait:
        """How it moves now: "walk" (or stand), "run", "slow run" on its way from a run to a walk, or
        "scramble" (or getting up)."""
        if self._fours.active:
            return "scramble"
        if self.on_feet.walks:
            return "walk"
        return "run" if self.on_feet.runs else "slow run"

    @property
    def arc_length(self) -> float:
        """Length of the path behind the person [m]."""
        return self.way.arc_length

    @property
    def lateral_error(self) -> float:
        """Distance of the centre of mass to the left of the path [m]."""
        return self.way.lateral

    @property
    def pace(self) -> float:
        """Share of its planned speed at which it goes."""
        return self.way.pace

    @property
    def path(self) -> NDArray[np.float64]:
        """(n, 3) float64 [m]: the path that it follows or followed last."""
        return self.way.points

    @property
    def obstacle_ahead(self) -> ObstacleAhead | None:
        """The next obstacle on its path, or the one that it clears now."""
        return self._obstacle_run.ahead

    def way_back(self) -> NDArray[np.float64] | None:
        """(k, 3) [m] the points of its way behind it, back to the obstacle that it has cleared last, see
        `Way.way_back`."""
        return self.way.way_back(self._obstacle_run.passed)

    # --- saving
    @property
    def memories(self) -> tuple[NDArray[np.float64], ...]:
        """What its parts remember from tick to tick, apart from the few things that are no numbers."""
        memories = self._control, self._command, self.on_feet.walk, self.way.memory
        return *memories, self._fours.memory, self._obstacle_run.plan

    def save_state(self) -> HumanState:
        """Everything needed to continue from here."""
        feet, way, run = self.on_feet, self.way, self._obstacle_run
        return HumanState(
            np.concatenate((*self.memories, save_physics(self.model, self.data))), feet.slowing, feet.brakes,
            feet.hurries, self._fours.mood, way.path, way.interrupted, way.back_to, run.obstacles,
            None if run.at_work is None else run.at_work.copy(), self.status, self._ticks, self._ended_at,
            tuple(self.events),
        )  # fmt: skip

    def become(self, state: HumanState) -> None:
        """Be as it was, or will be, in a state of a person on the same ground with the same skill. Raises
        `LocomotionError`, and changes nothing, if it belongs to another model, or is no such state."""
        if not isinstance(state, HumanState):
            raise LocomotionError(f"a person goes on from a HumanState, not from a {type(state).__name__}")
        memories, end = self.memories, 0
        restore_physics(self.model, self.data, state.numbers[sum(map(len, memories)) :])
        for memory in memories:
            begin, end = end, end + len(memory)
            memory[:] = state.numbers[begin:end]
        feet, way, run = self.on_feet, self.way, self._obstacle_run
        feet.slowing, feet.brakes, feet.hurries = state.slowing, state.brakes, state.hurries
        self._fours.mood = state.on_all_fours
        way.path, way.interrupted, way.back_to = state.path, state.interrupted, state.back_to
        run.obstacles, run.at_work = state.obstacles, None if state.skill is None else state.skill.copy()
        self.status, self._ticks, self._ended_at = state.status, state.ticks, state.ended_at
        self.events[:] = state.events

    def state_hash(self) -> str:
        """Hex digest of the physical and mental state; equal for equal runs."""
        state = self.save_state()
        mood = np.array([state.slowing, state.brakes, state.hurries, *state.on_all_fours, state.back_to])
        skill = np.empty(0) if state.skill is None else state.skill
        return hash_of(self.status, [state.numbers, mood, skill])

    def _place(self, position: NDArray[np.float64], yaw: float, speed: float) -> None:
        self._fours.leave()
        walk = self.on_feet.walk
        if speed == 0.0 and too_steep_around(self.ground, position):
            self._fours.crouch(self._lookup, self.data, position, yaw)
            self._control[:] = controller.new_state()
            observe(self.index, self.model, self.data, self._control, fresh=True)
            walk[:] = new_walk(yaw)
        elif speed > 0.0:
            run = self.on_feet.run_skill
            reset_running(run, self.model, self.data, self.index, self._control, position, yaw, speed)
            walk[WALKS] = 0.0
        else:
            plant(self.model, self.data, self.index, self._lookup, self._control, walk, position, yaw)
        self._command[:] = yaw, speed, 0.0, 0.0
        self.on_feet.slowing, self.on_feet.brakes = 0.0, False
        self.way.memory[:] = new_track()

    def _end(self, status: Status, event: Event) -> None:
        self.status = status
        self._ended_at = self._ticks
        self.events.append(event)
