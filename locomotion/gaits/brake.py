"""Braking from a run to a stand, as short as it goes: the run's parameters while it brakes, and the first
steps of the walk that takes over.

The reference speed falls so fast that the run plants its next foot far ahead and leans back. As soon as the
capture point is within the reach of a foot that bears the body, the walk takes over, with gains of its own
for each of its first steps. Unlike slowing down (`locomotion.gaits.slow_down`) it does not hold always, so
that it is rehearsed before it is done.
"""

import os
from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np
from annotated_types import Ge, Le

from locomotion.body.learned_file import RELEARN, read_skill
from locomotion.body.person import person_digest
from locomotion.data import SKILLS
from locomotion.gaits.run import controller
from locomotion.gaits.run.skill import RunSkill
from locomotion.gaits.slow_down import ChangesHeader, changes, slowed_tables, touchdown
from locomotion.gaits.walk.layout import GAINS
from locomotion.gaits.walk.skill import WalkSkill
from surefoot.files.archive import write_archive
from surefoot.files.schema import Schema

__all__ = ["BRAKE_SKILL", "BRAKING", "FIRST_STEPS", "SLOWEST", "BrakeSkill", "load_brake_skill"]

BRAKE_SKILL = SKILLS / "brake.npz"
BRAKING = 2.4
"""[m/s^2] at which a person that brakes comes to a stand, on the whole."""
FIRST_STEPS = 3
"""Steps of the walk that have gains of their own."""
SLOWEST = 0.3
"""[m/s] to which the reference speed falls."""
_BORNE = 100.0  # [N] under a foot that bears the body


@dataclass(frozen=True, eq=False)
class BrakeSkill:
    """How a running person brakes.

    Attributes:
        knots: (k,) float64, increasing speeds [m/s].
        change: (k, p) float64, what is added there to the parameters of the run
            (`run_layout.PARAMETERS`).
        gains: (FIRST_STEPS, len(GAINS)) float64 of the walk's first steps.
        deceleration: [m/s^2] by which the reference speed falls.
        reach: [m] that the capture point is ahead of the foot at most, for the walk to take over.
        hold: [s] after a touchdown from which it may.
        meta: what made it.
    """

    knots: np.ndarray
    change: np.ndarray
    gains: np.ndarray
    deceleration: float
    reach: float
    hold: float
    meta: dict[str, Any] = field(default_factory=dict)

    def run_tables(self, run: RunSkill) -> tuple[np.ndarray, ...]:
        """The first arguments of `controller.run_tick` while braking from ``run``."""
        return slowed_tables(run, self.knots, self.change, SLOWEST)

    def walk_tables(self, walk: WalkSkill) -> tuple[np.ndarray, ...]:
        """``walk.tables`` for each of the first steps."""
        return tuple(np.vstack([gains, walk.tables[1:]]) for gains in self.gains)

    def can_walk_on(self, state: np.ndarray) -> bool:
        """Whether the walk can take over a person that brakes now; ``state``: the running controller's."""
        foot = controller.CONTACT.start + (1 if state[controller.STANCE] > 0.0 else 0)
        if state[controller.STEP_TIME] < self.hold or state[foot] < _BORNE:
            return False
        return touchdown(state)[0] < self.reach

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the skill for the present person; the file appears whole or not at all."""
        header = {"person": person_digest(), "gains": list(GAINS), "meta": self.meta}
        header |= {"deceleration": self.deceleration, "reach": self.reach, "hold": self.hold}
        arrays = {"knots": self.knots, "change": self.change, "gains": self.gains}
        write_archive(path, BRAKE_FILE.kind, BRAKE_FILE.version, header, arrays)


class _BrakeHeader(ChangesHeader):
    deceleration: Annotated[float, Ge(0.0), Le(100.0)]
    reach: Annotated[float, Ge(-10.0), Le(10.0)]
    hold: Annotated[float, Ge(0.0), Le(10.0)]


BRAKE_FILE = Schema("brake skill", 1, _BrakeHeader, changes(FIRST_STEPS, len(GAINS)), RELEARN)


def load_brake_skill(path: str | os.PathLike[str] = BRAKE_SKILL) -> BrakeSkill:
    """Read a brake skill; `LocomotionError` if it is missing, cut off, of another version or another
    person."""
    header, arrays = read_skill(path, BRAKE_FILE)
    return BrakeSkill(
        **arrays, deceleration=header.deceleration, reach=header.reach, hold=header.hold, meta=header.meta
    )
