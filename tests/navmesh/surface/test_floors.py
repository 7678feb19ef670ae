"""Where there is floor: by its slope, the room above it, and whatever else the mesh holds."""

import math

import numpy as np
import pytest

from tests.navmesh.shapes import box, join, plane, quad
from tests.navmesh.surface.levels import build, parts


def test_storeys_above_each_other_are_apart_until_a_ramp_joins_them():
    storeys = (plane(0, 8, 0, 8), plane(0, 8, 0, 8, 3.0))
    ground, upper = (1, 1, 0), (1, 1, 3)
    graph = build(*storeys)
    assert len(graph.surface) == 2 * 32 * 32
    assert len(set(parts(graph, 0.3, ground, upper))) == 2
    ramp = quad((8, 0, 0), (14, 0, 3), (14, 2, 3), (8, 2, 0))
    landing = plane(14, 16, 0, 4, 3.0)
    bridge = plane(8, 14, 3, 4, 3.0)
    graph = build(*storeys, ramp, landing, bridge)
    assert len(set(parts(graph, 0.3, ground, upper))) == 1


@pytest.mark.parametrize(("degrees", "passes"), [(30, True), (44, True), (46, False)])
def test_slopes_end_at_the_limit(degrees, passes):
    rise = 4 * math.tan(math.radians(degrees))
    graph = build(
        plane(0, 4, 0, 4),
        quad((4, 0, 0), (8, 0, rise), (8, 4, rise), (4, 4, 0)),
        plane(8, 12, 0, 4, rise),
    )
    a, b = parts(graph, 0.6, (2, 2, 0), (10, 2, rise))
    assert (a == b) == passes


def test_low_ceiling_ends_the_floor_where_the_headroom_does():
    sloping = quad((2, -1, 3.0), (2, 5, 3.0), (8, 5, 1.0), (8, -1, 1.0))  # faces down; 2 m high at x = 5
    graph = build(plane(0, 8, 0, 4), sloping)
    assert graph.containing_node((6, 2, 0)) == -1
    assert graph.clearance_at((4.4, 2, 0)) == pytest.approx(0.6, abs=0.03)


def test_under_a_low_table_nobody_stands_and_on_it_one_does():
    graph = build(plane(0, 8, 0, 8), box(3, 5, 3, 5, 0.3, 0.35))
    assert graph.project((4, 4, 0.0))[1] == pytest.approx(0.35)
    a, b = parts(graph, 0.3, (1, 1, 0), (4, 4, 0.35))
    assert a == b


def test_duplicate_degenerate_and_backfacing_triangles_change_nothing():
    clean = [plane(0, 6, 0, 6), box(2, 3, 2, 3, 0, 2)]
    vertices, faces = join(*clean)
    spoilt = np.concatenate([faces, faces[:4], faces[:2, ::-1], [[0, 0, 1], [2, 2, 2]]])
    a, b = build((vertices, faces)), build((vertices, spoilt))
    np.testing.assert_array_equal(a.radii, b.radii)
    np.testing.assert_array_equal(a.edge_target, b.edge_target)
