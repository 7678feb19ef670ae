"""View, export and film: of a trace, or of a mission that is run first."""

import json

import pytest

from examples.make_characters import STOUT, write_character
from runtime.cli import view_commands
from tests.runtime.cli.answers import names, one_line


@pytest.fixture
def traced(folder, trace):
    trace.write(folder / "trace.npz")
    return folder


@pytest.mark.parametrize(("command", "ending"), [("view", "html"), ("export", "glb")])
def test_of_a_trace_a_file_is_written_and_how_long_it_is_told(surefoot, traced, trace, command, ending):
    output = traced / f"run.{ending}"
    code, out, _ = surefoot(command, traced / "trace.npz", "-o", output, "--json")
    assert code == 0
    assert json.loads(out) == {
        "output": str(output), "seconds": round(float(trace.times[-1]), 2), "bytes": output.stat().st_size,
    }  # fmt: skip
    assert surefoot(command, traced / "trace.npz", "-o", output)[1].startswith(f"{output}: open it in ")


def test_a_mission_is_run_first(surefoot, folder, trace, monkeypatch):
    class Ran:
        def __init__(self, loaded, progress):
            assert [agent.name for agent in loaded.mission.agents] == ["ada"]
            self.trace = trace

    monkeypatch.setattr(view_commands, "run_mission", Ran)
    code, _, _ = surefoot("export", folder / "mission.yaml", "-o", folder / "run.glb")
    assert code == 0 and (folder / "run.glb").read_bytes()[:4] == b"glTF"


def test_who_is_not_there_cannot_be_filmed(surefoot, traced):
    before = names(traced)
    for command, ending in (("film", "mp4"), ("view", "html")):
        code, _, err = surefoot(
            command, traced / "trace.npz", "-o", traced / f"run.{ending}", "--follow", "eve"
        )
        assert code == 2 and one_line(err) and "eve" in err and "ada" in err
    assert names(traced) == before


def test_endings_are_checked_before_the_mission_is_run(surefoot, folder, monkeypatch):
    monkeypatch.setattr(view_commands, "run_mission", None)
    for command in ("view", "export", "film"):
        code, _, err = surefoot(command, folder / "mission.yaml", "-o", folder / "run.txt")
        assert code == 2 and one_line(err) and "run.txt" in err


def test_people_are_exported_as_a_character(surefoot, traced):
    pytest.importorskip("pygltflib", reason="not there: pip install -e '.[gltf]'")
    hero, output = traced / "hero.glb", traced / "run.glb"
    write_character(STOUT, hero)
    code, _, _ = surefoot("export", traced / "trace.npz", "-o", output, "--character", hero)
    assert code == 0 and b"mixamorig:Hips" in output.read_bytes()
    for options, said in (
        (("--mapping", "mixamo"), "Give --character, too"),
        (("--character", hero, "--mapping", "unreal"), "it has no bone for"),
        (("--character", traced / "trace.npz"), "cannot be read as a character"),
    ):
        code, _, err = surefoot("export", traced / "trace.npz", "-o", traced / "no.glb", *options)
        assert code == 2 and one_line(err) and said in err
    code, _, err = surefoot("export", traced / "trace.npz", "-o", hero, "--character", hero)
    assert code == 2 and one_line(err) and "input of this command" in err
