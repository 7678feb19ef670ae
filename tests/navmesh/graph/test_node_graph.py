"""The graph of a level depends on its shape only."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.navmesh.shapes import join
from tests.navmesh.surface.levels import build, random_level


@settings(max_examples=10, deadline=None, derandomize=True)
@given(st.integers(0, 10_000))
def test_order_of_triangles_does_not_matter(seed):
    vertices, faces = join(*random_level(seed))
    rng = np.random.default_rng(seed)
    a = build((vertices, faces))
    b = build((vertices, faces[rng.permutation(len(faces))]))
    for name in ("positions", "radii", "label", "edge_start", "edge_target", "edge_width", "edge_cells"):
        np.testing.assert_array_equal(getattr(a, name), getattr(b, name), err_msg=name)
    for name in ("height", "gradient", "link", "clearance"):
        np.testing.assert_array_equal(getattr(a.surface, name), getattr(b.surface, name), err_msg=name)


@settings(max_examples=6, deadline=None, derandomize=True)
@given(st.integers(0, 10_000), st.sampled_from([math.pi / 2, math.pi, 0.5, 2.2]))
def test_rotating_the_level_rotates_the_graph(seed, angle):
    vertices, faces = join(*random_level(seed))
    turn = np.array(
        [[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]]
    )
    a, b = build((vertices, faces)), build((vertices @ turn.T, faces))
    points = a.surface.centers()
    there = points @ turn.T
    wide = a.surface.clearance > 0.5  # the rim is sampled at other places
    difference = np.abs(a.clearance_at(points[wide]) - b.clearance_at(there[wide]))
    assert np.median(difference) < 0.02
    assert np.quantile(difference, 0.97) < 0.15
    assert a.radii.max() == pytest.approx(b.radii.max(), abs=0.25)


def test_far_from_the_origin_nothing_is_lost():
    here = build(*random_level(5))
    vertices, faces = join(*random_level(5))
    there = build((vertices + np.array([5000, -5000, 100]), faces))
    assert len(here) == len(there)
    np.testing.assert_allclose(here.radii, there.radii, atol=1e-6)
