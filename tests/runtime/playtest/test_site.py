"""A level as one character meets it: its parts, and the ways between them."""

import numpy as np
import pytest
import trimesh

from benchmarks.planted_rooms import planted
from runtime.playtest.site import Site
from tests.runtime.playtest.levels import box, site_of


@pytest.mark.parametrize("name", ["narrow", "wide door", "two doors", "walled_off"])
def test_parts_are_what_the_graph_says_can_be_walked_to(name):
    for seed in range(3):
        hall = planted(np.random.default_rng([77, seed]), name)
        site = site_of(hall.mesh)
        graph, radius = site.graph, site.character.radius
        for node in np.flatnonzero(graph.radii >= radius + 0.05)[:40].tolist():
            walked = graph.reachable_nodes(graph.positions[node], radius=radius)
            assert np.array_equal(walked, np.flatnonzero(site.node_part == site.node_part[node]))


@pytest.fixture(scope="module")
def site():
    """A floor of 8 by 4 m before a platform of 0.5 m, and a floor that is apart."""
    parts = [box(0, 8, 0, 4, -1, 0), box(8, 16, 0, 4, -1, 0.5), box(30, 34, 0, 4, -1, 0)]
    made = site_of(trimesh.util.concatenate(parts))
    assert isinstance(made, Site)
    return made


def test_parts_are_told_by_their_places(site):
    low, high, apart, none = site.part_at(np.array([[2.0, 2, 0], [12.0, 2, 0.5], [32.0, 2, 0], [22.0, 2, 0]]))
    assert len({low, high, apart}) == 3 and none == -1
    assert site.areas[low] == pytest.approx((8.0 - 2 * 0.3) * (4.0 - 2 * 0.3), abs=1.5)
    assert site.centre_of(high)[2] == pytest.approx(0.5)
    cells = site.graph.surface.centers(site.cells_of(apart))
    assert len(cells) and (cells[:, 0] > 30.0).all()


def test_ways_lead_as_far_as_skills_do(site):
    """One jumps onto the platform, and steps or drops off it or not."""
    low, high, apart = site.part_at(np.array([[2.0, 2, 0], [12.0, 2, 0.5], [32.0, 2, 0]]))
    assert site.reached(np.array([low]))[[low, high, apart]].tolist() == [True, True, False]
    assert site.returning(np.array([high]))[low]
    assert (site.way_from[site.way_to == high] == low).all() and len(site.ways) > 0
    assert (site.loops[low] == site.loops[high]) == bool(site.reached(np.array([high]))[low])
    assert not site.reached(np.array([], dtype=np.int64)).any()
