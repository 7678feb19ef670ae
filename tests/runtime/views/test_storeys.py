"""Levels of several storeys are drawn storey by storey."""

import dataclasses

import matplotlib.image
import numpy as np
import pytest

import navmesh
from runtime.planning.rules import person_walk_rules
from runtime.traces.recording import level_trace
from runtime.views.plot import plot_from_above
from runtime.views.storeys import cut_heights

SIZE = 12.0


def floors(heights, ramp=False):
    """Floors over one another, squares of 12 m; the ramp leads from the first to the second, outside."""
    quads = [[(0, 0, z), (SIZE, 0, z), (SIZE, SIZE, z), (0, SIZE, z)] for z in heights]
    if ramp:
        low, high = heights[:2]
        quads.append([(-12, 0, low), (0, 0, high), (0, 4, high), (-12, 4, low)])
    corners = np.array(quads, dtype=float).reshape(-1, 3)
    faces = [[4 * k + i for i in each] for k in range(len(quads)) for each in ((0, 1, 2), (0, 2, 3))]
    terrain = navmesh.Terrain.from_arrays(corners, np.array(faces))
    return level_trace(navmesh.NodeGraph.build(terrain, person_walk_rules()))


@pytest.mark.parametrize("heights", [(0.0,), (0.0, 3.0), (0.0, 2.4, 7.0), (-4.0, 0.0, 3.5, 6.5)])
def test_a_cut_lies_between_two_floors_and_there_is_no_other(heights):
    cuts = cut_heights(floors(heights))
    assert len(cuts) == len(heights) - 1
    for low, cut, high in zip(heights[:-1], cuts, heights[1:], strict=True):
        assert low < cut < high


def test_a_ramp_between_storeys_needs_no_cut_of_its_own():
    assert len(cut_heights(floors((0.0, 3.0), ramp=True))) == 1


def test_a_hill_and_a_staircase_are_one_storey():
    steps = np.arange(20)
    quads = [[(x, 0, 0.15 * x), (x + 1, 0, 0.15 * x), (x + 1, 4, 0.15 * x), (x, 4, 0.15 * x)] for x in steps]
    corners = np.array(quads, dtype=float).reshape(-1, 3)
    faces = [[4 * k + i for i in each] for k in steps for each in ((0, 1, 2), (0, 2, 3))]
    terrain = navmesh.Terrain.from_arrays(corners, np.array(faces))
    assert cut_heights(level_trace(navmesh.NodeGraph.build(terrain, person_walk_rules()))) == []


def test_the_way_through_the_lower_storey_is_drawn(trace, tmp_path):
    """A person under a roof on which one can walk: red of its path shows."""

    def red(level):
        path = tmp_path / "level.png"
        plot_from_above(dataclasses.replace(trace, level=level), path)
        picture = matplotlib.image.imread(path)[..., :3]
        return int(((picture[..., 0] > 0.7) & (picture[..., 1] < 0.3) & (picture[..., 2] < 0.3)).sum())

    assert red(floors((0.0, 3.0))) > 100
    assert red(floors((-3.0, 0.0))) > 100
