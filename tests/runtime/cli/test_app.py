"""The ``surefoot`` command: what it answers, and how it refuses wrong input."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import numba
import numpy as np
import pytest

import navmesh
from locomotion.clips.clip import load_clip
from locomotion.clips.motion import load_motion
from locomotion.gaits.run.skill import RUN_CLIP
from navmesh.graph.graph_file import GRAPH_FILE
from runtime.cli.app import main
from surefoot.files.archive import write_archive
from tests.small_level import MISSION


@pytest.fixture
def surefoot(capsys):
    """Runs the command in this process; returns exit code, standard output, standard error."""

    def call(*arguments):
        with pytest.raises(SystemExit) as left:
            main([str(each) for each in arguments])
        output = capsys.readouterr()
        return left.value.code, output.out, output.err

    return call


def names(folder):
    return sorted(each.name for each in folder.iterdir())


def one_line(message):
    """Whether one line, the last, says what is wrong; those before it tell how far the command was."""
    *before, last = message.splitlines()
    told = any("surefoot: " in line or "Traceback" in line for line in before)
    return last.startswith("surefoot: ") and message.endswith("\n") and not told


@pytest.mark.parametrize("command", ["", "bake", "path", "run", "train", "evaluate", "view", "clip"])
def test_help(surefoot, command):
    code, out, _ = surefoot(*command.split(), "--help")
    assert code == 0
    assert "Usage: surefoot" in out


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["fly"], "fly"),
        (["bake"], "argument"),
        (["bake", "level.obj", "-o", "graph.npz", "--up", "w"], "'x', 'y', 'z'"),
        (["path", "graph.npz", "--start", "1", "2"], "start"),
        (["train", "swim"], "valid: run, walk, speed-up, slow-down, brake, jump"),
        (["train"], "one skill"),
        (["train", "run", "--all"], "one skill"),
        (["train", "--all", "--checkpoint", "kept"], "one skill"),
    ],
)
def test_usage_errors(surefoot, arguments, says):
    code, _, err = surefoot(*arguments)
    assert code == 2 and one_line(err) and says in err


@pytest.mark.parametrize(
    ("arguments", "output", "says"),
    [
        (("film", "trace.npz", "-o"), "run.jpg", "written as .mp4"),
        (("export", "trace.npz", "-o"), "run.gltf", "use the ending .glb"),
        (("view", "trace.npz", "-o"), "run.png", "written as .html"),
        (("replay", "report.json", "1", "-o"), "run.png", "written as .html"),
        (("evaluate", "jump", "--picture"), "jump.jpg", "written as .png"),
    ],
)
def test_what_is_written_is_called_what_it_is(surefoot, tmp_path, arguments, output, says):
    code, _, err = surefoot(*arguments, tmp_path / output)
    assert code == 2 and one_line(err) and output in err and says in err
    assert names(tmp_path) == []


MESHES = {
    "missing": (None, "no such file"),
    "not a mesh": ("hello", "no triangles"),
    "no triangles": ("v 0 0 0\nv 1 0 0\n", "no triangles"),
    "not finite": ("v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", "not finite"),
    "infinite": ("v 0 0 0\nv inf 0 0\nv 0 1 0\nf 1 2 3\n", "not finite"),
    "all ceilings": ("v 0 0 3\nv 9 0 3\nv 0 9 3\nf 1 3 2\n", "walk"),
}


@pytest.mark.parametrize("kind", MESHES)
def test_bad_levels(surefoot, tmp_path, kind):
    content, says = MESHES[kind]
    level = tmp_path / "level.obj"
    if content is not None:
        level.write_text(content)
    before = names(tmp_path)
    code, _, err = surefoot("bake", level, "-o", tmp_path / "graph.npz")
    assert code == 2 and one_line(err) and says in err
    assert names(tmp_path) == before


@pytest.mark.parametrize("kind", MESHES)
def test_bad_levels_of_missions(surefoot, folder, kind):
    content, says = MESHES[kind]
    (folder / "level.obj").unlink()
    if content is not None:
        (folder / "level.obj").write_text(content)
    before = names(folder)
    code, _, err = surefoot("run", folder / "mission.yaml", "--out", folder / "out")
    assert code == 2 and one_line(err) and (says in err or "no such level" in err)
    assert "mission.yaml:2:9: " in err
    assert names(folder) == before


@pytest.mark.parametrize(
    ("old", "new", "place", "says"),
    [
        ("[9, 3, 0]", "[18, 3, 0]", "13:9", "goto[0]: [18.0, 3.0, 0.0] cannot be reached"),
        (
            "[9, 3, 0]",
            "[9, 3, 0]\n      - [90, 3, 0]",
            "14:9",
            "goto[1]: [90.0, 3.0, 0.0] is not on the floor, or in a wall",
        ),
        ("[2, 3, 0]", "[-4, 3, 0]", "9:12", "start: [-4.0, 3.0, 0.0] is not on the floor, or in a wall"),
        ("[2, 3, 0]", "[2, 3, 0.9]", "9:12", "0.90 m above the floor; the floor there is at [2.0, 3.0, 0.0]"),
        (
            "[9, 3, 0]",
            "[9, 3, -0.7]",
            "13:9",
            "below the floor; the floor there is at [9.0, 3.0, 0.0]",
        ),
        ("speed: 3.0", "sped: 3.0", "11:5", "did you mean 'speed'"),
        ("seed: 3", "seed: three", "4:7", "valid integer"),
        ("up: z", "up: z\n  tags: gone.yaml", "4:9", "no such tags file"),
    ],
)
def test_bad_missions(surefoot, folder, old, new, place, says):
    (folder / "mission.yaml").write_text(MISSION.replace(old, new, 1))
    before = names(folder)
    code, out, err = surefoot("run", folder / "mission.yaml", "--out", folder / "out")
    assert (code, out) == (2, "") and one_line(err)
    assert f"mission.yaml:{place}: " in err and says in err
    assert names(folder) == before


def test_results_need_a_folder(surefoot, folder):
    (folder / "taken").write_text("")
    code, _, err = surefoot("run", folder / "mission.yaml", "--out", folder / "taken" / "out")
    assert code == 2 and one_line(err) and "not a folder" in err
    code, _, err = surefoot("bake", folder / "level.obj", "-o", folder / "nowhere" / "graph.npz")
    assert code == 2 and one_line(err) and "no folder" in err


def test_bake_tells_the_size_of_the_level(surefoot, folder):
    graph = folder / "graph.npz"
    code, out, _ = surefoot("bake", folder / "level.obj", "--scale", "2", "-o", graph, "--json")
    low, high = navmesh.Terrain.load(folder / "level.obj").bounds
    assert code == 0 and json.loads(out)["size"] == pytest.approx((2.0 * (high - low)).tolist(), abs=0.01)


def raw(path):
    """Header and arrays of an archive as they are, unchecked."""
    with np.load(path) as file:
        arrays = dict(file)
    return json.loads(arrays.pop("header").tobytes()), arrays


def test_bakes_a_graph_and_finds_paths(surefoot, folder):
    graph = folder / "graph.npz"
    code, out, _ = surefoot("bake", folder / "level.obj", "-o", graph, "--max-step", 0.3, "--json")
    values = json.loads(out)
    assert code == 0 and values["triangles"] == 4 and values["nodes"] > 10
    header, _ = raw(graph)
    assert header["rules"]["max_step"] == 0.3

    ends = ["--start", 2, 3, 0, "--goal", 9, 3, 0]
    code, out, _ = surefoot("path", graph, *ends, "--json")
    values = json.loads(out)
    assert code == 0 and values["status"] == "complete" and values["length"] == pytest.approx(7.0, abs=0.3)
    assert surefoot("path", graph, *ends, "--smooth")[0] == 0
    code, out, _ = surefoot("path", graph, "--start", 2, 3, 0, "--goal", 18, 3, 0)
    assert code == 1 and not out.startswith("complete")
    code, out, _ = surefoot("path", graph, "--start", 2, 3, 0, "--goal", 90, 3, 0, "--json")
    assert code == 1 and json.loads(out)["status"] == "off_graph"


def test_bad_graphs(surefoot, folder):
    graph = folder / "graph.npz"
    ends = ["--start", 2, 3, 0, "--goal", 9, 3, 0]
    surefoot("bake", folder / "level.obj", "-o", graph)
    whole = graph.read_bytes()
    header, arrays = raw(graph)
    graph.write_bytes(whole[: len(whole) // 2])
    code, _, err = surefoot("path", graph, *ends)
    assert code == 2 and one_line(err) and "cut off or damaged" in err
    write_archive(graph, "surefoot navigation graph", 1, header, arrays)
    code, _, err = surefoot("path", graph, *ends)
    assert code == 2 and one_line(err) and "version 1" in err
    moved = {**arrays, "terrain_vertices": arrays["terrain_vertices"] + 1.0}
    write_archive(graph, "surefoot navigation graph", GRAPH_FILE.version, header, moved)
    code, _, err = surefoot("path", graph, *ends)
    assert code == 2 and one_line(err) and "terrain" in err
    code, _, err = surefoot("path", folder / "gone.npz", *ends)
    assert code == 2 and one_line(err) and "no such file" in err


def test_runs_a_mission_and_leaves_its_results(surefoot, folder):
    out_folder = folder / "deep" / "out"
    code, out, _ = surefoot("run", folder / "mission.yaml", "--out", out_folder, "--json")
    values = json.loads(out)
    assert code == (0 if values["held"] else 1)
    assert {check["expected"] for check in values["checks"]} == {"arrives within 15 s", "never falls"}
    assert values["events"][0]["kind"] == "Departed"
    assert names(out_folder) == ["film.png", "level.png", "run.html", "trace.npz"]

    again = json.loads(surefoot("run", folder / "mission.yaml", "--json")[1])
    assert again["state_hash"] == values["state_hash"]

    code, _, _ = surefoot("view", out_folder / "trace.npz", "-o", folder / "again.html")
    assert code == 0 and (folder / "again.html").stat().st_size > 100_000
    code, _, err = surefoot("view", folder / "level.obj", "-o", folder / "none.html")
    assert code == 2 and one_line(err) and not (folder / "none.html").exists()


def test_an_expectation_that_fails_is_exit_code_1(surefoot, folder):
    (folder / "mission.yaml").write_text(MISSION.replace("arrives_within: 15", "arrives_within: 0.5"))
    code, out, _ = surefoot("run", folder / "mission.yaml")
    assert code == 1
    assert "arrives within 0.5 s" in out and "no" in out


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_run_leaves_nothing(folder, number):
    (folder / "mission.yaml").write_text(MISSION.replace("time_limit: 20", "time_limit: 86400"))
    before = names(folder)
    # says that it is up from within main, where interruptions are looked after
    up = (
        "import runtime.cli.app as c; f = c._commands; "
        "c._commands = lambda: (print('up', flush=True), f())[1]"
    )
    command = [sys.executable, "-c", f"{up}; c.main()"]
    run = subprocess.Popen(
        [*command, "run", str(folder / "mission.yaml"), "--out", str(folder / "out")],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=dict(os.environ),
    )  # fmt: skip
    assert run.stdout is not None
    assert run.stdout.readline() == "up\n"
    os.kill(run.pid, number)
    _, err = run.communicate(timeout=120)
    assert run.returncode != 0 and "Traceback" not in err
    assert names(folder) == before


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_interruption_while_modules_load_waits_until_they_are(number, code):
    program = f"""
import os, sys, runtime.cli.app
class Interrupts:
    def find_spec(name, path, target=None):
        if name == "runtime.cli.commands":
            os.kill(os.getpid(), {int(number)})
            print("goes on")
sys.meta_path.insert(0, Interrupts)
runtime.cli.app.main(["schema"])
"""
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert run.returncode == code and run.stdout == "goes on\n" and "Traceback" not in run.stderr


def test_the_command_tells_where_kernels_are_kept_and_clears_them(surefoot, tmp_path, monkeypatch):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    kept = tmp_path / "surefoot"
    (kept / "locks").mkdir(parents=True, mode=0o700)
    (kept / "a.kernel").write_bytes(bytes(2_300_000))
    assert surefoot("cache")[1] == f"{kept}: 2.3 MB\n"
    assert json.loads(surefoot("cache", "--json")[1]) == {"folder": str(kept), "bytes": 2_300_000}
    code, out, _ = surefoot("cache", "--json", "--clear")
    assert code == 0 and json.loads(out)["bytes"] == 0 and names(kept) == ["locks"]
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "a.kernel"))
    (tmp_path / "a.kernel").write_text("")
    assert surefoot("cache")[1].startswith("nowhere: ")


def test_quiet_when_not_a_terminal(surefoot, folder):
    _, out, err = surefoot("bake", folder / "level.obj", "-o", folder / "graph.npz", "--json")
    assert json.loads(out) and "\x1b" not in err and "\r" not in err
    assert not np.any([line.startswith("\x1b") for line in out.splitlines()])


def test_clip_shows_a_motion_and_its_faults(surefoot, tmp_path):
    film, saved = tmp_path / "run.png", tmp_path / "run.npz"
    code, out, _ = surefoot("clip", RUN_CLIP, "--film", film, "-o", saved)
    assert code == 0 and "within its joint ranges" in out
    assert film.read_bytes()[:4] == b"\x89PNG"
    code, out, _ = surefoot("clip", saved, "--json")
    assert code == 0 and json.loads(out)["faults"] == []
    step = tmp_path / "step.yaml"
    code, out, _ = surefoot("clip", saved, "--stretch", 0.1, 0.4, "--mirror", "-o", step)
    assert code == 0 and load_clip(step).duration == pytest.approx(0.3, abs=0.02)
    code, _, err = surefoot("clip", saved, "--film", tmp_path / "run.jpg")
    assert code == 2 and "written as .png" in err and not (tmp_path / "run.jpg").exists()
    for output, stretch in ((tmp_path / "step.txt", (0.1, 0.4)), (tmp_path / "no.yaml", (0.4, 0.1))):
        code, _, err = surefoot("clip", saved, "--stretch", *stretch, "-o", output)
        assert code == 2 and one_line(err) and not output.exists()
    motion = load_motion(saved)
    motion.qpos[:, 7:] = 3.0
    motion.save(saved)
    code, out, _ = surefoot("clip", saved)
    assert code == 1 and "beyond its range" in out
    for source, message in (
        (tmp_path / "walk.bvh", "needs a file that maps its joints"),
        (film, "is a .yaml, .bvh or .npz file"),
    ):
        code, _, err = surefoot("clip", source)
        assert code == 2 and message in err and one_line(err)


def test_obstacles_are_listed_with_the_names_that_missions_use(surefoot):
    roofs = Path(__file__).parents[3] / "examples" / "levels" / "roofs.obj"
    code, out, _ = surefoot("obstacles", roofs, "--json")
    listed = json.loads(out)["obstacles"]
    assert code == 0 and len(listed) == 6
    assert {(each["skill"], each["affordance"]) for each in listed} == {("leap", "gap")}
    assert sorted(round(each["depth"], 1) for each in listed) == [0.8, 0.8, 1.2, 1.2, 1.5, 1.5]
    code, out, _ = surefoot("obstacles", roofs)
    assert code == 0 and all(any(each["tag"] in line for line in out.splitlines()) for each in listed)
