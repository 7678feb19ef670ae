"""What zones have to do with a graph."""

import numpy as np

from benchmarks.apartments import apartment
from navmesh import NodeGraph
from navmesh.zones.distances import segments_to_outline
from navmesh.zones.dividing import divide
from tests.navmesh.shapes import plane, terrain
from tests.navmesh.zones.alike import assert_alike


def test_discs_that_a_zone_reaches_into_are_those_that_it_breaks():
    level = apartment(2, 8)
    graph = NodeGraph.build(level.terrain, obstacle_rules=None)
    made = divide(graph, level.doors, set())
    users = made.switches
    place = (graph.positions - graph.surface.origin)[:, :2]
    for zone, outline in enumerate(level.doors.values()):
        flat = np.ascontiguousarray((outline - graph.surface.origin)[:, :2])
        away = segments_to_outline(flat, np.column_stack([place, place]))
        rows = slice(users["user_start"][zone], users["user_start"][zone + 1])
        broken = users["whole"][users["user"][rows][users["user_cut"][rows] == 1]]
        # through a wall nothing reaches; edges break a disc from a little farther
        assert set(broken) <= set(np.flatnonzero(away < graph.radii + 1.0))
        straight = [node for node in np.flatnonzero(away < graph.radii - 1e-6) if graph.cast_ray(
            graph.positions[node], np.append(outline[:, :2].mean(axis=0), 0.0)).clear]  # fmt: skip
        assert len(straight) and set(straight) <= set(broken)
        near = users["around"][users["around_start"][zone] : users["around_start"][zone + 1]]
        assert set(users["whole"][users["user"][rows]]) <= set(near)
        assert set(np.flatnonzero(away < 2.0 * graph.radii)) <= set(near)


def test_rows_are_the_cells_of_discs_that_can_be_broken():
    level = apartment(2, 9)
    graph = NodeGraph.build(level.terrain, obstacle_rules=None)
    made = divide(graph, level.doors, set())
    users = made.switches
    owner = users["whole"][users["row_user"]]
    np.testing.assert_array_equal(graph.label[users["row_cell"]], owner)
    assert len(users["row_cell"]) == np.isin(graph.label, users["whole"]).sum()
    np.testing.assert_array_equal(users["row_cell"][users["cell_row"][users["row_cell"]]], users["row_cell"])
    beside = graph.label[graph.surface.link[users["row_cell"]]]
    linked = graph.surface.link[users["row_cell"]] >= 0
    outside = np.unique(beside[linked & (beside >= 0) & ~np.isin(beside, users["whole"])])
    np.testing.assert_array_equal(made.fringe, outside)
    row, way = np.nonzero(linked & (beside != owner[:, None]))
    cell = users["row_cell"][row]
    at_rim = np.column_stack([cell, way, graph.surface.link[cell, way]])
    assert set(map(tuple, users["rim"])) == set(map(tuple, at_rim))
    assert (made.surface.clearance == graph.surface.clearance).all()
    assert made.surface.storey is not graph.surface.storey


def test_pieces_do_not_depend_on_the_order_in_which_zones_were_blocked():
    """Two bars of one disc, the one in none of the cells whose width the other changes."""
    bars = {"a": [(1.0, 2.0, 0.0), (1.0, 4.0, 0.0)], "b": [(5.0, 2.75, 0.0), (5.75, 2.75, 0.0)]}
    base = NodeGraph.build(terrain(plane(0, 6, 0, 4)))
    one, other = base.with_zones(bars), base.with_zones(bars)
    one.block("a", "b")
    other.block("b", "a")
    assert_alike(one, other)
