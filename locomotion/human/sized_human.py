"""A simulated person of any size, in the measure of the world that it lives in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.avoidance.yielding import Course
from locomotion.body.person import CONTROL_DT
from locomotion.body_events import Event
from locomotion.human.human import Human
from locomotion.human.measure import Measure, resized
from locomotion.human.simulation import movements
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.paths.table import TrackingLimits
from locomotion.skills.interface import skill_ranges

__all__ = ["Glimpse", "SizedHuman", "movements_of"]

_Moment = tuple[NDArray[np.float64], float]
"""Joints (46,), and how long [s] it had stood then."""


class Glimpse(NamedTuple):
    """What it looks like at a tick of the world: at its own last tick, or a ``share`` of the way there from
    the one ``before``."""

    now: _Moment
    before: _Moment | None
    share: float


class SizedHuman:
    """What a person that is ``size`` times as large as usual does in the world.

    ``human`` is simulated in its own measure (`locomotion.human.measure`), on the level's ground in that
    measure, and has ticks of its own, which last √size times as long. What is a number without a unit, or an
    angle, can be asked of it directly.

    Attributes:
      owed: ticks of its own, 0 to 1, that it is behind the world.
    """

    def __init__(self, human: Human, size: float) -> None:
        self.become(human, size)

    def become(self, human: Human, size: float, owed: float = 0.0) -> None:
        """Go on as another person, or from another state of it."""
        self.human, self.size, self._measure = human, size, Measure(size)
        human.size, self.owed = size, owed
        self._before: _Moment | None = None

    # --- time
    def tick(self, since_foresees: bool) -> None:
        """Advance by 10 ms of the world, see `Human.tick`."""
        if self.size == 1.0:
            self.human.tick(since_foresees)
            return
        self.owed += 1.0 / self._measure.root
        while self.owed >= 1.0:
            self._before = self._moment()
            self.human.tick(since_foresees)
            self.owed, since_foresees = self.owed - 1.0, False

    @property
    def tick_seconds(self) -> float:
        """[s] that a tick of its own lasts in the world."""
        return self._measure.root * CONTROL_DT

    @property
    def time(self) -> float:
        """[s] since the person was made."""
        return self._measure.root * self.human.time

    def in_world(self, event: Event) -> Event:
        """An event of the person."""
        return self._measure.event(event)

    # --- where it is
    @property
    def position(self) -> NDArray[np.float64]:
        """As `Human.position`."""
        return self.size * self.human.position

    @property
    def velocity(self) -> NDArray[np.float64]:
        """As `Human.velocity`."""
        return self._measure.root * self.human.velocity

    def glimpse(self) -> Glimpse:
        """What it looks like now, for `pose`."""
        return Glimpse(self._moment(), self._before, self.owed)

    def _moment(self) -> _Moment:
        return self.human.qpos, self.human.idles_for

    def pose(self, glimpse: Glimpse | None = None) -> NDArray[np.float64]:
        """(46,) as `Human.pose`, now or when a ``glimpse`` was caught."""
        now, before, share = self.glimpse() if glimpse is None else glimpse
        pose = self.human.shown(now[0].copy(), now[1])
        if before is not None:
            pose = self.mixed(self.human.shown(before[0].copy(), before[1]), pose, share)
        pose[:3] *= self.size
        return pose

    def mixed(
        self, one: NDArray[np.float64], other: NDArray[np.float64], share: float
    ) -> NDArray[np.float64]:
        """A ``share`` of the way from pose ``one`` (46,) to the ``other``."""
        model, mixed = self.human.model, one.copy()
        change = np.empty(model.nv)
        mujoco.mj_differentiatePos(model, change, 1.0, one, other)
        mujoco.mj_integratePos(model, mixed, change, share)
        return mixed

    def rates(self) -> NDArray[np.float64]:
        """(45,) how fast the pose changes: of the root [m/s], and turning in the world [rad/s]; joints
        [rad/s]. Zero while held."""
        if self.human.held:
            return np.zeros(45)
        qvel, turning, root = self.human.data.qvel, np.zeros(3), self._measure.root
        mujoco.mju_rotVecQuat(turning, qvel[3:6], self.human.qpos[3:7])
        return np.concatenate([root * qvel[:3], turning / root, qvel[6:45] / root])

    def transforms(self, pose: NDArray[np.float64], bodies: int) -> NDArray[np.float64]:
        """(bodies, 7): position [m] and quaternion (w, x, y, z) of each of the first in a ``pose`` (46,)."""
        joints = self.human.data.qpos
        now = joints.copy()
        joints[:] = pose
        joints[:3] /= self.size
        transforms = self.human.body_transforms()[1 : 1 + bodies]
        joints[:] = now
        transforms[:, :3] *= self.size
        return transforms

    # --- its way
    @property
    def arc_length(self) -> float:
        """As `Human.arc_length`."""
        return self.size * self.human.arc_length

    @property
    def lateral_error(self) -> float:
        """As `Human.lateral_error`."""
        return self.size * self.human.lateral_error

    @property
    def path(self) -> NDArray[np.float64]:
        """As `Human.path`."""
        return self.size * self.human.path

    @property
    def obstacle_ahead(self) -> ObstacleAhead | None:
        """As `Human.obstacle_ahead`."""
        ahead = self.human.obstacle_ahead
        return None if ahead is None else resized(ahead, self.size)

    def own(self, obstacle: ObstacleAhead) -> ObstacleAhead:
        """An obstacle of the world, as the person is told of it."""
        return resized(obstacle, 1.0 / self.size)

    @property
    def ranges(self) -> Mapping[str, tuple[float, float]]:
        """As `skill_ranges` of the skills that it has."""
        own = skill_ranges(self.human.clearing)
        return {kind: (self.size * low, self.size * high) for kind, (low, high) in own.items()}

    @property
    def limits(self) -> TrackingLimits:
        """What it can follow at a run."""
        return self._measure.limits(self.human.on_feet.limits)

    def course(self) -> Course | None:
        """As `Human.course`."""
        course = self.human.course()
        return None if course is None else self._measure.course(course)

    def prospect(self) -> Course | None:
        """As `Human.prospect`."""
        course = self.human.prospect()
        return None if course is None else self._measure.course(course)

    @property
    def waited(self) -> float:
        """[s] for which it has given way without headway."""
        return self._measure.root * self.human.follower.waited

    def way_back(self) -> NDArray[np.float64] | None:
        """As `Human.way_back`."""
        back = self.human.way_back()
        return None if back is None else self._measure.evenly(self.size * back)

    @property
    def backs(self) -> float:
        """[m] that it goes back at least, to let others by."""
        return self.size * self.human.follower.backs

    # --- what it is told
    def reset(self, place: NDArray[np.float64], yaw: float) -> None:
        """Let it stand at ``place`` (3,) [m], see `Human.reset`."""
        self.human.reset(place / self.size, yaw)
        self.become(self.human, self.size)

    def follow(
        self,
        path: NDArray[np.float64],
        speed: float,
        obstacles: Sequence[ObstacleAhead] = (),
        hesitates: float = 0.0,
    ) -> None:
        """As `Human.follow`."""
        root = self._measure.root
        own = tuple(self.own(each) for each in obstacles)
        self.human.follow(path / self.size, speed / root, own, hesitates / root)

    def push(self, force: NDArray[np.float64], seconds: float) -> None:
        """As `Human.push`: it weighs as much as its size to the power of three says."""
        own = max(seconds / self._measure.root, CONTROL_DT)
        self.human.push(force / self.size**3, own)

    def give_way(self, pace: float, shift: NDArray[np.float64] | None) -> None:
        """As `Human.give_way`."""
        self.human.give_way(pace, None if shift is None else self._measure.shift(shift))

    def make_room(self, far: float) -> None:
        """Go ``far`` [m] back, and then on again."""
        human = self.human
        human.follower.make_room(far / self.size, human.on_feet.walk_limits, human.ticks)


def movements_of(people: Sequence[SizedHuman]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """As `locomotion.human.simulation.movements`, of people of any sizes on the same level."""
    places, velocities = np.empty((len(people), 3)), np.empty((len(people), 3))
    for size in {each.size for each in people}:
        those = [k for k, each in enumerate(people) if each.size == size]
        own = movements([people[k].human.simulation for k in those])
        places[those], velocities[those] = size * own[0], Measure(size).root * own[1]
    return places, velocities
