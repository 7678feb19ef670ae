"""Walking up and down stairs, and flights of steps whose treads slope, at the pace that a person plans for
itself."""

import math

import numpy as np
import pytest

from locomotion import Human
from locomotion.footholds import moved, rise_over_steps, risen, steps_ahead, tread_shift
from locomotion.ground import Ground, extruded
from locomotion.human_state import MOVING
from locomotion.walk_layout import FOOTHOLD, GAINS, LIFT, SWING_TIME, first_gains, new_walk

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
    return Ground.from_arrays(*extruded(np.column_stack([x, z]), 3.0)), x, z


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


def stairs(riser, tread):
    """Seven steps up along x."""
    fronts = np.repeat(tread * np.arange(7), 2)
    x, z = np.concatenate([[-6.0], fronts, [12.0]]), np.repeat(riser * np.arange(8), 2)
    return Ground.from_arrays(*extruded(np.column_stack([x, z]), 3.0))


def walks_over(riser, tread, down, seed):
    start, aside = np.random.default_rng(seed).uniform((0.8, -0.2), (1.2, 0.2))
    along = np.arange(-start, 7.0 * tread + start, 0.25)
    height = riser * np.clip(np.floor(along / tread) + 1.0, 0.0, 7.0)
    way = np.column_stack([along, aside * along, height])[:: -1 if down else 1]
    human = Human(stairs(riser, tread), clearing=(), rehearsals=0)
    human.reset(way[0], math.atan2(*(way[1] - way[0])[[1, 0]]))
    human.follow(way, 1.0)
    while human.status in MOVING and human.time < 60.0:
        human.tick()
    return human.status == "arrived"


@pytest.mark.parametrize(
    ("riser", "tread", "down", "least"),
    [
        (0.12, 0.39, False, 9), (0.15, 0.33, False, 9), (0.17, 0.29, False, 8),
        (0.12, 0.39, True, 7), (0.15, 0.30, True, 6), (0.17, 0.29, True, 3),
    ],
)  # fmt: skip
def test_walks_over_stairs_as_people_build_them(riser, tread, down, least):
    """Who went as on level ground came up 5 of 20 flights with steps of 0.15 m and 2 of those of 0.17 m; who
    planned as if feet landed in time came down 5 of 20 with steps of 0.15 m by 0.3 m and 2 of 0.17 m."""
    assert sum(walks_over(riser, tread, down, seed) for seed in range(10)) >= least


@pytest.mark.parametrize(("riser", "tread"), [(0.12, 0.39), (0.17, 0.29), (0.2, 0.27)])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_foot_is_put_on_one_tread(riser, tread, way):
    """Its whole sole, by the ground's own heights, and one step up or down at most."""
    ground, walk = stairs(riser, tread), new_walk()
    walk[SWING_TIME] = 0.4
    for wished in np.linspace(0.1, 0.42, 17):
        stance = np.array([3.5 * tread, 0.1, 4.0 * riser])
        shift = tread_shift(first_gains(), ground.lookup, walk, stance, way, 0.0, wished, -0.2)
        along = stance[0] + way * (wished + shift)
        sole = np.column_stack(
            [along + way * np.linspace(-0.08, 0.12, 41), np.full(41, 0.1), np.full(41, 5.0)]
        )
        heights = ground.surface_below(sole)[0]
        assert np.ptp(heights) < 1e-9 and abs(heights[0] - stance[2]) < riser + 1e-9
        assert abs(shift) <= 0.22


def test_steps_are_seen_and_ramps_and_walls_are_not():
    here = np.array([-0.55, 0.0, 0.0])
    assert steps_ahead(stairs(0.15, 0.3).lookup, here, 1.0, 0.0) == pytest.approx(0.15 / 0.8)
    assert steps_ahead(stairs(0.15, 0.3).lookup, here + np.array([0.3, 0.0, 0.0]), 1.0, 0.0) == pytest.approx(
        0.3 / 0.8
    )
    assert steps_ahead(stairs(0.15, 0.3).lookup, here, -1.0, 0.0) == 0.0
    assert steps_ahead(stairs(0.5, 0.3).lookup, here, 1.0, 0.0) == 0.0
    corners = np.array([[-5, -5, -1.5], [5, -5, 1.5], [5, 5, 1.5], [-5, 5, -1.5]])
    ramp = Ground.from_arrays(corners, [[0, 1, 2], [0, 2, 3]])
    assert steps_ahead(ramp.lookup, np.zeros(3), 1.0, 0.0) == 0.0


@pytest.mark.parametrize(("riser", "tread"), [(0.12, 0.39), (0.17, 0.29)])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_foot_swings_over_the_edges_of_steps(riser, tread, way):
    ground, walk, gains = stairs(riser, tread), new_walk(), first_gains()
    clearance = gains[list(GAINS).index("clearance")]
    at = tread * (np.array([2.5, 4.5])[:: int(way)]) - 0.02 * way
    walk[LIFT], walk[FOOTHOLD] = [[x, 0.0, riser * (math.floor(x / tread) + 1)] for x in at]
    hump = rise_over_steps(gains, ground.lookup, walk, way, 0.0)
    for share in np.arange(0.3, 0.81, 0.1):
        x = at[0] + moved(share) * (at[1] - at[0])
        z = walk[LIFT][2] + risen(share, walk[FOOTHOLD][2] - walk[LIFT][2])
        z += (clearance + hump) * math.sin(math.pi * share)
        sole = [[x + way * u, 0.0, 5.0] for u in (-0.08, 0.0, 0.12)]
        assert z > ground.surface_below(np.array(sole))[0].max() + 0.01
