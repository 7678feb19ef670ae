"""Commands that are interrupted just before a result is in its place leave a finished or no file."""

import os
import signal
import subprocess
import sys

import pytest

from navmesh.whole_file import whole_file

HOOK = """
import os, signal, sys, time
from pathlib import Path
import runtime.cli
wait, number, put = int(sys.argv.pop(1)), int(sys.argv.pop(1)), Path.replace
def replace(self, target):
    global wait
    wait -= 1
    if wait == 0:
        os.kill(os.getpid(), number)
        time.sleep(60)
    return put(self, target)
Path.replace = replace
runtime.cli.main()
"""


def interrupted(folder, number, which, *arguments):
    """Run the command in ``folder``; it gets the signal just before its result number ``which`` is in place.
    Its exit status and what it says."""
    command = [sys.executable, "-c", HOOK, str(which), str(int(number)), *map(str, arguments)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300, check=False)
    return done.returncode, done.stderr


COMMANDS = {
    "bake": ("bake", "level.obj", "-o", "result.npz"),
    "run": ("run", "mission.yaml", "--out", "out"),
    "view": ("view", "trace.npz", "-o", "result.html"),
    "export": ("export", "trace.npz", "-o", "result.glb"),
    "film": ("film", "trace.npz", "-o", "result.mp4"),
    "playtest": ("playtest", "level.obj", "--bots", 1, "--seconds", 5, "--out", "out"),
    "schema": ("schema", "-o", "result.json"),
}


def files(folder):
    return {each.relative_to(folder).as_posix() for each in folder.rglob("*") if each.is_file()}


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL])
def test_an_interrupted_command_leaves_no_half_result(command, number, folder, trace):
    trace.write(folder / "trace.npz")
    before = files(folder)
    code, said = interrupted(folder, number, 1, *COMMANDS[command])
    assert code == (-number if number == signal.SIGKILL else 143) and "Traceback" not in said
    left = files(folder) - before
    if number == signal.SIGKILL:  # nobody can clean up: what is left cannot be taken for a result
        assert all(name.split("/")[-1].startswith(".") and ".part" in name for name in left)
    else:
        assert not left


def test_control_c_says_so(folder):
    code, said = interrupted(folder, signal.SIGINT, 1, *COMMANDS["bake"])
    assert code == 130 and said.startswith("surefoot: interrupted") and said.count("\n") == 1, said
    assert not (folder / "result.npz").exists()


def test_results_before_the_interruption_are_whole(folder):
    interrupted(folder, signal.SIGTERM, 2, *COMMANDS["playtest"])
    found = files(folder / "out")
    assert found == {"report.json"}


def test_what_a_killed_process_left_is_swept_up(tmp_path):
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    left, mine = tmp_path / f".a.npz.{gone.pid}.x.part.npz", tmp_path / f".a.npz.{os.getpid()}.x.part.npz"
    other = tmp_path / f".b.npz.{gone.pid}.x.part.npz"
    for each in (left, mine, other):
        each.write_text("half")
    with whole_file(tmp_path / "a.npz") as temporary:
        temporary.write_text("whole")
    assert {each.name for each in tmp_path.iterdir()} == {"a.npz", mine.name, other.name}
