"""Compiled kernels are known for what they are, so that a later start does not warm up again."""

import errno
import os
import subprocess
import sys
import time
from pathlib import Path

import numba
import numpy as np
import pytest
from numba.core.dispatcher import Dispatcher

import navmesh
import runtime
from runtime import World
from runtime.events import Departed, Fell, SkillStarted
from runtime.warmup import ahead, compile_kernels, is_compiled, is_kept
from runtime.warmup.first_uses import FIRST_USES, tiny_level
from runtime.warmup.sharing import run_shared
from runtime.world.event_log import EventLog
from runtime.world.level_of_detail import Viewer
from surefoot.compile_notice import counted
from surefoot.kernels.folder import cache_folder, clear, forget_old, write_whole
from surefoot.preparing import mark_of_kernels, prepare_once
from surefoot.progress import Progress
from tests.scenarios.pinned_runs import box

_MAIN = "import runtime.cli.app; runtime.cli.app.main()"
LEVELS = Path(__file__).parents[3] / "examples" / "levels"
_ASKED_FOR = "navmesh.obstacles.low_passages"  # compiled by the first graph with such a kind


@pytest.fixture(scope="module", autouse=True)
def prepared():
    runtime.prepare()


def test_a_warm_up_is_not_repeated_until_a_kernel_changes(monkeypatch):
    assert is_compiled()
    monkeypatch.setattr(ahead, "run_shared", None)
    told = []
    runtime.prepare(lambda share, what: told.append(share))
    assert told == [1.0]
    monkeypatch.setattr(ahead, "_sources", lambda: "others")
    assert not is_compiled()


def test_the_uses_do_what_they_are_for(monkeypatch):
    """A person runs and jumps, dogs and walkers go."""
    happened, report = [], EventLog.report
    monkeypatch.setattr(EventLog, "report", lambda log, event: (happened.append(event), report(log, event)))
    for use in ("running and jumping", "animals", "crowds", "bodies"):
        FIRST_USES[use]()
    assert any(isinstance(event, SkillStarted) for event in happened)
    departed = {event.agent for event in happened if isinstance(event, Departed)}
    assert {"human1", "dog1", "dog2", "walker5"} <= departed


def test_every_kernel_of_a_world_was_used():
    kept = {file.name.partition("-")[0] for file in cache_folder().glob("*.kernel")}
    unused = []
    for name, module in sorted(sys.modules.items()):
        ours = name.partition(".")[0] in ("navmesh", "pathsmooth", "locomotion")
        if ours and "training" not in name and name != _ASKED_FOR:
            for kernel in vars(module).values():
                if isinstance(kernel, Dispatcher) and kernel.py_func.__module__ == name:
                    inlined = kernel.targetoptions.get("inline") == "always"
                    if not inlined and f"{name}.{kernel.py_func.__qualname__}" not in kept:
                        unused.append(f"{name}.{kernel.py_func.__qualname__}")
    assert unused == []


def test_nothing_compiles_in_a_world():
    """Neither on another level, nor for bodies, queries and calls that the uses do not have together."""
    compiled = []
    with counted(compiled.append):
        graph = navmesh.NodeGraph.build(
            navmesh.Terrain.load(str(LEVELS / "room.obj"), up="z"), navmesh.WalkRules(resolution=0.2)
        )
        world = World(graph, seed=3)
        places = graph.random_points(np.random.default_rng(2), 12, radius=0.4)
        for k, body in enumerate(("human", "human", "walker", "walker", "walker")):
            world.spawn(body, places[k]).go_to(places[k + 5], speed=1.4)
        world.spawn("cat", (4.0, 3.0, 0.0)).go_to(places[11], speed=1.0)
        world.step(2.0)
        saved = world.save()
        world.step(1.0)
        world.restore(saved)
        world.step(0.5)
        graph.find_paths(places[:6], places[6:], radius=0.25)
        graph.cast_ray(places[0], places[1], 0.2)
        graph.random_points(np.random.default_rng(3), 2)
    assert compiled == []


def test_nothing_compiles_whatever_happens_in_a_world():
    """Every kind of body, skills, a fall, postures, other levels of detail, orders in mid-way, a level that
    changes, saving and restoring."""
    compiled = []
    with counted(compiled.append):
        graph = navmesh.NodeGraph.build(navmesh.Terrain.load(str(LEVELS / "courtyard.obj"), up="z"))
        world = World(graph, seed=4)
        jumper = world.spawn("human", (16.0, 4.4, 0.0), detail="physics")
        jumper.human.reset((16.0, 4.4, 0.0), 0.0, 3.3)  # it runs already
        faller = world.spawn("human", (6.0, 8.0, 0.0), facing=0.4)
        seen = world.spawn("human", (4.0, 24.0, 0.0), detail="auto")
        far = world.spawn("human", (4.0, 29.0, 0.0), detail="medium")
        walker = world.spawn("walker", (8.0, 27.0, 0.0))
        animals = [
            world.spawn(body, (x, y, 0.0))
            for body, x, y in (("dog", 4.0, 26.0), ("cat", 12.0, 24.0), ("horse", 16.0, 28.0))
        ]
        world.viewers = [Viewer((4.0, 24.0, 1.7), (1.0, 0.0, 0.0))]
        jumper.go_to((32.0, 4.4, 0.3), speed=3.3)
        faller.go_to((12.0, 8.0, 0.0), speed=1.3)
        for agent, goal in ((seen, 12.0), (far, 14.0), (walker, 4.0), *((each, 20.0) for each in animals)):
            agent.go_to((goal, 26.0, 0.0), speed=1.5)
        world.step(1.5)
        faller.human.data.xfrc_applied[faller.human.index.root, :2] = (-200.0, 900.0)
        world.step(0.2)
        faller.human.data.xfrc_applied[:] = 0.0
        far.detail, seen.detail = "full", "physics"
        animals[0].go_to((4.0, 31.0, 0.0), speed=2.5)
        animals[1].stop()
        saved = world.save()
        world.step(1.0)
        far.stop()
        far.hold("rifle")
        seen.stop()
        world.transforms()
        world.step(1.0)
        far.take_posture("prone")
        world.viewers = []
        seen.detail = "low"
        world.step(0.5)
        happened = {type(event) for event in world.events}
        world.restore(saved)
        world.change_level({"crate": box((10.0, 25.0, 0.0), (11.0, 27.0, 0.7))})
        walker.go_to((14.0, 24.0, 0.0), speed=1.5)
        world.step(0.5)
        for agent in (faller, jumper, far):
            agent.remove()
    assert {Fell, SkillStarted} <= happened
    assert compiled == []


def test_a_world_prepares_once_and_not_within_a_use(monkeypatch, tmp_path):
    done = []
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(ahead, "run_shared", lambda uses, told: done.append(World(tiny_level())))
    kernel = tmp_path / "surefoot" / "one.kernel"
    monkeypatch.setattr(ahead, "load_kept", lambda: (kernel.touch(), [kernel])[1])
    prepare_once()
    prepare_once()
    assert len(done) == 1 and is_compiled()
    kernel.unlink()  # the mark is left
    assert not is_compiled()
    prepare_once()
    assert len(done) == 2 and is_compiled()


@pytest.fixture
def kept(monkeypatch, tmp_path):
    """A prepared cache of one kernel, which nobody loads."""
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(ahead, "run_shared", lambda uses, told: None)
    kernel = tmp_path / "surefoot" / "one.kernel"
    monkeypatch.setattr(ahead, "load_kept", lambda: (kernel.touch(), [kernel])[1])
    runtime.prepare()
    return kernel


def test_what_is_in_daily_use_does_not_age(kept):
    mark = mark_of_kernels()
    for file in (mark, kept):
        os.utime(file, (time.time() - 61 * 86400.0,) * 2)
    World(tiny_level())
    forget_old()
    assert all(time.time() - file.stat().st_mtime < 86400.0 for file in (mark, kept))
    os.utime(kept, (0.0, 0.0))
    assert is_compiled() and kept.stat().st_mtime == 0.0  # noted once a day


@pytest.mark.parametrize("damage", [b"\xff\xfe\x00", b"", b"0123", b"0123\n../one.kernel"])
def test_a_damaged_mark_is_none(kept, damage):
    mark_of_kernels().write_bytes(damage)
    assert not is_kept() and not is_compiled()
    World(tiny_level())
    assert is_compiled()


def test_a_mark_that_is_removed_while_it_is_read_is_none(kept, monkeypatch):
    monkeypatch.setattr(Path, "exists", lambda path: True)
    mark_of_kernels().unlink()
    assert not is_kept()


@pytest.mark.parametrize("full", ["for kernels", "for the mark"])
def test_on_a_full_disk_a_world_is_made_all_the_same_and_nothing_is_said_to_be_kept(kept, monkeypatch, full):
    def nowhere(*arguments):
        raise OSError(errno.ENOSPC, "No space left on device")

    done, two = [], kept.with_name("two.kernel")
    writes = {"for kernels": lambda: write_whole(two, b"2"), "for the mark": lambda: None}
    clear()
    with monkeypatch.context() as while_full:
        while_full.setattr(ahead, "run_shared", lambda uses, told: (done.append(1), writes[full]()))
        while_full.setattr(os, "replace", nowhere)
        for _ in range(2):
            World(tiny_level())
        assert done == [1] and not is_kept() and {file.name for file in kept.parent.iterdir()} == {kept.name}
    write_whole(two, b"2")
    runtime.prepare()
    assert is_kept()


def test_kernels_elsewhere_do_not_count_when_the_cache_has_a_place_of_its_own(monkeypatch, tmp_path):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    assert not is_compiled()


def test_what_a_process_cannot_do_is_done_here(monkeypatch):
    """A program that has Python built in cannot start it."""
    done, told = [], []
    uses = {"one": lambda: done.append(1), "two": lambda: done.append(2)}
    monkeypatch.setattr(sys, "executable", "/opt/engine/editor")
    run_shared(uses, lambda count, what: told.append((count, what)))
    assert done == [1, 2] and told == [(0, "one"), (0, "two")]


def test_what_fails_in_a_process_fails_here(monkeypatch):
    """Its name is not known there."""

    def fail():
        raise ValueError("as it should")

    with pytest.raises(ValueError, match="as it should"):
        run_shared({"unheard of": fail}, lambda count, what: None)


def test_telling_how_far_it_is(capsys):
    compile_kernels(Progress())
    assert capsys.readouterr().err.startswith("compiling kernels, once")


def test_a_server_that_is_started_by_a_program_says_at_once_that_it_compiles(tmp_path):
    level = LEVELS / "room.obj"
    command = [sys.executable, "-c", _MAIN, "serve", str(level), "--port", "0"]
    place = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    server = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=place)
    try:
        assert server.stdout is not None
        said = [server.stdout.readline() for _ in range(2)]
        assert said[0].startswith("loading") and "compiling kernels" in said[1]
        assert server.poll() is None
    finally:
        server.kill()
        server.communicate()
