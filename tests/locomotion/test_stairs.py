"""Walking up and down flights of steps whose treads slope, at the pace that a person plans for itself."""

import math

import numpy as np
import pytest

from locomotion import Human
from locomotion.ground import Ground
from locomotion.human_state import MOVING

_STEPS, _RISE, _TREAD = 9, 0.12, 0.52  # number; [m] of each along the way: its front, and behind it
_LEVEL = 4.0  # [m] before and behind


def flight(slope, riser):
    """A flight that rises by ``slope`` in all, and its profile: the fronts of its steps are ``riser`` [m]
    high."""
    x, z = [-_LEVEL, 3.0], [0.0, 0.0]
    for _ in range(_STEPS):
        x += [x[-1] + _RISE, x[-1] + _RISE + _TREAD]
        z += [z[-1] + riser, z[-1] + slope * (_RISE + _TREAD)]
    x, z = np.array([*x, x[-1] + _LEVEL]), np.array([*z, z[-1]])
    n = len(x)
    vertices = np.concatenate([np.column_stack([x, np.full(n, y), z]) for y in (-3.0, 3.0)])
    low = np.arange(n - 1)
    faces = np.concatenate(
        [np.column_stack([low, low + 1, low + n + 1]), np.column_stack([low, low + n + 1, low + n])]
    )
    return Ground.from_arrays(vertices, faces), x, z


def arrives(slope, riser, down, seed):
    ground, x, z = flight(slope, riser)
    start, y = np.random.default_rng(seed).uniform(-0.5, 0.5, 2)
    along = np.linspace(start, x[-1] - 1.5 + start, 60)
    way = np.column_stack([along, np.full(60, y), np.interp(along, x, z)])[:: -1 if down else 1]
    human = Human(ground, clearing=(), rehearsals=0)
    human.reset(way[0], math.pi if down else 0.0)
    human.follow(way, 1.25)
    while human.status in MOVING and human.time < 60.0:
        human.tick()
    return human.status == "arrived"


@pytest.mark.parametrize(
    ("slope", "riser", "down"), [(0.42, 0.42 * _RISE, False), (0.42, 0.05, False), (0.36, 0.05, True)]
)
def test_goes_slowly_enough_on_a_steep_flight(slope, riser, down):
    """Who goes up at the pace of level ground falls nearly always."""
    assert sum(arrives(slope, riser, down, seed) for seed in range(12)) >= 8
