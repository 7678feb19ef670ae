"""A level is cut into chunks, and solids stay whole."""

import numpy as np

from navmesh import split_terrain
from navmesh.streaming.cutting import cut_level
from tests.navmesh.shapes import box, plane, terrain


def test_a_solid_on_a_border_stays_whole_in_the_square_of_its_middle():
    level = terrain(plane(0, 20, 0, 10), box(8, 11, 2, 4, 0, 2))
    chunks = cut_level(level, 10.0)
    assert sum(len(chunk.faces) for chunk in chunks.values()) == len(level.faces)
    assert {name: int((chunk.solid >= 0).sum()) for name, chunk in chunks.items()} == {"0,0": 12, "1,0": 0}
    assert not any((chunk.solid >= 0).any() for chunk in split_terrain(level, 10.0).values())


def test_a_solid_wider_than_a_square_is_cut():
    level = terrain(box(0, 25, 0, 5, 0, 1))
    chunks = cut_level(level, 10.0)
    assert len(chunks) > 1 and sum(len(chunk.faces) for chunk in chunks.values()) == 12


def test_a_level_without_solids_is_cut_as_split_terrain_cuts_it():
    level = terrain(*(plane(3 * i, 3 * i + 3, 4 * j, 4 * j + 4) for i in range(9) for j in range(9)))
    cut, split = cut_level(level, 7.0), split_terrain(level, 7.0)
    assert {name: chunk.digest for name, chunk in cut.items()} == {
        name: chunk.digest for name, chunk in split.items()
    }
    assert np.isclose(max(np.ptp(chunk.bounds, axis=0)[:2].max() for chunk in cut.values()), 9.0, atol=3.0)
