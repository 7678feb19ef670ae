"""What a policy learns, in which order."""

from dataclasses import dataclass, field

__all__ = ["CATCHING", "RUNNING", "STANDING", "WALKING", "Stage"]


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
      stand: share of the orders that are to come to rest. While the walk is learned these people step in
        place.
      stands: whether standing is learned, and not the walk. It is over for who has to make a step.
      runs: whether running is learned, and slowing down from it, and not the walk.
      from_starts: share of those who begin in one of the given states, if there are any.
      changes: [s] on average from one order to the next; 0: they do not change.
      traits: share of those who have a style of their own (`locomotion.gaits.policy.style`).
      steadies: whether people are helped not to creep away in place and to keep their speed, as in worlds.
      waits: whether the policy is not told to be faster while its body is too slow, as in worlds. That
        teaches a safe walk, but a slow one; without it the policy learns to keep up.
      noise: standard deviation of what is tried, at the stage's beginning and at its end.
      timestep: of the physics [s].
      fall: cost of a fall.
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
    stands: bool = False
    runs: bool = False
    from_starts: float = 0.0
    changes: float = 0.0
    traits: float = 0.0
    steadies: bool = False
    waits: bool = True
    noise: tuple[float, float] = (0.2, 0.2)
    timestep: float = 0.005
    fall: float = 0.0
    longest: int = 400
    weights: dict[str, float] = field(default_factory=dict)


_COARSE = 0.01  # [s] of physics: half as dear, and feet creep more
_CAREFUL = {"load": 0.4, "rise": 0.3, "impact": -0.4, "slip": -1.5, "change": -0.12}

WALKING = (
    Stage(
        "first steps", 1_600_000, (0.9, 1.5), noise=(0.2, 0.13), timestep=_COARSE,
        weights={"impact": 0.0, "slip": -0.3},
    ),
    Stage(
        "all speeds", 1_500_000, (0.3, 2.2), turn=0.8, push=200.0, slope=0.04, changes=3.0,
        noise=(0.14, 0.12), timestep=_COARSE, longest=500,
    ),
    Stage(
        "all orders", 3_000_000, (0.3, 2.2), turn=1.3, push=250.0, slope=0.04, stand=0.3, from_starts=0.3,
        changes=3.0, noise=(0.12, 0.09), timestep=_COARSE, longest=500,
    ),
    Stage(
        "careful", 6_000_000, (0.3, 2.2), turn=1.3, push=300.0, slope=0.05, stand=0.3, from_starts=0.3,
        changes=3.0, noise=(0.09, 0.045), longest=500, weights=_CAREFUL,
    ),
    Stage(
        "keeping up", 4_000_000, (0.3, 2.2), turn=1.3, push=300.0, slope=0.05, stand=0.3, from_starts=0.3,
        changes=3.0, waits=False, noise=(0.06, 0.045), longest=500, weights=_CAREFUL,
    ),
)  # fmt: skip
"""Walking at 0 to 2.2 m/s: 0 is to step in place, and to turn on the spot."""

_FIRM = {"speed": 0.2, "nears": 0.2, "impact": -0.3}

RUNNING = (
    Stage(
        "first strides", 1_200_000, (1.0, 4.5), turn=0.4, runs=True, from_starts=0.3, waits=False,
        noise=(0.2, 0.15), longest=300,
        weights={"speed": 0.125, "nears": 0.125, "impact": -0.1, "slip": -0.3},
    ),
    Stage(
        "all paces", 3_000_000, (1.0, 5.0), turn=0.8, push=150.0, runs=True, from_starts=0.4, changes=3.0,
        waits=False, noise=(0.15, 0.1), weights=_FIRM,
    ),
    Stage(
        "sure", 6_500_000, (1.0, 5.0), turn=1.0, push=300.0, slope=0.04, runs=True, from_starts=0.4,
        changes=3.0, waits=False, noise=(0.1, 0.07), weights=_FIRM,
    ),
    Stage(
        "keeping up", 8_000_000, (1.0, 5.3), turn=1.0, push=300.0, slope=0.05, runs=True, from_starts=0.4,
        changes=1.5, steadies=True, noise=(0.1, 0.075), fall=40.0, longest=600,
        weights={"speed": 0.4, "nears": 0.3, "catches": 0.6, "impact": -0.4, "pace": -1.5, "slip": -1.0},
    ),
    Stage(
        "by anybody", 10_000_000, (1.0, 5.3), turn=1.0, push=300.0, slope=0.05, runs=True, from_starts=0.4,
        changes=1.5, traits=0.5, steadies=True, noise=(0.1, 0.075), fall=40.0, longest=600,
        weights={
            "pose": 0.5, "feet": 0.3, "speed": 0.4, "nears": 0.3, "catches": 0.6, "impact": -0.8,
            "pace": -5.0, "slip": -1.5, "brush": -1.5,
        },
    ),
)  # fmt: skip
"""Running at 1 to 5.3 m/s, begun on the finished walk: setting off, slowing down, also out of a planned run,
keeping up with orders that change all the time, and by people who differ."""

STANDING = (
    Stage(
        "stand", 500_000, (0.0, 0.0), push=200.0, slope=0.04, stand=1.0, stands=True, from_starts=0.7,
        noise=(0.1, 0.06), timestep=_COARSE, longest=250, weights={"slip": -1.0},
    ),
    Stage(
        "stand, pushed", 1_500_000, (0.0, 0.0), push=300.0, slope=0.04, stand=1.0, stands=True,
        from_starts=0.7, noise=(0.06, 0.04), longest=1000, weights={"slip": -1.0, "change": -0.3},
    ),
)  # fmt: skip
"""Standing after the walk came to rest."""

_SOFT = {
    "pose": 0.5, "load": 0.6, "rise": 0.5, "impact": 0.0, "blow": -0.5, "slip": -2.0, "change": -0.1,
    "nears": 0.3, "catches": 0.6, "pace": -1.0,
}  # fmt: skip

CATCHING = (
    Stage(
        "thrown off a stand", 8_000_000, (0.3, 2.2), turn=1.3, push=300.0, slope=0.05, stand=0.3,
        from_starts=0.5, changes=2.5, traits=0.5, waits=False, noise=(0.1, 0.075), fall=40.0, longest=500,
        weights=_SOFT,
    ),
    Stage(
        "as in crowds", 5_000_000, (0.3, 2.0), turn=1.3, push=300.0, slope=0.05, stand=0.3,
        from_starts=0.4, changes=0.8, traits=0.5, steadies=True, noise=(0.09, 0.075), fall=40.0, longest=500,
        weights=_SOFT,
    ),
)  # fmt: skip
"""The walk once more, with softer steps, and with people whom a push has just thrown off their stand; then
under the rules of worlds, with orders that change as fast as in a crowd."""
