"""Interfaces that a rehearsal needs of a body that chooses, and of one that runs ahead."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import PersonIndex
from locomotion.body_events import Event
from locomotion.human.on_feet import OnFeet
from locomotion.human.state import Gait, HumanState, Status
from locomotion.paths.follower import PathFollower
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.rehearsal.predicted import Predicted

__all__ = ["Chooser", "Decides", "Understudy"]


class Chooser(Protocol):
    """Actions to choose from, as in `locomotion.human.person.Person`."""

    def save_state(self) -> HumanState: ...
    def set_off(self, choice: tuple[bool, Sequence[float]], speed: float) -> None: ...
    def vary_run_up(self, choice: Sequence[float]) -> None: ...
    def balk(self, deceleration: float) -> None: ...
    def slow_down(self, deceleration: float) -> None: ...
    def brake(self, harder: float) -> None: ...
    def vary_step(self, longer: Sequence[float]) -> None: ...


class Decides(Protocol):
    """Members: as of `locomotion.rehearsal.deciding.Decider`."""

    answer: Any
    undecided: bool
    predicted: Predicted


class Understudy(Chooser, Protocol):
    """Members as in `locomotion.human.human.Human`."""

    events: list[Event]
    on_feet: OnFeet
    status: Status
    ticks: int
    follower: PathFollower

    @property
    def begins_run_up(self) -> bool: ...
    @property
    def com(self) -> NDArray[np.float64]: ...
    @property
    def control(self) -> NDArray[np.float64]: ...
    @property
    def data(self) -> mujoco.MjData: ...
    @property
    def decider(self) -> Decides: ...
    @property
    def decides_soon(self) -> bool: ...
    @property
    def gait_now(self) -> Gait: ...
    @property
    def held(self) -> bool: ...
    @property
    def hemmed_in(self) -> bool: ...
    @property
    def index(self) -> PersonIndex: ...
    @property
    def lateral_error(self) -> float: ...
    @property
    def model(self) -> mujoco.MjModel: ...
    @property
    def obstacle_ahead(self) -> ObstacleAhead | None: ...
    @property
    def velocity(self) -> NDArray[np.float64]: ...
    @property
    def yaw(self) -> float: ...
    def tick(self) -> None: ...
    def become(self, state: HumanState) -> None: ...
    def restore_state(self, state: HumanState) -> None: ...
