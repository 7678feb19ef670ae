"""The coarse graph joins what the fine graph joins, and its lengths are those of fine routes."""

import networkx
import numpy as np
import pytest

from navmesh.graph.open_to_body import parts_of
from navmesh.streaming import coarse_graph
from navmesh.streaming.coarse_graph import coarse_graph_of
from tests.navmesh.streaming.worlds import RADII, SIDE, WORLDS, whole


def on_foot(coarse):
    """Regions and terminals, joined as members and edges join them."""
    graph = networkx.Graph()
    graph.add_nodes_from(("region", r) for r in range(len(coarse.part)))
    graph.add_nodes_from(("terminal", t) for t in range(len(coarse.place)))
    for r in range(len(coarse.part)):
        own = coarse.terminals_of(r).tolist()
        graph.add_edges_from((("region", r), ("terminal", t)) for t in own)
    return graph


@pytest.mark.parametrize("radius", RADII)
@pytest.mark.parametrize("kind", WORLDS)
def test_regions_are_joined_just_if_the_fine_graph_joins_them(kind, radius):
    graph = whole(kind)
    coarse, region = coarse_graph_of(graph, radius, SIDE)
    part = parts_of(graph, radius)[0]
    inside = region >= 0
    assert inside[graph.radii >= radius].all()
    fine = {(int(r), int(p)) for r, p in zip(region[inside], part[inside], strict=True)}
    assert len(fine) == len(coarse.part), "a region is of one part"
    square = np.floor(graph.positions[inside, :2] / SIDE)
    assert len(np.unique(np.column_stack([region[inside], square]), axis=0)) == len(coarse.part)
    for group in networkx.connected_components(on_foot(coarse)):
        assert len({int(coarse.part[r]) for what, r in group if what == "region"}) <= 1
    of_part = dict(fine)
    joined = networkx.node_connected_component
    ways = on_foot(coarse)
    for r in range(len(coarse.part)):
        mine = {q for what, q in joined(ways, ("region", r)) if what == "region"}
        assert mine == {q for q in range(len(coarse.part)) if of_part[q] == of_part[r]}


@pytest.mark.parametrize("kind", WORLDS)
def test_the_edges_of_a_region_join_all_of_its_terminals_also_of_large_ones(kind, monkeypatch):
    monkeypatch.setattr(coarse_graph, "NEAREST", 3)
    monkeypatch.setattr(coarse_graph, "AROUND", 2)
    coarse, _ = coarse_graph_of(whole(kind), RADII[0], SIDE)
    for r in range(len(coarse.part)):
        own = set(coarse.terminals_of(r).tolist())
        ways = networkx.Graph()
        ways.add_nodes_from(own)
        for t in own:
            targets = coarse.edge_target[coarse.edge_start[t] : coarse.edge_start[t + 1]].tolist()
            ways.add_edges_from((t, other) for other in targets if other in own)
        assert not own or networkx.is_connected(ways)


@pytest.mark.parametrize("radius", RADII)
@pytest.mark.parametrize("kind", WORLDS)
def test_lengths_are_those_of_routes_there_or_back(kind, radius):
    graph = whole(kind)
    coarse, _ = coarse_graph_of(graph, radius, SIDE)
    assert (graph.find_paths(coarse.place, coarse.place, radius).status == "complete").all()
    source = np.repeat(np.arange(len(coarse.place)), np.diff(coarse.edge_start))
    there = graph.find_paths(coarse.place[source], coarse.place[coarse.edge_target], radius)
    back = graph.find_paths(coarse.place[coarse.edge_target], coarse.place[source], radius)
    assert (there.status == "complete").all()
    straight = np.linalg.norm(coarse.place[source] - coarse.place[coarse.edge_target], axis=1)
    expected = np.maximum([there.length, back.length], straight)  # ends are moved to a place again
    assert np.abs(coarse.edge_length - expected).min(axis=0).max() <= 1e-4
    assert np.abs(expected - [there.length, back.length]).max() <= 0.1


@pytest.mark.parametrize("radius", RADII)
@pytest.mark.parametrize("kind", WORLDS)
def test_no_link_from_one_region_to_another_is_lost(kind, radius):
    graph = whole(kind)
    coarse, region = coarse_graph_of(graph, radius, SIDE)
    links = graph.links
    label = graph.label[links.start_cell], graph.label[links.end_cell]
    ends = [np.where(each >= 0, region[each], -1) for each in label]
    fits = (links.radius >= radius) & (ends[0] >= 0) & (ends[1] >= 0) & (ends[0] != ends[1])
    expected = {
        (int(ends[0][k]), int(ends[1][k]), str(links.affordance[k]), float(links.height[k]))
        for k in np.flatnonzero(fits)
    }
    kinds, heights = coarse.leap_kind.tolist(), coarse.leap_height.tolist()
    found = set(zip(coarse.leap_from.tolist(), coarse.leap_to.tolist(), kinds, heights, strict=True))
    assert found == expected
    source = np.repeat(np.arange(len(coarse.place)), np.diff(coarse.leap_start))
    for leap in range(len(coarse.leap_target)):
        assert source[leap] in coarse.terminals_of(coarse.leap_from[leap])
        assert coarse.leap_target[leap] in coarse.terminals_of(coarse.leap_to[leap])


def test_the_levels_of_these_tests_have_what_they_are_about():
    """Several regions in a part, parts apart, borders and links across them."""
    for kind in WORLDS:
        coarse, _ = coarse_graph_of(whole(kind), RADII[0], SIDE)
        assert len(coarse.part) > coarse.part.max() + 1 > 1, kind
    coarse, _ = coarse_graph_of(whole("pieces"), RADII[0], SIDE)
    assert len(coarse.leap_kind) > 20 and len(set(coarse.leap_kind.tolist())) >= 3
