"""Walking through tight bends."""

import math

import numpy as np
import pytest

from locomotion import MOVING, Human
from locomotion.gaits.limits import walk_limits
from locomotion.gaits.walk.layout import SUDDEN, USUAL_SPEED, WALK_HEADING, new_walk
from locomotion.gaits.walk.skill import load_walk_skill
from locomotion.gaits.walk.steps import follow
from locomotion.paths.table import SPEED
from locomotion.paths.tracking import make_path

_STRAIGHT = 2.0  # [m] before the circle


def circles(radius, side, rise=0.0):
    """A straight stretch and three circles to one side, which rise by ``rise`` [m] per metre."""
    angle = np.linspace(0.0, 6.0 * math.pi, 400)
    start = np.linspace(-_STRAIGHT, -0.05, 20)
    x = np.concatenate([start, radius * np.sin(angle)])
    y = np.concatenate([0.0 * start, side * radius * (1.0 - np.cos(angle))])
    z = np.concatenate([0.0 * start, rise * radius * angle])
    return np.column_stack([x, y, z])


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("speed", [0.8, USUAL_SPEED])
def test_walks_three_circles_of_half_a_metre_at_walking_speed(speed, side):
    """A walk is 0.8 m/s and faster. Its centre of mass stays within 0.2 m of the circle."""
    for seed in range(4):
        human = Human(clearing=())
        human.reset((-_STRAIGHT, 0.0, 0.0), 0.0)
        human.data.qvel[:] += 0.02 * np.random.default_rng(seed).normal(size=human.model.nv)
        human.follow(circles(0.5, side), speed)
        ticks = []
        while human.status in MOVING and human.time < 60.0:
            human.tick()
            if _STRAIGHT + 0.5 < human.arc_length < _STRAIGHT + 3.0 * math.pi - 1.0:
                ticks.append(human.arc_length)
                assert abs(human.lateral_error) < 0.2
        assert human.status == "arrived"
        assert (ticks[-1] - ticks[0]) / (0.01 * len(ticks)) > 0.8


@pytest.mark.parametrize(("radius", "fastest"), [(0.3, 0.6), (0.5, 0.8), (2.0, 1.1)])
def test_a_tight_bend_is_walked_more_slowly_on_a_slope(radius, fastest):
    limits = walk_limits(load_walk_skill())
    level, slope = (
        make_path(circles(radius, 1.0, rise), USUAL_SPEED, limits, 0.0, walk=limits).table[:, SPEED]
        for rise in (0.0, 0.1)
    )
    middle = slice(len(level) // 2, len(level) // 2 + 5)
    assert (slope[middle] < level[middle]).all()
    assert (level[middle] < fastest).all()


def test_what_is_told_at_once_is_turned_to_more_slowly_than_a_bend():
    """Up to the same 40 degrees, at 0.8 m/s."""
    turned = []
    for in_a_bend in (True, False):
        walk, told = new_walk(), 0.0
        for _ in range(200):
            follow(walk, 0.0, 0.8, 0.0)
        for _ in range(70):
            told = min(told + 0.01, 0.7) if in_a_bend else 0.7
            follow(walk, told, 0.8, 0.0)
            assert not (in_a_bend and walk[SUDDEN] > 0.0)
        while walk[WALK_HEADING] < 0.6:
            follow(walk, told, 0.8, 0.0)
        turned.append(float(walk[SUDDEN]))
    assert turned[0] == 0.0 < turned[1]
