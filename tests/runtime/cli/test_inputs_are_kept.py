"""No command writes over what it reads, however the file is called and whatever leads to it."""

import json
import os
import shutil
from pathlib import Path

import numpy as np
import pytest

from locomotion.gaits.run.skill import RUN_CLIP
from runtime.cli.app import main
from tests.small_level import MISSION

SQUARE = "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3 4\n"


def refused(capsys, *arguments):
    """The message of a command that is refused."""
    with pytest.raises(SystemExit) as left:
        main([str(each) for each in arguments])
    told = capsys.readouterr()
    assert left.value.code == 2, told.err
    assert told.out == ""
    return told.err


@pytest.fixture
def level(tmp_path):
    file = tmp_path / "level.obj"
    file.write_text(SQUARE)
    return file


@pytest.mark.parametrize("spelling", ["same", "relative", "symbolic link", "hard link", "through the parent"])
def test_bake(capsys, level, monkeypatch, spelling):
    monkeypatch.chdir(level.parent)
    output = {
        "same": level,
        "relative": Path("level.obj"),
        "symbolic link": level.parent / "link.npz",
        "hard link": level.parent / "hard.npz",
        "through the parent": Path(f"../{level.parent.name}/./level.obj"),
    }[spelling]
    if spelling == "symbolic link":
        output.symlink_to(level)
    if spelling == "hard link":
        os.link(level, output)
    before = sorted(level.parent.iterdir())
    assert "an input of this command" in refused(capsys, "bake", level, "-o", output)
    assert level.read_text() == SQUARE
    assert sorted(level.parent.iterdir()) == before


def test_bake_and_its_tags(capsys, level):
    tags = level.with_suffix(".tags.yaml")
    tags.write_text("version: 1\n")
    assert "an input" in refused(capsys, "bake", level, "-o", tags)  # read because it lies beside the level
    assert tags.read_text() == "version: 1\n"
    other = level.parent / "other.yaml"
    other.write_text("version: 1\n")
    assert "an input" in refused(capsys, "bake", level, "--tags", other, "-o", other)


def test_bake_and_the_buffer_of_its_gltf(capsys, tmp_path):
    level, buffer = tmp_path / "level.gltf", tmp_path / "level.bin"
    points = np.float32([[0, 0, 0], [9, 0, 0], [9, 0, -9]]).tobytes()
    buffer.write_bytes(points)
    level.write_text(json.dumps({
        "asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "level.bin"}],
    }))  # fmt: skip
    assert "an input" in refused(capsys, "bake", level, "-o", buffer)
    assert buffer.read_bytes() == points


def test_a_mission_and_its_results(capsys, folder):
    out = folder / "out"
    out.mkdir()
    mission = out / "trace.npz"
    mission.write_text(MISSION.replace("level.obj", "../level.obj"))
    assert "trace.npz" in refused(capsys, "run", mission, "--out", out)
    assert mission.read_text().startswith("level:")


@pytest.mark.parametrize("command", ["export", "film", "view"])
def test_the_level_of_a_mission(capsys, folder, command):
    suffix = {"export": ".glb", "film": ".mp4", "view": ".html"}[command]
    level = (folder / "level.obj").rename(folder / f"level{suffix}")
    before = level.read_bytes()
    mission = folder / "mission.yaml"
    mission.write_text(MISSION.replace("level.obj", level.name))
    assert "an input" in refused(capsys, command, mission, "-o", level)
    assert level.read_bytes() == before


def test_reports_of_playtests(capsys, level):
    out = level.parent / "out"
    out.mkdir()
    report = out / "report.json"
    report.write_text(json.dumps({}))
    assert "an input" in refused(capsys, "playtest", level, "--before", report, "--out", out)
    page = level.parent / "report.html"
    page.write_text("{}")
    assert "an input" in refused(capsys, "replay", page, 1, "-o", page)


def test_clips(capsys, tmp_path):
    clip = tmp_path / "clip.yaml"
    shutil.copy(RUN_CLIP, clip)
    before = clip.read_bytes()
    assert "an input" in refused(capsys, "clip", clip, "-o", clip)
    assert clip.read_bytes() == before
