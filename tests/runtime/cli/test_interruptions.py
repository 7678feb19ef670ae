"""Commands that are interrupted just before a result is in its place leave a finished or no file."""

import json
import signal
import subprocess
import sys

import numpy as np
import pytest

HOOK = """
import os, signal, sys, time
from pathlib import Path
import runtime.cli.app
wait, number, put = int(sys.argv.pop(1)), int(sys.argv.pop(1)), Path.replace
def replace(self, target):
    global wait
    wait -= 1
    if wait == 0:
        (os.killpg if number == signal.SIGINT else os.kill)(os.getpid(), number)
        time.sleep(60)
    return put(self, target)
Path.replace = replace
runtime.cli.app.main()
"""


FORKS = """
import json, os, signal, sys
import runtime, runtime.cli.app, runtime.playtest.run, runtime.views.film, runtime.views.plot
runtime.prepare()
for line in sys.stdin:
    folder, code, arguments = json.loads(line)
    child = os.fork()
    if child == 0:
        os.setsid()
        signal.alarm(300)
        os.chdir(folder)
        os.dup2(os.open(os.devnull, os.O_RDWR), 1)
        os.dup2(os.open("said", os.O_WRONLY | os.O_CREAT | os.O_TRUNC), 2)
        sys.argv = ["surefoot", *arguments]
        break
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
else:
    sys.exit()
exec(code)
"""
"""Imports everything and reads all kernels once, which takes a command longer than what it does; then forks a
process for each command that it reads, and says how it ended."""


@pytest.fixture(scope="module")
def forks():
    process = subprocess.Popen(
        [sys.executable, "-c", FORKS], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    with process:
        yield process
        process.stdin.close()


@pytest.fixture(scope="module")
def interrupted(forks):
    def run(folder, number, which, *arguments, begin=""):
        """Run the command in ``folder``; it gets the signal (Ctrl-C: all of its processes do) just before its
        result number ``which`` is in place. Its exit status and what it says."""
        given = [str(which), str(int(number)), *map(str, arguments)]
        print(json.dumps([str(folder), begin + HOOK, given]), file=forks.stdin, flush=True)
        code = int(forks.stdout.readline())
        said = folder / "said"
        text = said.read_text()
        said.unlink()
        return code, text

    return run


COMMANDS = {
    "bake": ("bake", "level.obj", "-o", "result.npz"),
    "bake an open world": ("bake", "level.obj", "--open-world", "-o", "world"),
    "run": ("run", "mission.yaml", "--out", "out"),
    "view": ("view", "trace.npz", "-o", "result.html"),
    "export": ("export", "trace.npz", "-o", "result.glb"),
    "film": ("film", "trace.npz", "-o", "result.mp4"),
    "playtest": ("playtest", "level.obj", "--bots", 1, "--seconds", 5, "--out", "out"),
    "schema": ("schema", "-o", "result.json"),
}


TOY = """
import os, signal, time
from dataclasses import dataclass
from pathlib import Path
import numpy as np
from locomotion.training.search.loop import Stage
from surefoot.files.archive import write_archive

@dataclass(frozen=True)
class Bowl:
    def stages(self):
        return (Stage("bowl", 4, 0.5, np.ones(3), population=6),)
    def start(self):
        return np.zeros(3)
    def scenarios(self, stage, generation, rng):
        return [rng.normal(size=3)]
    def evaluate(self, stage, candidate, scenarios):
        if Path("ctrl-c").exists():
            Path("ctrl-c").unlink(missing_ok=True)
            os.killpg(0, signal.SIGINT)
            time.sleep(2.0)
        return float(np.sum((candidate - 1.0 - 0.01 * scenarios[0]) ** 2)), 1.0

def train(training, out):
    training.prepare("bowl", out, Bowl().stages())
    write_archive(out, "bowl", 1, {}, {"x": training.learn(Bowl())})
"""
TRAIN = ("train", "slow-down", "-o", "skill.npz", "--checkpoint", "learned.checkpoint")
BEGIN = """
import sys
sys.path.insert(0, ".")
import toy, locomotion.training.gaits.slow_down
locomotion.training.gaits.slow_down.train_slow_down = toy.train
"""


def files(folder):
    return {each.relative_to(folder).as_posix() for each in folder.rglob("*") if each.is_file()}


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL])
def test_an_interrupted_command_leaves_no_half_result(command, number, folder, trace, interrupted):
    trace.write(folder / "trace.npz")
    before = files(folder)
    code, said = interrupted(folder, number, 1, *COMMANDS[command])
    assert code == (-number if number == signal.SIGKILL else 143) and "Traceback" not in said
    left = files(folder) - before
    if number == signal.SIGKILL:  # nobody can clean up: what is left cannot be taken for a result
        assert all(name.split("/")[-1].startswith(".") and ".part" in name for name in left)
    else:
        assert not left


@pytest.fixture(scope="module")
def learned(interrupted):
    def learn(folder, number, which, workers=1):
        """Exit status of learning the toy that is interrupted, or not at all, and what it says."""
        (folder / "toy.py").write_text(TOY)
        return interrupted(folder, number, which, *TRAIN, "--workers", workers, begin=BEGIN)

    return learn


@pytest.fixture(scope="module")
def undisturbed(learned, tmp_path_factory):
    folder = tmp_path_factory.mktemp("undisturbed")
    assert learned(folder, 0, 0)[0] == 0
    return np.load(folder / "skill.npz")["x"]


# its results are the configuration, of each of four generations the state and the time so far, and the skill
@pytest.mark.parametrize(
    ("number", "which", "status", "workers"),
    [
        (signal.SIGKILL, 1, -9, 1),
        (signal.SIGTERM, 3, 143, 1),
        (signal.SIGINT, 6, 130, 2),
    ],
)
def test_interrupted_learning_goes_on_from_its_checkpoint(
    number, which, status, workers, learned, undisturbed, tmp_path
):
    code, said = learned(tmp_path, number, which, workers)
    assert code == status and "Traceback" not in said, said
    assert not (tmp_path / "skill.npz").exists()
    if which > 1:
        assert np.load(tmp_path / "learned.checkpoint/search.npz")["mean"].shape == (3,)
    assert learned(tmp_path, 0, 0)[0] == 0
    assert np.array_equal(np.load(tmp_path / "skill.npz")["x"], undisturbed)


@pytest.mark.parametrize("workers", [1, 2])
def test_control_c_while_candidates_are_judged_says_so_once(workers, learned, tmp_path):
    (tmp_path / "ctrl-c").touch()
    code, said = learned(tmp_path, 0, 0, workers)
    assert code == 130 and "Traceback" not in said, said
    assert said.count("surefoot: interrupted") == 1 and not (tmp_path / "skill.npz").exists()


def test_control_c_says_so(folder, interrupted):
    code, said = interrupted(folder, signal.SIGINT, 1, *COMMANDS["bake"])
    assert code == 130 and said.splitlines()[-1].startswith("surefoot: interrupted"), said
    assert not (folder / "result.npz").exists()


def test_results_before_the_interruption_are_whole(folder, interrupted):
    interrupted(folder, signal.SIGTERM, 4, *COMMANDS["playtest"])  # after graph, run, report
    found = {each for each in files(folder / "out") if not each.startswith("playtest.checkpoint/")}
    assert found == {"report.json"}
