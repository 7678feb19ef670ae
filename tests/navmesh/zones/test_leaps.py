"""Links end where a blocked zone is in their way."""

import numpy as np
import pytest

from navmesh import NodeGraph
from navmesh.zones.leaps import link_room
from tests.navmesh.shapes import box, plane, terrain

SKILLS = {"jump": (0.3, 0.7), "drop": (0.3, 2.0), "vault": (0.6, 1.0)}


def square(x0: float, x1: float, y0: float, y1: float, z: float) -> list:
    return [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)]


@pytest.mark.parametrize(
    ("zone", "lets"),
    [
        (square(5.2, 6.8, 0.0, 4.0, 0.5), 0.0),  # they land in it
        (square(2.0, 4.95, 0.0, 4.0, 0.0), 0.0),  # they start in it
        ([(5.0, 0.0, 0.0), (5.0, 4.0, 0.0)], 0.0),  # it is right under the rim
        (square(8.5, 9.5, 0.0, 1.0, 0.5), 1.0),  # elsewhere
    ],
)
def test_links_over_what_is_blocked_are_closed(zone, lets):
    level = terrain(plane(0, 14, 0, 4), box(5, 14, 0, 4, 0, 0.5))
    graph = NodeGraph.build(level).with_zones({"zone": zone})
    start, goal = (1.0, 2.0, 0.0), (12.0, 2.0, 0.5)
    before = graph.find_path(start, goal, skills=SKILLS)
    assert before.status == "complete" and before.links
    graph.block("zone")
    after = graph.find_path(start, goal, skills=SKILLS)
    routes = graph.find_paths([start], [goal], skills=SKILLS)
    assert after.status == routes.status[0] == ("complete" if lets else "partial")
    assert before.holds(graph) == bool(lets)
    if not lets:
        assert (link_room(graph)[[use.link for use in before.links]] < 0.3).all()
    plain = graph.without_zones().find_path(start, goal, skills=SKILLS)
    assert plain.status == after.status
    graph.open("zone")
    np.testing.assert_array_equal(graph.find_path(start, goal, skills=SKILLS).waypoints, before.waypoints)


def test_a_link_beside_what_is_blocked_lets_narrow_bodies_pass():
    """Zones on both sides leave a lane; who is wider than the lane cannot jump along it."""
    level = terrain(plane(0, 14, 0, 4), box(5, 14, 0, 4, 0, 0.5))
    lane = {"left": square(3.0, 7.0, 2.5, 4.0, 0.2), "right": square(3.0, 7.0, 0.0, 1.5, 0.2)}
    graph = NodeGraph.build(level).with_zones(lane)
    graph.block(*lane)
    ends = (1.0, 2.0, 0.0), (12.0, 2.0, 0.5)
    widths = {radius: graph.find_path(*ends, radius=radius, skills=SKILLS).status for radius in (0.3, 0.6)}
    assert widths == {0.3: "complete", 0.6: "partial"}
    graph.open("left")
    assert graph.find_path(*ends, radius=0.6, skills=SKILLS).status == "complete"


def test_other_storeys_are_not_concerned():
    level = terrain(plane(0, 14, 0, 4), box(5, 14, 0, 4, 0, 0.5), plane(0, 14, 0, 4, 4.0))
    graph = NodeGraph.build(level).with_zones({"above": square(2.0, 9.0, 0.0, 4.0, 4.0)})
    graph.block("above")
    route = graph.find_path((1.0, 2.0, 0.0), (12.0, 2.0, 0.5), skills=SKILLS)
    assert route.status == "complete" and route.links
    assert (link_room(graph) == graph.links.radius).all()
