"""The graph of a level and the ground that bodies stand on are of the same triangles."""

import gc
import weakref

import numpy as np
import pytest

from benchmarks.giving_way import floor
from runtime.planning.level import Level


def test_its_ground_is_the_surface_of_its_graph(graph):
    level = Level.of(graph)
    assert level.graph is graph
    heights, _ = level.ground.surface_below(graph.positions + np.array([0.0, 0.0, 0.1]))
    assert heights == pytest.approx(graph.positions[:, 2])


def test_the_ground_of_a_graph_is_made_once_and_goes_with_it():
    graph = floor((0.0, 0.0, 2.0, 2.0))
    first, second = Level.of(graph), Level.of(graph)
    assert first is not second and first.ground is second.ground
    gone = weakref.ref(first.ground)
    del first, second, graph
    gc.collect()
    assert gone() is None


def test_each_world_has_a_level_of_its_own_which_changes():
    graph, other = floor((0.0, 0.0, 2.0, 2.0)), floor((0.0, 0.0, 4.0, 4.0))
    mine, yours = Level.of(graph), Level.of(graph)
    mine.graph, mine.ground = other, Level.of(other).ground
    assert yours.graph is graph and not np.array_equal(yours.graph.positions, mine.graph.positions)


def test_people_of_one_size_share_a_ground_in_their_measure(graph):
    level = Level.of(graph)
    assert level.ground_for(1.0) is level.ground
    small = level.ground_for(0.8)
    assert small is Level.of(graph).ground_for(0.8) and small is not level.ground_for(0.9)
    np.testing.assert_allclose(small.high, level.ground.high / 0.8)
