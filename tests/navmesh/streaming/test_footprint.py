"""The footprint says where a body can be as the cells of the fine graph do."""

from math import inf

import numpy as np
import pytest

from navmesh.graph.kernel_arrays import net_of
from navmesh.streaming.coarse_graph import coarse_graph_of
from navmesh.streaming.footprint import FLAT, footprint_of
from tests.navmesh.streaming.worlds import RADII, SIDE, WORLDS, whole


@pytest.mark.parametrize("kind", WORLDS)
def test_every_cell_in_which_the_body_fits_is_in_a_run_of_its_region(kind):
    graph = whole(kind)
    net_of(graph)
    surface, radius = graph.surface, RADII[0]
    _, region = coarse_graph_of(graph, radius, SIDE)
    found = footprint_of(graph, radius, region)
    row = np.repeat(np.arange(surface.shape[0]), np.diff(found.row_start))
    size = found.last - found.first + 1
    run = np.repeat(np.arange(len(size)), size)
    step = np.arange(len(run)) - np.repeat(np.cumsum(size) - size, size)
    column = row[run] * surface.shape[1] + found.first[run] + step
    height = found.height[run] + found.slope[run] * step * surface.resolution
    fits = np.flatnonzero((surface.clearance >= radius) & (graph.label >= 0))
    there = {}  # by column: the heights and regions
    for k in range(len(run)):
        there.setdefault(int(column[k]), []).append((float(height[k]), int(found.region[run[k]])))
    heights, columns = surface.height, surface.cell_column
    for cell in fits.tolist():
        expected = heights[cell], region[graph.label[cell]]
        assert any(
            abs(high - expected[0]) <= FLAT + 1e-4 and which == expected[1]
            for high, which in there[int(columns[cell])]
        )
    assert len(fits) <= len(run) < len(fits) + 0.2 * len(surface)
    assert np.unique(np.stack([column, np.round(height, 3)]), axis=1).shape[1] == len(run)


@pytest.mark.parametrize("kind", WORLDS)
def test_the_nearest_place_is_that_of_a_search_through_all_runs(kind):
    graph, rng = whole(kind), np.random.default_rng(5)
    _, region = coarse_graph_of(graph, RADII[0], SIDE)
    found = footprint_of(graph, RADII[0], region)
    cell = graph.surface.resolution
    row = np.repeat(np.arange(graph.surface.shape[0]), np.diff(found.row_start))
    high = np.ptp(graph.positions, axis=0)
    for limits in ((1.0, 2.7, 0.2), (inf, inf, 0.0)):
        allowed = rng.random(region.max() + 1) < 0.5
        for point in rng.uniform(-3.0, high + 3.0, (60, 3)):
            x = (row + 0.5) * cell
            y = np.clip(point[1], (found.first + 0.5) * cell, (found.last + 0.5) * cell)
            z = found.height + found.slope * (y - (found.first + 0.5) * cell)
            flat = np.hypot(x - point[0], y - point[1])
            off = np.hypot(flat, np.maximum(np.abs(z - point[2]) - limits[2], 0.0))
            ok = allowed[found.region] & (flat <= limits[0]) & (np.abs(z - point[2]) <= limits[1])
            which, place, distance = found.nearest(cell, point, limits, allowed)
            if not ok.any():
                assert which < 0
                continue
            best = np.flatnonzero(ok)[np.argmin(off[ok])]
            assert distance == pytest.approx(off[best], abs=1e-9)
            assert allowed[which] and abs(distance - np.min(off[ok & (found.region == which)])) < 1e-9
            assert np.hypot(*(place - point)[:2]) <= limits[0] + 1e-9
