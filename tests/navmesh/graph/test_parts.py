"""The parts that one body radius leaves of a graph."""

import networkx
import numpy as np
import pytest

from navmesh.graph.open_to_body import parts_of, portals_of
from navmesh.graph.parts import BLOCK, TILE, Tiles, parts_in_tiles
from tests.navmesh.shapes import plane
from tests.navmesh.surface.levels import build, random_level


@pytest.mark.parametrize("radius", [0.2, 0.6])
@pytest.mark.parametrize("seed", range(3))
def test_nodes_of_a_part_can_be_walked_to_from_each_other(seed, radius):
    graph = build(*random_level(seed))
    start, doors = portals_of(graph, radius)[:2]
    target = doors["target"]
    walks = networkx.DiGraph()
    walks.add_nodes_from(range(len(graph)))
    for node in range(len(graph)):
        walks.add_edges_from((node, int(other)) for other in target[start[node] : start[node + 1]])
    part = parts_of(graph, radius)[0]
    for members in networkx.weakly_connected_components(walks):
        assert len(set(part[sorted(members)].tolist())) == 1
    assert len(set(part.tolist())) == networkx.number_weakly_connected_components(walks)
    _, first = np.unique(part, return_index=True)
    assert (np.diff(first) > 0).all()  # numbered by their first nodes


def test_a_part_is_added_to_tiles():
    surface = build(plane(0, 9, 0, 9)).surface
    cells = np.flatnonzero(surface.centers()[:, 0] < 1.0).astype(np.int32)
    start, own = np.array([0, 2, *[2] * 8], np.int32), np.array([1, 4], np.int32)
    tiles = Tiles(start, own, np.array([(5.0, 6.0)] * 2), np.array([1, 2]))
    start, part, span, block = parts_in_tiles(tiles, surface, cells, 9)
    by_tile = [part[start[t] : start[t + 1]].tolist() for t in range(9)]
    assert by_tile == [[1, 4, 9], [9], [9], *[[]] * 6]
    assert span[:2].tolist() == [[5.0, 6.0]] * 2
    np.testing.assert_allclose(span[2], surface.height[0])
    ix, iy = np.divmod(surface.columns(cells), surface.shape[1])
    wanted = {
        8 * (x // BLOCK) + y // BLOCK for x, y in zip(ix.tolist(), iy.tolist(), strict=True) if y < TILE
    }
    assert block[:2].tolist() == [1, 2] and {bit for bit in range(64) if int(block[2]) >> bit & 1} == wanted


@pytest.mark.parametrize("radius", [0.3, 0.7])
def test_tiles_know_where_their_parts_have_a_place(radius):
    graph = build(*random_level(4))
    part, tiles = parts_of(graph, radius)
    surface = graph.surface
    ix, iy = np.divmod(surface.columns(np.arange(len(surface))), surface.shape[1])
    tile = ix // TILE * -(-surface.shape[1] // TILE) + iy // TILE
    bit = TILE // BLOCK * (ix % TILE // BLOCK) + iy % TILE // BLOCK
    places = np.flatnonzero((surface.clearance >= radius) & (graph.label >= 0))
    wanted = {(tile[k], part[graph.label[k]], bit[k]) for k in places}
    found = set()
    for t in range(len(tiles.start) - 1):
        for row in range(tiles.start[t], tiles.start[t + 1]):
            found |= {(t, tiles.part[row], b) for b in range(64) if int(tiles.block[row]) >> b & 1}
    assert wanted <= found and len(wanted) > 50
    assert len(found) < 1.6 * len(wanted)  # places between centres, too
