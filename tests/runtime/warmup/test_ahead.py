"""Compiled kernels are known for what they are, so that a later start does not warm up again."""

import errno
import os
import subprocess
import sys
import time
from pathlib import Path

import numba
import pytest
from numba.core.dispatcher import Dispatcher

import runtime
from runtime import World
from runtime.events import Departed, SkillStarted
from runtime.warmup import ahead, compile_kernels, is_compiled
from runtime.warmup.first_uses import FIRST_USES, tiny_level
from runtime.warmup.sharing import run_shared
from runtime.world.event_log import EventLog
from surefoot.kernels import sources
from surefoot.kernels.folder import cache_folder, clear, forget_old, write_whole
from surefoot.preparing import mark_of_kernels, prepare_once
from surefoot.progress import Progress

_MAIN = "import runtime.cli.app; runtime.cli.app.main()"
ROOT = Path(__file__).parents[3]
LEVELS = ROOT / "examples" / "levels"
FILES = {"one.kernel"}
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
    monkeypatch.setattr(sources, "digest_of_sources", lambda: "others")
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


def test_nothing_compiles_in_a_world_whatever_happens():
    """Nor would on a machine with nothing but what was prepared: this one's cache may have more."""
    command = [sys.executable, "-m", "tests.runtime.warmup.scenes"]
    scenes = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True)
    assert scenes.stdout == "0 compiled;\n"


def test_a_world_prepares_once_and_not_within_a_use(monkeypatch, tmp_path):
    done = []
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(ahead, "run_shared", lambda uses, told: (done.append(World(tiny_level())), FILES)[1])
    kernel = tmp_path / "surefoot" / "one.kernel"
    monkeypatch.setattr(ahead, "load_kept", kernel.touch)
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
    monkeypatch.setattr(ahead, "run_shared", lambda uses, told: FILES)
    kernel = tmp_path / "surefoot" / "one.kernel"
    monkeypatch.setattr(ahead, "load_kept", kernel.touch)
    runtime.prepare()
    return kernel


def test_a_world_prepares_again_when_a_kernel_has_changed(kept, monkeypatch):
    """Else the first step that needs it would compile it."""
    done = []
    monkeypatch.setattr(ahead, "run_shared", lambda uses, told: (done.append(World(tiny_level())), FILES)[1])
    World(tiny_level())
    assert done == []
    monkeypatch.setattr(sources, "digest_of_sources", lambda: "others")
    for _ in range(2):
        World(tiny_level())
    assert len(done) == 1
    monkeypatch.undo()


def test_what_is_in_daily_use_does_not_age(kept):
    mark = mark_of_kernels()
    for file in (mark, kept):
        os.utime(file, (time.time() - 61 * 86400.0,) * 2)
    World(tiny_level())
    forget_old()
    assert all(time.time() - file.stat().st_mtime < 86400.0 for file in (mark, kept))
    os.utime(kept, (0.0, 0.0))
    assert is_compiled() and kept.stat().st_mtime == 0.0  # noted once a day


@pytest.mark.parametrize("damage", [b"\xff\xfe\x00", b"", b"0123.kernel", b"one.kernel\n../one.kernel"])
def test_a_damaged_mark_is_none(kept, damage):
    mark_of_kernels().write_bytes(damage)
    assert not is_compiled()
    World(tiny_level())
    assert is_compiled()


def test_a_mark_that_is_removed_while_it_is_read_is_none(kept, monkeypatch):
    monkeypatch.setattr(Path, "exists", lambda path: True)
    mark_of_kernels().unlink()
    assert not is_compiled()


@pytest.mark.parametrize("full", ["for kernels", "for the mark"])
def test_on_a_full_disk_a_world_is_made_all_the_same_and_nothing_is_said_to_be_kept(kept, monkeypatch, full):
    def nowhere(*arguments):
        raise OSError(errno.ENOSPC, "No space left on device")

    done, two = [], kept.with_name("two.kernel")
    writes = {"for kernels": lambda: write_whole(two, b"2"), "for the mark": lambda: None}
    clear()
    with monkeypatch.context() as while_full:
        while_full.setattr(ahead, "run_shared", lambda uses, told: (done.append(1), writes[full](), FILES)[2])
        while_full.setattr(os, "replace", nowhere)
        for _ in range(2):
            World(tiny_level())
        assert (
            done == [1] and not is_compiled() and {file.name for file in kept.parent.iterdir()} == {kept.name}
        )
    write_whole(two, b"2")
    runtime.prepare()
    assert is_compiled()


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
