"""How far a person can run straight up to an edge."""

import numpy as np
import pytest

from locomotion.paths.run_up_room import LEAST_RUN_UP, cramped_links, straight_before
from tests.locomotion.paths.boxes import graph_of


def ledge(deep):
    """A floor of ``deep`` [m] before a step up of 0.4 m, and 12 m on top."""
    return graph_of(((0, 4 - deep, -1), (12, 4, 0)), ((0, 4, -1), (12, 16, 0.4)))


@pytest.mark.parametrize(("deep", "room"), [(3.0, 2.7), (5.0, 4.7), (9.0, 6.0)])
def test_the_floor_before_the_edge_counts_less_the_radius_up_to_the_most_asked_for(deep, room):
    graph = ledge(deep)
    found = straight_before(graph, 0.3, 6.0)
    assert len(found) == len(graph.links) > 0
    assert found == pytest.approx(np.full(len(found), room), abs=0.02)


def test_links_with_less_than_the_least_run_up_are_cramped():
    short, long = ledge(3.0), ledge(5.0)
    assert cramped_links(short, 0.3).tolist() == list(range(len(short.links)))
    assert cramped_links(short, 0.3) is cramped_links(short, 0.3)
    assert len(cramped_links(long, 0.3)) == 0 and len(cramped_links(long, 5.0 - LEAST_RUN_UP + 0.1))


def test_a_blocked_zone_takes_the_run_up_as_long_as_it_is_blocked():
    graph = ledge(9.0).with_zones({"gate": [(0.0, 1.0, 0.0), (12.0, 1.0, 0.0)]})
    assert len(cramped_links(graph, 0.3)) == 0
    graph.block("gate")
    shut = graph.without_zones()
    blocked = cramped_links(graph, 0.3)
    assert blocked.tolist() == list(range(len(graph.links))) == cramped_links(shut, 0.3).tolist()
    graph.open("gate")
    assert len(cramped_links(graph, 0.3)) == 0
    graph.block("gate")
    assert cramped_links(graph, 0.3) is blocked  # a door that shuts again is looked up


def test_a_level_without_links_has_no_cramped_ones():
    floor = graph_of(((0, 0, -1), (6, 6, 0)))
    assert straight_before(floor, 0.3, 6.0).shape == (0,) and len(cramped_links(floor, 0.3)) == 0
