"""What first queries would work out is there after `NodeGraph.prepare_like`, and answers are the same."""

from itertools import pairwise

import numpy as np

from benchmarks.large_levels import large_level
from navmesh import NodeGraph, join_chunks, split_terrain
from navmesh.graph import open_to_body

SKILLS = {"drop": (0.2, 8.0)}


def routes(graph, radius, skills, places):
    found = [graph.find_path(a, b, radius, skills) for a, b in pairwise(places)]
    return [(each.status, each.waypoints.tolist()) for each in found]


def test_bodies_that_were_asked_for_find_all_done(monkeypatch):
    chunks = split_terrain(large_level("city", 2, 3), 10.0)
    before = NodeGraph.build(join_chunks(chunks))
    places = before.random_points(np.random.default_rng(1), 12, 0.4)
    asked = (0.2, None), (0.4, SKILLS)
    for radius, skills in asked:
        routes(before, radius, skills, places)
    before.find_path(places[0], places[1], 0.3, link_costs=np.ones(len(before.links)))
    name = sorted(chunks)[7]
    after, other = before.update({name: None}), before.update({name: None})
    expected = [routes(other, radius, skills, places) for radius, skills in asked]
    after.prepare_like(before)
    assert {0.2, 0.3, 0.4} == set(after.cache["parts"])

    def nothing(*_):
        raise AssertionError("a query had something left to work out")

    for work in ("portals_for", "parts_of_nodes", "tiles_for", "_leaps_for"):
        monkeypatch.setattr(open_to_body, work, nothing)
    assert [routes(after, radius, skills, places) for radius, skills in asked] == expected


def test_with_zones_too():
    graph = NodeGraph.build(large_level("city", 2, 3))
    middle = graph.positions[int(np.argmax(graph.radii))]
    lane = {"lane": middle + np.array([[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0]])}
    one, two, asked = (graph.with_zones(lane) for _ in range(3))
    places = graph.random_points(np.random.default_rng(1), 12, 0.4)
    routes(asked, 0.4, SKILLS, places)
    one.prepare_like(asked)
    for each in (one, two):
        each.block("lane")
    assert routes(one, 0.4, SKILLS, places) == routes(two, 0.4, SKILLS, places)
