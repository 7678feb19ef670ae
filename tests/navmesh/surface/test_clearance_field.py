"""How far a point, or a line, is from where walking ends, between the centres of cells."""

import math

import numpy as np
import pytest

from navmesh.graph.kernel_arrays import net_of
from navmesh.graph.snapping import snap
from navmesh.surface.clearance_field import gap_at, stretch_gap, walk
from navmesh.surface.net import NET, NO_GRAPH
from navmesh.surface.storeys import APART
from surefoot.kernels.bundles import Bundle
from tests.navmesh.routes.path_references import (
    FIELD_ERROR,
    build,
    dense_walk,
    gap_of,
    pillars,
    pillars_level,
)
from tests.navmesh.shapes import box, join, plane


@pytest.mark.parametrize("storeys", [1, 2])
@pytest.mark.parametrize("seed", range(3))
def test_walking_the_field_agrees_with_tiny_steps(seed: int, storeys: int) -> None:
    rng = np.random.default_rng(seed)
    level = pillars_level(pillars(rng, 7))
    if storeys == 2:  # another floor under a part of this one: discs end over it and beside it
        level = join(level, plane(0.0, 9.0, 0.0, 14.0, -4.0))
    graph = build(*level)
    surface, net = graph.surface, net_of(graph)
    for _ in range(20):
        cell = int(rng.integers(len(surface)))
        ix, iy = divmod(int(surface.cell_column[cell]), surface.shape[1])
        a = (np.array([ix, iy]) + rng.uniform(0.05, 0.95, 2)) * surface.resolution
        b = a + rng.uniform(-4.0, 4.0, 2)
        reached, end, gap = dense_walk(surface, cell, a, b, 2e-3)
        fast = walk(net, cell, *a, *b, 0.3, True)
        assert fast[0] == reached
        if reached:
            assert fast[1] == end
            if gap < 0.3:
                assert fast[2] == pytest.approx(gap, abs=0.03)
            else:
                assert fast[2] > 0.27
            x, y = a + fast[3] * (b - a)
            if fast[2] < 0.3:
                assert fast[2] == pytest.approx(math.hypot(x - fast[4], y - fast[5]), abs=1e-9)
                assert divmod(int(surface.cell_column[fast[6]]), surface.shape[1]) == (
                    int(x // surface.resolution),
                    int(y // surface.resolution),
                )


def test_the_gap_to_a_wall_is_right_off_the_centres() -> None:
    graph = build(*join(plane(0.0, 8.0, 0.0, 8.0), box(3.0, 5.0, 3.0, 5.0, 0.0, 2.5)))
    net, origin = net_of(graph), graph.surface.origin
    rng = np.random.default_rng(3)
    for point in rng.uniform(1.0, 7.0, (200, 2)):
        true = gap_of([(3.0, 5.0, 3.0, 5.0)], point[None], 8.0)[0]
        if true > 0.2:
            node, cell, x, y = snap(net, *(point - origin[:2]), -origin[2], 0.1, 1.0, 1.0, 0.2)
            assert node >= 0
            gap = gap_at(net, cell, x, y)[0]
            assert true - 1e-9 <= gap <= true + FIELD_ERROR


def test_of_two_equally_near_blockers_the_first_counts_however_often_it_is_asked() -> None:
    """Zones give cells lists of their own, which say the same while these are open."""
    rng = np.random.default_rng(1)
    column = np.array([0, 1, 9], np.int32)  # the cell, and those beside it in +y and in +x
    storey = np.full((3, 4), APART, np.uint8)
    storey[0, 0] = storey[0, 1] = storey[1, 3] = storey[2, 2] = 0
    for off, ahead in rng.uniform(0.1, 0.9, (50, 2)):
        blocker = np.repeat([[off, ahead], [off, ahead], [-off, ahead]], 2, axis=0).reshape(3, 4)
        told = []
        for source in ((0, 0, 2), (0, 1, 2)):
            field = Bundle(
                NET, cell=0.25, nx=2, ny=9,
                column_start=np.searchsorted(column, np.arange(11)).astype(np.int32),
                milestone=np.array([0, 9], np.int32), storey=storey, nearest=np.zeros((3, 2)),
                clearance=np.ones(3), choice=np.zeros(3, np.uint8), source=np.array(source, np.int32),
                list_cell=np.arange(3, dtype=np.int32), list_start=np.arange(4, dtype=np.int32),
                blocker=blocker, **NO_GRAPH,
            )  # fmt: skip
            told.append(stretch_gap(field, 0, 0, -1.0, -1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.05, 2.0))
        assert told[0] == told[1]
        assert told[0][2] == off
