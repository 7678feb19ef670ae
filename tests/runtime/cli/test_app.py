"""The ``surefoot`` command: what it answers, and how it refuses wrong input."""

import json
import os
import signal
import subprocess
import sys

import numba
import numpy as np
import pytest

from tests.runtime.cli.answers import names, one_line
from tests.small_level import MISSION


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
        (
            ["train", "swim"],
            "valid: run, walk, walk-policy, speed-up, slow-down, brake, brake-residual, jump",
        ),
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


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_run_leaves_nothing(folder, number):
    (folder / "mission.yaml").write_text(MISSION.replace("time_limit: 20", "time_limit: 86400"))
    before = names(folder)
    # says that it is up from within main, where interruptions are looked after
    up = (
        "import runtime.cli.app, runtime.cli.declared.missions as c; f = c.begin; "
        "c.begin = lambda: (print('up', flush=True), f())[1]"
    )
    command = [sys.executable, "-c", f"{up}; runtime.cli.app.main()"]
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
