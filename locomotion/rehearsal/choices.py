"""What a person has to choose from at each decision that it rehearses, and how long a trial of it takes.

Each list begins with what holds most often, or with the smallest change of what was learned.
"""

import itertools
from collections.abc import Sequence

import numpy as np

from locomotion.body.person import CONTROL_DT

__all__ = [
    "BALKINGS",
    "BRAKINGS",
    "ENDINGS",
    "HASTES",
    "HOLDS",
    "HOLDS_FULLY",
    "REHEARSALS",
    "RESTS_IN",
    "RUNS_ON",
    "RUN_UPS",
    "SETTING_OFF",
    "SETTLED",
    "SLIPPERY_SLOWINGS",
    "SLOWINGS",
    "STEPPINGS",
    "STEPS_IN",
    "WALKS_IN",
    "clears_in",
]

_RUNS = 3.0  # [m/s] about
_MARKS, _ENTRIES = (0.0, 0.04, -0.04, 0.08, -0.08), (0.0, 0.1, -0.1, 0.2, -0.2)


def _nearest_first(*spans: Sequence[float]) -> tuple[tuple[float, ...], ...]:
    """All combinations of numbers, smallest changes first."""
    greatest = [max(span) for span in spans]
    choices = itertools.product(*spans)
    return tuple(sorted(choices, key=lambda choice: float(np.hypot.reduce(np.divide(choice, greatest)))))


REHEARSALS = 16
"""Default for the most variations tried for one decision."""
RUN_UPS = _nearest_first(_MARKS, _ENTRIES)
"""Variations of a run-up: take-off mark farther from the obstacle [m], faster entry [m/s]."""
SETTING_OFF = tuple((quickly, run_up, 0.0) for run_up in RUN_UPS[:3] for quickly in (True, False))
"""Ways to begin the run towards an obstacle: whether to accelerate quickly, the variation of the run-up, and
[m/s] by which the run's reference begins faster than the person walks. Only a few, because it may as well
begin at its next step."""
HASTES = tuple(
    (quickly, (0.0, faster), ahead)
    for quickly, faster, ahead in (
        (True, 0.0, 0.25), (True, 0.0, 0.0), (True, -0.4, 0.5), (False, 0.0, 0.0), (True, -0.8, 0.25),
        (True, 0.0, 0.5), (False, -0.4, 0.25), (False, 0.0, 0.25), (True, -0.4, 0.0), (True, -0.4, 0.25),
    )
)  # fmt: skip
"""The same for one that walks slowly, with too little room for the entry speed: slower entries, and
references that begin faster. What holds most often comes first, then what holds where that does not."""
SLOWINGS = (1.0, 0.92, 1.08, 0.84, 1.16, 0.76, 1.24, 0.68, 1.32, 0.6, 1.4)
"""[m/s^2] by which the run's reference speed is lowered."""
SLIPPERY_SLOWINGS = tuple(sorted(SLOWINGS, key=lambda slowing: abs(slowing - 0.68)))
"""The same on slippery ground, where the feet slide away ahead of one that slows down quickly."""
ENDINGS = (True,)
"""The way to end a run as learned."""
BALKINGS = (1.2, 0.9, 1.6, 0.7, 2.2, 3.0)
"""[m/s^2] the same as `SLOWINGS` for aborting a run-up: harder ones hold as well, and the obstacle is
near."""
BRAKINGS = (2.5, 2.8, 2.0, 2.3, 1.65, 1.3, 0.9)
"""How hard it brakes, relative to what was learned; those that hold most often come first."""
STEPPINGS = (
    (0.0, 0.0), (0.05, 0.0), (-0.05, 0.0), (0.0, 0.08), (0.0, -0.08), (0.05, 0.08),
    (0.1, 0.0), (0.1, 0.08), (0.0, 0.15), (0.05, -0.08), (-0.05, 0.08), (0.15, 0.0),
)  # fmt: skip
"""Variations of a step on uneven ground: [s] added to its transfer and to its swing. Only a few, because
there are many steps: where these fail, others rarely succeed, and the next step may still save it."""
HOLDS, HOLDS_FULLY = 0.5, 1.0
"""Least score at which a run-up is begun and not aborted; and at which one of `HASTES` is begun."""
RUNS_ON, SETTLED = round(2.2 / CONTROL_DT), round(3.0 / CONTROL_DT)
"""Ticks that it must stay up running behind an obstacle; and after a change of gait."""
STEPS_IN, RESTS_IN = round(3.0 / CONTROL_DT), round(2.0 / CONTROL_DT)
"""Ticks of a trial that holds: of a step on uneven ground, of braking."""
WALKS_IN = SETTLED + round(1.0 / CONTROL_DT)
"""The same for slowing down to a walk."""


def clears_in(away: float) -> int:
    """The same for an obstacle ``away`` [m] ahead."""
    return round(away / _RUNS / CONTROL_DT) + RUNS_ON
