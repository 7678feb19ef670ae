"""Ground that the learned walk can go on, and ground that it cannot."""

import numpy as np
import pytest

from locomotion.gaits.policy.level_ground import floor_at, is_level
from locomotion.ground.ground import Ground, plane_lookup
from locomotion.paths.table import TrackingLimits
from locomotion.paths.tracking import make_path

WAY = make_path([[0.0, 0, 0], [10, 0, 0]], 1.0, TrackingLimits((0.3, 2.0)), 0.0)


def strips(*heights, width=4.0):
    """A ground along x whose height changes linearly from each ``(x, z)`` to the next."""
    corners = [[x, y, z] for x, z in heights for y in (-0.5 * width, 0.5 * width)]
    faces = [[2 * k, 2 * k + 2, 2 * k + 3] for k in range(len(heights) - 1)]
    faces += [[2 * k, 2 * k + 3, 2 * k + 1] for k in range(len(heights) - 1)]
    return Ground.from_arrays(np.array(corners), faces).lookup


def level(ground, begin=1.0, end=4.0, z=0.0):
    return is_level(ground, WAY.table, WAY.length, begin, end, z)


def test_a_plane_is_level_also_beyond_the_end_of_the_way():
    assert level(plane_lookup())
    assert level(plane_lookup(), 9.0, 12.0)


@pytest.mark.parametrize(
    ("heights", "holds"),
    [
        ([(-2, 0.0), (12, 0.0)], True),
        ([(-2, -0.06), (12, 0.36)], True),  # a slope of 3 %
        ([(-2, -0.2), (12, 1.2)], False),  # of 10 %
        ([(-2, 0.0), (3.0, 0.0), (3.001, 0.05), (12, 0.05)], False),  # a kerb
        ([(-2, 0.0), (5.0, 0.0), (5.001, 0.2), (12, 0.2)], True),  # farther than it looks
        ([(-2, 0.0), (3.0, 0.0)], False),  # nothing beyond
    ],
)
def test_slopes_kerbs_and_holes(heights, holds):
    assert level(strips(*heights), z=0.02 if heights[0][1] else 0.0) == holds


def test_a_ledge_beside_the_way_is_not_level():
    assert level(strips((-2, 0.0), (12, 0.0), width=0.6))
    assert not level(strips((-2, 0.0), (12, 0.0), width=0.4))


def test_the_floor_is_the_one_nearby():
    ground = strips((-2, 1.0), (12, 1.0))
    assert floor_at(ground, 0.0, 0.0, 1.2) == pytest.approx(1.0)
    assert np.isnan(floor_at(ground, 0.0, 0.0, 2.0))
    assert np.isnan(floor_at(ground, 0.0, 9.0, 1.0))
