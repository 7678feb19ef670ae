"""The offline step: what it takes, what it refuses, and that it leaves nothing half-written."""

import numpy as np
import pytest

from navmesh import NavmeshError, OpenWorld, bake_open_world, join_chunks
from navmesh.streaming import world_folder
from surefoot.errors import SurefootError
from tests.navmesh.pieces import piece
from tests.navmesh.shapes import plane, terrain


def square(i):
    return terrain(plane(10.0 * i, 10.0 * i + 10.0, 0.0, 10.0))


CHUNKS = {"east": square(1), "west": square(0)}


def content(folder):
    return {each.name: each.read_bytes() for each in folder.iterdir()}


def test_chunks_are_taken_as_they_are_and_a_mesh_is_cut(tmp_path):
    one = bake_open_world(CHUNKS, tmp_path / "one")
    assert OpenWorld(one).chunks == ("east", "west")
    two = bake_open_world(join_chunks(CHUNKS, "level"), tmp_path / "two")
    assert content(one) == content(two)
    cut = bake_open_world(terrain(plane(0, 20, 0, 10), plane(20, 40, 0, 10)), tmp_path / "cut", side=20.0)
    assert OpenWorld(cut).chunks == ("0,0", "1,0")


def test_the_same_level_gives_the_same_bytes_with_any_number_of_threads(tmp_path):
    level = {f"{i}{j}": piece("wall", (i, j)) for i in range(4) for j in range(4)}
    one = bake_open_world(level, tmp_path / "one", (0.3,), 10.0)
    two = bake_open_world(level, tmp_path / "two", (0.3,), 10.0, threads=2)
    assert content(one) == content(two)


def test_radii_rise_and_are_each_there_once(tmp_path):
    world = OpenWorld(bake_open_world(CHUNKS, tmp_path / "world", (0.6, 0.3, 0.6)))
    assert world.radii == (0.3, 0.6)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"level": "city.obj"}, "level: expected a Terrain, or Terrains by name, not a str"),
        ({"level": {}}, "no chunks"),
        ({"level": {"a": 1}}, "chunk 'a' is a int"),
        ({"radii": ()}, "radii: none"),
        ({"radii": 0.3}, "radii: expected radii of bodies"),
        ({"radii": (0.3, -1.0)}, "radius = -1.0: expected a body's radius"),
        ({"side": 5.0}, "side = 5.0: expected a length"),
        ({"side": "wide"}, "side = 'wide'"),
        ({"side": np.nan}, "side = nan"),
        ({"rules": 3}, "rules: expected navmesh.WalkRules"),
        ({"threads": 0}, "threads"),
    ],
)
def test_wrong_arguments_are_refused_and_nothing_is_written(tmp_path, arguments, message):
    with pytest.raises(NavmeshError, match=message):
        bake_open_world(**{"level": CHUNKS, "folder": tmp_path / "world", **arguments})
    assert not list(tmp_path.iterdir())


def test_a_folder_with_other_files_is_not_touched(tmp_path):
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(SurefootError, match="holds other files"):
        bake_open_world(CHUNKS, tmp_path)
    assert [each.name for each in tmp_path.iterdir()] == ["notes.txt"]


def test_a_failure_while_writing_leaves_the_old_world_or_nothing(tmp_path, monkeypatch):
    folder = tmp_path / "world"
    written = world_folder.write_archive

    def fails(path, *rest):
        written(path, *rest)
        if path.name == "chunk-00001.npz":
            raise OSError("disk full")

    monkeypatch.setattr(world_folder, "write_archive", fails)
    with pytest.raises(OSError, match="disk full"):
        bake_open_world(CHUNKS, folder)
    assert not list(tmp_path.iterdir())
    monkeypatch.undo()
    bake_open_world(CHUNKS, folder)
    before = content(folder)
    monkeypatch.setattr(world_folder, "write_archive", fails)
    with pytest.raises(OSError, match="disk full"):
        bake_open_world({**CHUNKS, "north": square(2)}, folder)
    assert content(folder) == before and list(tmp_path.iterdir()) == [folder]


def test_a_world_is_replaced_by_a_smaller_one_with_nothing_left_of_it(tmp_path):
    folder = bake_open_world({**CHUNKS, "north": square(2)}, tmp_path / "world")
    bake_open_world(CHUNKS, folder)
    assert content(folder) == content(bake_open_world(CHUNKS, tmp_path / "other"))
