"""Whether a route can still be gone after the level has changed."""

import numpy as np

from navmesh import NodeGraph, join_chunks
from navmesh.routes.route_validity import line_holds
from tests.navmesh.pieces import SKILLS, piece
from tests.navmesh.shapes import plane, terrain


def test_routes_are_told_whether_they_hold():
    level = {f"{i},0": piece("floor", (i, 0)) for i in range(4)}
    graph = NodeGraph.build(join_chunks(level))
    across = graph.find_path((1, 2, 0), (15, 2, 0), 0.3)
    short = graph.find_path((1, 2, 0), (3, 2, 0), 0.3)
    assert across.holds(graph)
    walled = graph.update({"2,0": piece("wall", (2, 0))})
    assert not across.holds(walled)
    assert short.holds(walled)
    assert across.holds(walled.update({"2,0": level["2,0"]}))
    gone = graph.update({"3,0": None})
    assert not across.holds(gone)
    assert not gone.find_path((1, 2, 0), (9, 2, 0.0), 40.0).holds(gone)


def test_routes_over_obstacles_hold_as_long_as_these_are_there():
    level = {"0": piece("floor", (0, 0)), "1": piece("fence", (1, 0)), "2": piece("floor", (2, 0))}
    graph = NodeGraph.build(join_chunks(level))
    over = graph.find_path((1, 2, 0), (11, 2, 0), 0.3, SKILLS)
    assert [graph.links.affordance[use.link] for use in over.links] == ["vault"]
    assert over.holds(graph.update({"2": piece("platform", (2, 0))})) is False
    assert over.holds(graph.update({"far": terrain(plane(0, 4, 8, 12))}))
    assert not over.holds(graph.update({"1": piece("wall", (1, 0))}))


def test_a_line_holds_where_the_body_has_room_all_along_it():
    graph = NodeGraph.build(join_chunks({"a": piece("floor", (0, 0)), "b": piece("wall", (1, 0))}))
    along, across = np.array([[1.0, 0.5, 0], [3.0, 3.0, 0]]), np.array([[1.0, 1.0, 0], [7.0, 1.0, 0]])
    assert line_holds(graph, along, 0.4) and not line_holds(graph, along, 0.6)
    assert not line_holds(graph, across, 0.3)
