"""A person on hands and feet: scrambling where it is too steep to walk, and getting up after a fall.

    four = OnAllFours(model, index)
    four.fall(data)                                  # or four.crouch(...)
    while four.active:
        four.tick(lookup, command, data, stand=True)
        mujoco.mj_step(four.model, data, STEPS_PER_TICK)
        four.observe(lookup, data, observed)             # not active any more once it stands

Its memory is one array, `memory` (fields: `locomotion.recovery.layout`).
"""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.body.models import gentler, harder
from locomotion.body.person import PersonIndex
from locomotion.ground.ground import Ground
from locomotion.paths.command import ALONG_ASKED, HEADING_ASKED, SPEED_ASKED
from locomotion.paths.follower import PathFollower
from locomotion.paths.table import PathTable
from locomotion.recovery.getting_up import begin_to_fall, get_up_tick, rise_on
from locomotion.recovery.layout import AWAY, BORNE, FACING, MODE, RISEN, RISING, new_scramble
from locomotion.recovery.rising import begin_to_rise, gather, ready_to_rise, rise_tick, stands
from locomotion.recovery.scrambling import crouch, scramble_tick, steeper
from locomotion.recovery.senses import observe_scramble, parts_of

__all__ = ["OnAllFours", "too_steep_around"]

_SPEED = 0.15  # [m/s] of a person on hands and feet; faster it falls more often
_GAINS = np.array([0.5, 0.6, 0.05, 0.3, 0.8, 0.25])  # of `path_tracking.track`
_TOO_STEEP, _GENTLE = 0.45, 0.35  # slopes around a place where it is put on hands and feet; where it rises
_AROUND, _AHEAD = 1.2, 12.0  # [m] of the place; of its path
_LOOK = 0.4  # [m] ahead on its path to where it goes
_LOOKS_APART = 0.5  # [m] along its path: less than the radius of what `steeper` looks at
_NO_HEADWAY, _ROUND = 6.0, 0.7  # [s] without headway after which it goes [rad] off its way, facing ahead
_SLOW_HEADWAY = 0.8  # of the time on hands and feet does not count as being without headway


class OnAllFours:
    """``fell_at``: tick of its last fall; ``on_way``: 1 if it goes somewhere; ``gentle``: 1 where it can walk
    on."""

    def __init__(self, model: mujoco.MjModel, index: PersonIndex) -> None:
        self._model = model
        self._models: tuple[mujoco.MjModel, mujoco.MjModel] | None = None  # harder and gentler
        self._parts = parts_of(index, model)
        self.memory = new_scramble()
        self.fell_at, self.on_way, self.gentle = 0.0, 0.0, 0.0
        self.leave()

    @property
    def model(self) -> mujoco.MjModel:
        """The physics of a body that hands and feet move, or that falls."""
        if self._models is None:
            self._models = harder(self._model), gentler(self._model)
        return self._models[self.gentle > 0.0]

    @property
    def active(self) -> bool:
        """Whether it moves on hands and feet now."""
        return self.memory.item(MODE) != AWAY

    @property
    def borne(self) -> bool:
        """Whether it has come up on hands and feet."""
        return bool(self.memory[MODE] == BORNE and self.memory[RISEN] >= 1.0)

    @property
    def fallen(self) -> bool:
        """Whether it lies, or is about to."""
        return bool(AWAY < self.memory[MODE] < BORNE)

    @property
    def facing(self) -> float:
        """Direction that it faces [rad]."""
        return float(self.memory[FACING])

    def leave(self) -> None:
        """End its support of the body."""
        self.memory[MODE], self.gentle = AWAY, 0.0

    def fall(self, data: mujoco.MjData) -> None:
        """The body has fallen, in whatever position."""
        self.memory[:] = new_scramble()
        observe_scramble(self._parts, data, self.memory)
        begin_to_fall(self.memory, data.qpos, data.qvel)

    def crouch(
        self, lookup: tuple[NDArray, ...], data: mujoco.MjData, place: NDArray[np.float64], yaw: float
    ) -> None:
        """Put the person on hands and feet over the ground point ``place`` (3,), to go towards ``yaw``."""
        crouch(self._model, data, self._parts, lookup, self.memory, place, yaw)

    def look(self, ground: Ground | None, place: NDArray[np.float64], follower: PathFollower | None) -> None:
        """Check whether it can stand up at ``place`` (3,), and walk on with ``follower``. Once it can, only
        its way counts: it sways as it stands up."""
        path, arc = (None, 0.0) if follower is None else (follower.path, follower.arc)
        here = self.gentle > 0.0 or _gentle_here(ground, place)
        self.gentle = float(here and _gentle_ahead(ground, place, path, arc))

    def steer(
        self, follower: PathFollower | None, com: NDArray[np.float64], tick: int, command: NDArray
    ) -> None:
        """Write into ``command`` (4,) how it continues with ``follower``, None: it stays. com (3,) [m]."""
        if follower is None or follower.path is None:
            command[:] = self.facing, 0.0, 0.0, 0.0
            return
        table, (x, y, _) = follower.path.table, com.tolist()
        ahead = min(int((follower.arc + _LOOK) / follower.path.length * (len(table) - 1)), len(table) - 1)
        follower.track(_GAINS, x, y, _SPEED, tick, command)
        command[HEADING_ASKED] = math.atan2(table[ahead, 1] - y, table[ahead, 0] - x)
        command[SPEED_ASKED] = _SPEED
        command[ALONG_ASKED] = 0.0
        waits = follower.without_headway(tick) / (1.0 - _SLOW_HEADWAY)
        if waits > _NO_HEADWAY:
            command[HEADING_ASKED] += _ROUND if waits % (2.0 * _NO_HEADWAY) < _NO_HEADWAY else -_ROUND
            command[ALONG_ASKED] = 1.0
        follower.excuse(_SLOW_HEADWAY)

    def tick(
        self, lookup: tuple[NDArray, ...], command: NDArray[np.float64], data: mujoco.MjData, stand: bool
    ) -> None:
        """One control tick. ``command`` (4,): direction [rad] and speed [m/s]; ``stand``: whether to rise."""
        memory = self.memory
        if memory[MODE] < BORNE:
            get_up_tick(lookup, memory, data.qpos, data.qvel, data.ctrl)
        elif memory[MODE] == RISING:
            rise_tick(memory, data.qpos, data.ctrl)
        else:
            close = gather(memory, stand and self.borne)
            if close or memory[RISEN] < 1.0:
                command = np.array([memory[FACING], 0.0, 0.0, 0.0])
            scramble_tick(lookup, memory, command, data.qpos, data.qvel, data.ctrl)
            if close and ready_to_rise(memory):
                begin_to_rise(memory, data.qpos)

    def observe(
        self, lookup: tuple[NDArray, ...], data: mujoco.MjData, observed: NDArray[np.float64]
    ) -> bool:
        """After the physics: update its observations and ``observed`` (`locomotion.body.observed`). Returns
        whether it now stands, so that the walk can take over."""
        memory = self.memory
        observe_scramble(self._parts, data, memory, observed)
        if memory[MODE] >= BORNE:
            rise_on(lookup, memory, data.qpos, self.gentle > 0.0)
        return bool(memory[MODE] == RISING and stands(memory))

    @property
    def mood(self) -> tuple[float, float, float]:
        """Its memory besides ``memory``."""
        return self.fell_at, self.on_way, self.gentle

    @mood.setter
    def mood(self, mood: tuple[float, float, float]) -> None:
        self.fell_at, self.on_way, self.gentle = mood


def too_steep_around(ground: Ground | None, place: NDArray[np.float64]) -> bool:
    """Whether nobody can stand around ``place`` (3,)."""
    if ground is None or not ground.steep:
        return False
    around = np.linspace(0.0, 2.0 * math.pi, 8, endpoint=False)
    ring = place + _AROUND * np.stack([np.cos(around), np.sin(around), 0.0 * around], axis=1)
    return steeper(ground.lookup, np.vstack([place, ring]), _TOO_STEEP)


def _gentle_here(ground: Ground | None, place: NDArray[np.float64]) -> bool:
    """Whether a person can begin to stand up at ``place`` (3,)."""
    if ground is None or not ground.steep:
        return True
    return not (steeper(ground.lookup, place[None], _GENTLE) or too_steep_around(ground, place))


def _gentle_ahead(
    ground: Ground | None, place: NDArray[np.float64], path: PathTable | None, arc: float
) -> bool:
    """Whether a person at ``place`` (3,) can stand up and, if it has a ``path``, walk on from ``arc`` [m]."""
    if ground is None or not ground.steep:
        return True
    points = place[None]
    if path is not None:
        step = path.length / (len(path.table) - 1)
        rows = np.arange(arc, min(arc + _AHEAD, path.length) + 0.01, _LOOKS_APART) / step
        points = path.table[np.minimum(rows.astype(int), len(path.table) - 1), :3]
    return not steeper(ground.lookup, points, _GENTLE)
