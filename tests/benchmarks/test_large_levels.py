"""The large levels of the benchmarks are what they say they are."""

import math

import numpy as np
import pytest

from benchmarks.large_levels import LARGE_LEVELS, large_level
from navmesh import NodeGraph, WalkRules


@pytest.mark.parametrize("kind", LARGE_LEVELS)
def test_a_size_and_a_seed_give_one_level(kind):
    one, same, other = (large_level(kind, 4, seed) for seed in (1, 1, 2))
    assert np.array_equal(one.vertices, same.vertices) and np.array_equal(one.faces, same.faces)
    assert not np.array_equal(one.vertices[: len(other.vertices)], other.vertices[: len(one.vertices)])


def test_a_city_is_flat_between_its_buildings():
    level = large_level("city", 2)
    assert np.ptp(level.vertices[:, :2], axis=0) == pytest.approx([60.0, 60.0])
    graph = NodeGraph.build(level, WalkRules(headroom=2.0), obstacle_rules=None)
    ground = np.abs(graph.surface.centers()[:, 2]) < 1e-9
    area = ground.sum() * graph.rules.resolution**2
    assert 3600.0 - 24 * 49.0 < area < 3600.0 - 12 * 4.0


def test_half_of_the_hills_is_steeper_than_40_degrees():
    level = large_level("hills", 300)
    a, b, c = level.vertices[level.faces].transpose(1, 0, 2)
    normal = np.cross(b - a, c - a)
    slope = np.degrees(np.arccos(normal[:, 2] / np.linalg.norm(normal, axis=1)))
    assert 0.45 < (slope > 40.0).mean() < 0.6


def test_clutter_has_open_edges_and_faces_that_look_the_other_way():
    level = large_level("clutter", 4)
    assert 4000 <= len(level.faces) < 4300
    edges = level.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    _, uses = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
    assert (uses == 1).mean() > 0.05 and math.isfinite(np.ptp(level.vertices))
