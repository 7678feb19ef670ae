"""The folder of an open world: what was written is read, and damage is told."""

import shutil

import numpy as np
import pytest

from navmesh import NavmeshError, OpenWorld
from navmesh.streaming.cutting import cut_level
from navmesh.streaming.world_folder import INDEX, WORLD_FILE, read_chunk, read_index, write_world
from surefoot.files.archive import ArchiveError, read_archive, write_archive
from tests.navmesh.streaming.worlds import SIDE, _folder, level


def test_what_was_written_is_read(tmp_path):
    folder = _folder("pieces", 0)
    index = read_index(folder)
    chunks = cut_level(level("pieces"), SIDE)
    assert index.names == tuple(sorted(chunks))
    for k, name in enumerate(index.names):
        assert read_chunk(folder, index, k).digest == chunks[name].digest
        assert np.array_equal(index.bounds[k], chunks[name].bounds)
    write_world(tmp_path, index, chunks)
    assert {each.name: each.read_bytes() for each in tmp_path.iterdir()} == {
        each.name: each.read_bytes() for each in folder.iterdir()
    }


def test_a_folder_without_a_world_is_refused(tmp_path):
    with pytest.raises(NavmeshError, match="no open world there; expected a folder that bake_open_world"):
        OpenWorld(tmp_path)


@pytest.fixture
def copied(tmp_path):
    return shutil.copytree(_folder("pieces", 0), tmp_path / "world")


def test_a_chunk_that_is_missing_damaged_or_of_another_world_is_told_and_nothing_changes(copied):
    world = OpenWorld(copied, 5.0)
    first = copied / "chunk-00000.npz"
    point = world._index.bounds[0].mean(axis=0)
    good = first.read_bytes()
    for spoil, message in (
        (lambda: first.write_bytes((copied / "chunk-00001.npz").read_bytes()), "is not the chunk"),
        (lambda: first.write_bytes(good[:-30]), "bake the world again"),
        (first.unlink, "no such file"),
    ):
        spoil()
        with pytest.raises(ArchiveError, match=message):
            world.keep_around(point)
        assert world.loaded == () and world.graph is None
    first.write_bytes(good)
    assert world.keep_around(point)


@pytest.mark.parametrize(
    ("name", "change", "message"),
    [
        ("coarse0_edge_length", lambda a: a * 0.5, "less than the straight line"),
        ("coarse1_leap_cost", lambda a: a * 0.1, "less than the straight line"),
        ("coarse0_edge_target", lambda a: a + len(a), "coarse0_edge_target"),
        ("coarse1_member_start", lambda a: a[::-1].copy(), "coarse1_member_start"),
        ("footprint0_last", lambda a: a - 10**6, "footprint0_last"),
        ("footprint1_region", lambda a: a - 10, "footprint1_region"),
        ("bounds", lambda a: a[:, ::-1], "not the least"),
    ],
)
def test_an_index_with_anything_in_it_that_no_world_has_is_refused(copied, name, change, message):
    header, arrays = read_archive(copied / INDEX, WORLD_FILE)
    arrays[name] = change(arrays[name])
    write_archive(copied / INDEX, WORLD_FILE.kind, WORLD_FILE.version, header.model_dump(), arrays)
    with pytest.raises(ArchiveError, match=message):
        read_index(copied)
