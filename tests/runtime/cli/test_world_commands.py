"""`surefoot bake --open-world`: the folder that it writes, and what it refuses."""

import json

import numpy as np
import pytest

import navmesh
from runtime.planning.rules import obstacle_rules, person_walk_rules
from tests.runtime.cli.answers import one_line


def files(folder):
    return {
        file.relative_to(folder).as_posix(): file.read_bytes() for file in folder.rglob("*") if file.is_file()
    }


def test_bakes_what_the_library_bakes(surefoot, folder):
    options = ("--open-world", "--radius", 0.6, "--radius", 0.3, "--side", 10, "--max-step", 0.3)
    code, out, err = surefoot("bake", folder / "level.obj", *options, "-o", folder / "world", "--json")
    assert code == 0, err
    values = json.loads(out)
    assert values["radii"] == [0.3, 0.6] and values["triangles"] == 4 and values["chunks"] > 1

    level = navmesh.Terrain.load(folder / "level.obj")
    rules = person_walk_rules(max_step=0.3), obstacle_rules({})
    navmesh.bake_open_world(level, folder / "same", (0.3, 0.6), 10.0, *rules)
    assert files(folder / "world") == files(folder / "same")

    world = navmesh.OpenWorld(folder / "world")
    assert len(world.chunks) == values["chunks"]
    world.keep_around((2.0, 3.0, 0.0), changes=100)
    assert world.route((2.0, 3.0, 0.0), (9.0, 3.0, 0.0)).status == "complete"


def test_replaces_a_world_and_nothing_else(surefoot, folder):
    bake = ("bake", folder / "level.obj", "--open-world", "-o")
    assert surefoot(*bake, folder / "world")[0] == 0
    assert surefoot(*bake, folder / "world", "--scale", 2)[0] == 0
    first, last = np.load(folder / "world" / "world.npz")["bounds"].reshape(-1, 2, 3)[0]
    assert (last - first)[0] > 20.0
    before = files(folder)
    code, _, err = surefoot(*bake, folder)
    assert code == 2 and one_line(err) and "holds other files" in err
    code, _, err = surefoot(*bake, folder / "level.obj")
    assert code == 2 and one_line(err) and "give a folder" in err
    code, _, err = surefoot(*bake, folder / "nowhere" / "world")
    assert code == 2 and one_line(err) and "no folder" in err
    assert files(folder) == before


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("--radius", 0.6), "--open-world"),
        (("--side", 20), "--open-world"),
        (("--open-world", "--side", 1), "at least 10"),
        (("--open-world", "--radius", -1), "radius"),
        (("--open-world", "--tags", "own.yaml"), "corrections"),
    ],
)
def test_refuses_what_does_not_go_together(surefoot, folder, monkeypatch, options, told):
    monkeypatch.chdir(folder)
    (folder / "own.yaml").write_text("version: 1\n")
    before = files(folder)
    code, out, err = surefoot("bake", "level.obj", *options, "-o", "world")
    assert code == 2 and not out and told in err
    assert files(folder) == before


def test_refuses_corrections_that_lie_beside_the_level(surefoot, folder):
    (folder / "level.tags.yaml").write_text("version: 1\n")
    code, _, err = surefoot("bake", folder / "level.obj", "--open-world", "-o", folder / "world")
    assert code == 2 and one_line(err) and "level.tags.yaml" in err
    assert not (folder / "world").exists()
