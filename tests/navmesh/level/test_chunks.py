"""Levels in named chunks: put together, taken apart, changed."""

import numpy as np
import pytest

from navmesh import NavmeshError, Terrain
from navmesh.level.chunks import change_chunks, chunks_of, join_chunks, split_terrain
from tests.navmesh.pieces import piece
from tests.navmesh.shapes import plane, terrain


def test_chunks_put_together_are_taken_apart():
    chunks = {"b": piece("stairs", (0, 0)), "a": piece("storeys", (1, 1))}
    whole = join_chunks(chunks)
    assert [chunk.name for chunk in whole.chunks] == ["a", "b"]
    for name, chunk in chunks_of(whole).items():
        assert chunk.digest == chunks[name].digest
    split = split_terrain(whole, 2.0)
    assert sum(len(chunk.faces) for chunk in split.values()) == len(whole.faces)


def square(x, y=0.0):
    return terrain(plane(x, x + 1.0, y, y + 1.0))


def test_the_order_of_chunks_does_not_matter():
    one, two = square(0.0), square(4.0)
    assert join_chunks({"a": one, "b": two}).digest == join_chunks({"b": two, "a": one}).digest


def test_a_change_gives_the_level_that_joining_gives_and_says_where_it_is():
    chunks = {"a": square(0.0), "c": square(4.0), "e": square(8.0)}
    after, changed = change_chunks(join_chunks(chunks), {"c": None, "b": square(2.0), "e": square(8.0, 3.0)})
    expected = join_chunks({"a": chunks["a"], "b": square(2.0), "e": square(8.0, 3.0)})
    assert after.digest == expected.digest and np.array_equal(after.faces, expected.faces)
    assert [chunk.name for chunk in after.chunks] == ["a", "b", "e"]
    found = {tuple(bounds[:, :2].ravel()) for bounds in changed}
    assert found == {(2.0, 0.0, 3.0, 1.0), (4.0, 0.0, 5.0, 1.0), (8.0, 0.0, 9.0, 4.0)}


def test_a_chunk_that_is_as_it_was_is_no_change():
    level = join_chunks({"a": square(0.0), "b": square(4.0)})
    after, changed = change_chunks(level, {"b": square(4.0)})
    assert after is level and changed == []


def test_squares_hold_the_triangles_whose_middle_is_in_them():
    level = terrain(plane(-1.0, 3.0, 0.0, 2.0), plane(3.0, 5.0, 0.0, 2.0))
    found = split_terrain(level, 2.0)
    assert sum(len(chunk.faces) for chunk in found.values()) == 4 and len(found) > 1
    for name, chunk in found.items():
        middles = chunk.vertices[chunk.faces].mean(axis=1)[:, :2]
        assert {",".join(str(int(v)) for v in np.floor(each / 2.0)) for each in middles} == {name}


@pytest.mark.parametrize("side", [0.0, -1.0, float("nan"), True, "2"])
def test_a_side_is_a_length(side):
    with pytest.raises(NavmeshError, match=r"side = .*: expected a length"):
        split_terrain(square(0.0), side)


@pytest.mark.parametrize(
    ("chunks", "says"),
    [
        ({}, "no chunks"),
        ({1: None}, "a name that is a text"),
        ({"a": 5}, "chunk 'a' is a int"),
        ([1], "by name"),
    ],
)
def test_what_are_no_chunks_is_refused(chunks, says):
    with pytest.raises(NavmeshError, match=says):
        join_chunks(chunks)


def test_chunks_are_terrains_that_stand_alone():
    (only,) = chunks_of(join_chunks({"a": square(3.0)})).values()
    assert isinstance(only, Terrain) and only.name == "a" and only.faces.max() == 3
