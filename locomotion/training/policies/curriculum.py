"""What a policy learns, in which order."""

import math
from dataclasses import dataclass, field

from locomotion.gaits.policy.law import CALM

__all__ = ["STANDING", "WALKING", "Stage"]


@dataclass(frozen=True)
class Stage:
    """A part of learning; all that it asks is drawn uniformly.

    Attributes:
      name: what it is about.
      samples: decisions to learn from.
      speeds: least and greatest speed asked for [m/s].
      turn: greatest turn rate [rad/s].
      push: greatest force at the waist [N], for 0.1 s, every 3 s on average.
      slope: greatest slope along and across [rise over run].
      stand: share of the orders that are to stand.
      ends_at_rest: whether people who have come to rest are done, and people who are to stand at the
        beginning set off: standing is another policy's.
      calm: [m/s] above which the cycle does not stop (`law.CALM`). Where that is limited, to come to rest
        with the feet crossed or far apart is worth less.
      changes: whether orders change, every 3 s on average.
      noise: standard deviation of what is tried, at the stage's beginning and at its end.
      timestep: of the physics [s].
      longest: decisions after which everybody begins anew.
      weights: of the terms of the reward (`rewards.TERMS`), where they differ from `rewards.WEIGHTS`.
    """

    name: str
    samples: int
    speeds: tuple[float, float]
    turn: float = 0.0
    push: float = 0.0
    slope: float = 0.0
    stand: float = 0.0
    ends_at_rest: bool = False
    calm: float = math.inf
    changes: bool = False
    noise: tuple[float, float] = (0.2, 0.2)
    timestep: float = 0.005
    longest: int = 400
    weights: dict[str, float] = field(default_factory=dict)


_CAREFUL = {"impact": -0.3, "slide": 0.0, "slip": -1.2, "early": -0.25}
_QUIET = {"impact": -0.6, "slide": 0.0, "slip": -2.0, "early": -0.25, "absent": -0.15}

WALKING = (
    Stage(
        "first steps", 1_500_000, (0.9, 1.5), noise=(0.2, 0.15), weights={"impact": 0.0, "slide": -0.4},
    ),
    Stage(
        "all speeds", 5_000_000, (0.4, 2.0), turn=0.8, push=200.0, slope=0.04, changes=True,
        noise=(0.15, 0.08), longest=500,
    ),
    Stage(
        "start and stop", 2_500_000, (0.4, 2.0), turn=0.8, push=300.0, slope=0.04, stand=0.25,
        ends_at_rest=True, changes=True, noise=(0.08, 0.06), longest=500, weights=_CAREFUL,
    ),
    Stage(
        "quiet", 2_400_000, (0.4, 2.0), turn=0.8, push=300.0, slope=0.05, stand=0.2, ends_at_rest=True,
        changes=True, noise=(0.06, 0.04), longest=500, weights=_QUIET,
    ),
    Stage(
        "rest", 1_300_000, (0.4, 2.0), turn=0.8, push=200.0, slope=0.04, stand=0.5, ends_at_rest=True,
        calm=CALM, changes=True, noise=(0.06, 0.04), longest=500, weights=_QUIET,
    ),
    Stage(
        "fine physics", 600_000, (0.4, 2.0), turn=0.8, push=300.0, slope=0.05, stand=0.35, ends_at_rest=True,
        calm=CALM, changes=True, noise=(0.04, 0.04), timestep=0.0025, longest=500, weights=_QUIET,
    ),
)  # fmt: skip
"""Walking at 0.4 to 2 m/s, setting off and coming to rest."""

STANDING = (
    Stage(
        "stand", 700_000, (0.0, 0.0), push=80.0, slope=0.03, stand=1.0, noise=(0.1, 0.05), longest=250,
        weights={"slip": -1.0, "slide": 0.0},
    ),
    Stage(
        "stand, pushed", 400_000, (0.0, 0.0), push=160.0, slope=0.03, stand=1.0, noise=(0.05, 0.04),
        timestep=0.0025, longest=400, weights={"slip": -1.0, "slide": 0.0, "change": -0.3},
    ),
)  # fmt: skip
"""Standing, also after the walk came to rest."""
