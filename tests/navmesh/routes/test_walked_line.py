"""The line that string pulling builds: corners that the line of sight jumps over fall away."""

import numpy as np
import pytest

from navmesh.graph.kernel_arrays import make_scratch, net_of
from navmesh.graph.open_to_body import doors_of
from navmesh.routes.walked_line import append_corner
from navmesh.surface.clearance_field import cell_at
from tests.navmesh.routes.path_references import dense_walk, scene

RADIUS = 0.4


def fits(graph, cells, points, i: int, j: int) -> bool:
    reached, _, gap = dense_walk(graph.surface, int(cells[i]), points[i], points[j], 0.01)
    return reached and gap > 1.01 * RADIUS - 1e-3


@pytest.mark.parametrize("seed", range(2))
def test_the_line_stays_walkable_and_keeps_only_corners_of_what_was_added(seed: int) -> None:
    graph, rng = scene(seed, 9)
    net, scratch, doors = net_of(graph), make_scratch(graph), doors_of(graph, RADIUS, None, None)
    roomy = graph.surface.centers()[graph.surface.clearance > 1.5 * RADIUS] - graph.surface.origin
    dropped = 0
    for _ in range(12):
        added = [roomy[rng.integers(len(roomy))]]
        while len(added) < 6:  # each can be seen from the one before
            near = added[-1] + np.append(rng.uniform(-3.0, 3.0, 2), 0.0)
            cell = cell_at(net, *near)
            here = cell_at(net, *added[-1])
            if cell >= 0 and graph.surface.clearance[cell] > 1.5 * RADIUS:
                if fits(graph, [here], np.array([added[-1][:2], near[:2]]), 0, 1):
                    added.append(near)
        points, cells = scratch.points, scratch.cells
        points[0], cells[0] = added[0], cell_at(net, *added[0])
        count = 1
        for x, y, z in added[1:]:
            count = append_corner(net, doors, scratch, 0, count, x, y, cell_at(net, x, y, z))
        line = points[:count, :2].copy()
        assert all(fits(graph, cells, line, i, i + 1) for i in range(count - 1))
        assert {tuple(p) for p in line} <= {tuple(p[:2]) for p in added}
        assert (line[0] == added[0][:2]).all() and (line[-1] == added[-1][:2]).all()
        dropped += len(added) - count
    assert dropped > 5
