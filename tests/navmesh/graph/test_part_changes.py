"""Tiles far from a change keep their parts, under the names that these have now; see also `test_carrying`."""

import numpy as np

from benchmarks.large_levels import large_level
from navmesh import NodeGraph, join_chunks, split_terrain
from navmesh.graph.kernel_arrays import net_of
from navmesh.graph.open_to_body import parts_of
from navmesh.graph.part_changes import tiles_for
from navmesh.graph.parts import parts_of_tiles

RADIUS = 0.6


def before_and_after():
    """A city, of which parts are known, and the city without one of its chunks."""
    chunks = split_terrain(large_level("city", 4, 0), 5.0)
    before = NodeGraph.build(join_chunks(chunks), obstacle_rules=None)
    parts_of(before, RADIUS)
    return before, before.update({min(chunks): None})


def test_tiles_far_from_a_change_are_not_looked_at_again():
    before, after = before_and_after()
    span = parts_of(before, RADIUS)[1].span
    span += 1000.0
    assert (parts_of(after, RADIUS)[1].span > 500.0).all(axis=1).mean() > 0.5


def test_parts_that_are_divided_or_joined_are_looked_for_again():
    for pieces in (lambda part: 2 * part + np.arange(len(part)) % 2, np.zeros_like):
        _, after = before_and_after()
        part = pieces(parts_of(after, RADIUS)[0]).astype(np.int32)
        _, after = before_and_after()
        for mine, expected in zip(
            tiles_for(after, part, RADIUS), parts_of_tiles(net_of(after), part, RADIUS), strict=True
        ):
            np.testing.assert_array_equal(mine, expected)


def test_what_is_cut_off_is_looked_for_only_where_it_is():
    before, after = before_and_after()
    part = parts_of(after, RADIUS)[0]
    whole = np.bincount(part).argmax()
    corner = after.positions[:, :2].max(axis=0) - 15.0
    part[(part == whole) & (after.positions[:, :2] > corner).all(axis=1)] = part.max() + 1
    before, after = before_and_after()
    parts_of(before, RADIUS)[1].span[:] += 1000.0
    found, expected = tiles_for(after, part, RADIUS), parts_of_tiles(net_of(after), part, RADIUS)
    for name in ("start", "part", "block"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name))
    span, right = found.span, expected.span
    far = span[:, 0] > 500.0
    assert 0.5 < far.mean() < 1.0
    np.testing.assert_array_equal(span[~far], right[~far])
