"""How recorded motion takes over from another body: in the gait, and at its phase, that is most like that.

Feet are compared, and not joints: bodies whose knees are more or less bent put their feet down alike.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from locomotion.postures.step_order import AT_REST, Gait, gaits_for
from locomotion.recorded.footfalls import FEET
from locomotion.recorded.posing import posed
from locomotion.recorded.skeletons import skeleton
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.fading import STEP, faded

__all__ = ["go_on_from"]

_PHASES = 40  # that a body which is taken over is compared with
_AHEAD = 0.03  # [s] for which velocities count as much as places


class _Person(Protocol):
    """Members as of `locomotion.recorded_people.person.RecordedPerson`."""

    @property
    def index(self) -> int: ...
    @property
    def row(self) -> NDArray[np.float64]: ...
    def qpos_at(self, ahead: float) -> NDArray[np.float64]: ...
    def fade(self, old: NDArray[np.float64], old_rates: NDArray[np.float64]) -> None: ...


class _People(Protocol):
    """Members as of `locomotion.recorded_people.people.RecordedPeople`."""

    gaits: tuple[Gait, ...]
    stand: int

    def begin_at(self, index: int, place: NDArray[np.float64], velocity: NDArray[np.float64]) -> None: ...
    def lay_feet_of(self, index: int, pose: NDArray[np.float64]) -> None: ...


def go_on_from(
    person: _Person,
    people: _People,
    pose: NDArray[np.float64],
    pose_rates: NDArray[np.float64],
    place: NDArray[np.float64],
    velocity: NDArray[np.float64],
) -> None:
    """As `locomotion.recorded_people.person.RecordedPerson.go_on_from`."""
    row = person.row
    people.begin_at(person.index, place, velocity)
    speed = float(np.hypot(*velocity))
    row[at.SPEED] = speed
    row[at.LAID] = 0.0  # legs as recorded
    row[at.GAIT], row[at.PHASE] = _motion_like(person, people, pose, pose_rates)
    people.lay_feet_of(person.index, pose)
    person.fade(pose, pose_rates)


def _motion_like(
    person: _Person, people: _People, pose: NDArray[np.float64], pose_rates: NDArray[np.float64]
) -> tuple[float, float]:
    """The number of the gait, and its phase, in which a person's feet are and move most as in ``pose``."""
    row = person.row
    speed = float(row[at.SPEED])
    if speed <= AT_REST:
        return -1.0, float(row[at.PHASE])
    able = [
        number
        for number, gait in enumerate(people.gaits)
        if gait.posture == people.stand and not gait.backwards and speed <= gait.fastest
    ]
    if not able:
        now, posture = np.array([-1], np.int32), np.array([people.stand], np.int32)
        able = gaits_for(people.gaits, now, posture, np.array([speed])).tolist()
    motions = [(gait, phase) for gait in able for phase in np.arange(_PHASES) / _PHASES]
    poses = [pose, faded(pose, STEP * pose_rates, pose_rates, 1.0, 0.0)]
    for row[at.GAIT], row[at.PHASE] in motions:
        poses += [person.qpos_at(0.0), person.qpos_at(STEP)]
    feet = _feet(np.array(poses)).reshape(-1, 2, 6)
    off = feet - feet[0]
    unlike = (off[1:, 0] ** 2).sum(axis=1)
    moved = (off[1:, 1] - off[1:, 0]) / STEP
    unlike += _AHEAD**2 * (moved**2).sum(axis=1)
    return motions[int(np.argmin(unlike))]


def _feet(poses: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 2, 3) [m] where feet are, in ``poses`` (n, 46)."""
    own = skeleton("full")
    bodies = posed(own, poses[:, 7 + own.joints], poses[:, :7])
    return bodies[:, [own.bodies.index(name) for name in FEET], :3]
