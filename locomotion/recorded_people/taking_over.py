"""How recorded motion takes over from another body: at the phase of its gait that is most like that."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import JOINT_NAMES
from locomotion.postures.step_order import Gait, gaits_for
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.fading import STEP, difference, rates

__all__ = ["go_on_from"]

_PHASES = 40  # that a body which is taken over is compared with
_AHEAD = 0.06  # [s] for which rates count as much as angles
_LEGS = np.array([k for k, name in enumerate(JOINT_NAMES) if "hip" in name or "knee" in name])


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
    now, posture = np.array([-1], np.int32), np.array([people.stand], np.int32)
    row[at.GAIT] = gaits_for(people.gaits, now, posture, np.array([speed]))[0]
    row[at.LAID] = 0.0  # legs as recorded
    if row[at.GAIT] >= 0.0:
        row[at.PHASE] = _phase_like(person, pose, pose_rates)
    people.lay_feet_of(person.index, pose)
    person.fade(pose, pose_rates)


def _phase_like(person: _Person, pose: NDArray[np.float64], pose_rates: NDArray[np.float64]) -> float:
    row = person.row
    least, best = np.inf, 0.0
    for phase in np.arange(_PHASES) / _PHASES:
        row[at.PHASE] = phase
        here = person.qpos_at(0.0)
        off = difference(pose, here)[6:][_LEGS]
        off_rates = (pose_rates - rates(here, person.qpos_at(STEP), STEP))[6:][_LEGS]
        unlike = float(off @ off + _AHEAD**2 * (off_rates @ off_rates))
        if unlike < least:
            least, best = unlike, float(phase)
    return best
