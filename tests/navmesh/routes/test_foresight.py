"""Where a line leaves the discs that it goes through."""

import math

import numpy as np

from navmesh.graph.kernel_arrays import net_of
from navmesh.graph.open_to_body import doors_of
from navmesh.routes.foresight import _cell_of, _where_it_leaves, fetch_corners, fetch_line
from tests.navmesh.routes.path_references import scene

ROOM = 0.4


def test_the_column_is_that_of_the_last_place_inside_the_disc() -> None:
    graph, rng = scene(3, 9)
    net, surface = net_of(graph), graph.surface
    size = np.array(surface.shape) * surface.resolution
    places = graph.positions[:, :2] - surface.origin[:2]
    wide, met = np.flatnonzero(graph.radii > 2.0 * ROOM), 0
    for _ in range(400):
        node = int(rng.choice(wide))
        a, b = places[node] + rng.uniform(-1.5, 1.5, (2, 2))
        length = math.dist(a, b)
        u = (b - a) / length
        on = np.arange(0.0, length, 1e-3)
        line = a + on[:, None] * u
        inside = np.hypot(*(line - places[node]).T) < graph.radii[node] - ROOM
        found = _where_it_leaves(net, node, *a, *u, length, ROOM)
        if not inside.any():
            continue
        last = line[inside][-1]
        if not ((last > 0.01) & (last < size - 0.01)).all():
            continue
        ix, iy = divmod(found, surface.shape[1])
        corner = np.array([ix, iy]) * surface.resolution
        assert (last >= corner - 2e-3).all() and (last <= corner + surface.resolution + 2e-3).all()
        met += 1
    assert met > 100


def test_nothing_is_asked_for_where_there_is_no_line_and_no_disc() -> None:
    graph, _ = scene(3, 9)
    net, nodes = net_of(graph), np.arange(len(graph), dtype=np.int32)
    assert _where_it_leaves(net, 0, -1e4, -1e4, 1.0, 0.0, 5.0, ROOM) == -1
    for b in ((1.0, 1.0), (1e9, -1e9)):
        fetch_line(net, nodes, 0, len(nodes), 1.0, 1.0, *b, ROOM)


def test_the_cell_of_a_corner_is_that_of_its_end_of_the_portal() -> None:
    graph, _ = scene(3, 9)
    net, doors, surface = net_of(graph), doors_of(graph, ROOM, None, None), graph.surface
    edges = np.arange(len(doors.doors), dtype=np.int32)[::-1].copy()
    corners = np.arange(2 * len(edges), dtype=np.int32)
    for at in corners:
        door, side = int(edges[at // 2]), int(at % 2)
        x, y = doors.doors["portal"][door, 3 * side : 3 * side + 2]
        ix, iy = divmod(int(surface.cell_column[_cell_of(doors, edges, at)]), surface.shape[1])
        assert abs(x / surface.resolution - ix - 0.5) < 0.5 + 1e-6
        assert abs(y / surface.resolution - iy - 0.5) < 0.5 + 1e-6
    fetch_corners(net, doors, edges, corners, len(corners))
