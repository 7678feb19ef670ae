"""Where walking ends is kept as segments, exact, from the triangles themselves."""

import numpy as np
import pytest

from tests.navmesh.shapes import box, plane, quad
from tests.navmesh.surface.levels import build, parts


def test_a_wall_without_thickness_is_never_missed():
    for x in np.linspace(3.9, 4.15, 11):
        wall = quad((x, 0, 0), (x, 4, 0), (x, 4, 2.5), (x, 0, 2.5))
        graph = build(plane(0, 8, 0, 4), wall)
        a, b = parts(graph, 0.15, (1, 2, 0), (7, 2, 0))
        assert a != b
        assert graph.clearance_at((x - 0.5, 2, 0)) == pytest.approx(0.5, abs=0.03)


def test_thin_pole_and_thin_beam_count():
    pole = box(4.1, 4.12, 2.1, 2.12, 0, 3)
    assert build(plane(0, 8, 0, 4), pole).clearance_at((4.11, 1.6, 0)) == pytest.approx(0.5, abs=0.06)
    beam = box(0, 8, 2.1, 2.12, 1.2, 1.22)
    a, b = parts(build(plane(0, 8, 0, 4), beam), 0.15, (4, 1, 0), (4, 3, 0))
    assert a != b


def test_segments_are_the_rim_of_the_floor_and_the_foot_of_a_wall():
    surface = build(plane(0, 6, 0, 6), box(2.3, 3.7, 2.3, 3.7, 0.0, 2.5)).surface
    ends = surface.blocker.reshape(-1, 2, 2) + surface.origin[:2]

    def off_square(points, low, high):
        """[m] from the outline of a square."""
        inside = np.minimum(points - low, high - points)
        return np.where((inside >= -1e-6).all(axis=-1), np.abs(inside).min(axis=-1), np.inf)

    off = np.minimum(off_square(ends, 0.0, 6.0), off_square(ends, 2.3, 3.7))
    assert len(ends) > 20 and off.max() < 1e-6
    assert (surface.blocker_start[1:] >= surface.blocker_start[:-1]).all()
    assert surface.blocker_start[-1] == len(surface.blocker)
