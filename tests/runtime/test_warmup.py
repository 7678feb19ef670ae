"""Compiled kernels are known for what they are, so that a later start does not warm up again."""

import os
import subprocess
import sys
from pathlib import Path

import numba

import navmesh
from runtime import World
from runtime.events import Departed, SkillStarted
from runtime.progress import Progress
from runtime.warmup import KERNEL_MODULES, compile_kernels, is_compiled

_MAIN = "import runtime.cli; runtime.cli.main()"


def test_a_warm_up_is_not_repeated_until_a_kernel_changes(monkeypatch):
    compile_kernels(Progress(shown=False))
    assert is_compiled()
    package, module = KERNEL_MODULES[-1]
    source = Path(navmesh.__file__).parents[1] / package / f"{module}.py"
    stat = Path.stat

    def newer(path, **options):
        found = stat(path, **options)
        return os.stat_result((*found[:8], found[8] + 10**9, found[9])) if path == source else found

    monkeypatch.setattr(Path, "stat", newer)
    assert not is_compiled()


def test_the_warm_up_does_what_a_first_run_does(monkeypatch):
    """A person runs and jumps, a dog and a walker go: no first one of these compiles."""
    happened, report = [], World.report
    monkeypatch.setattr(World, "report", lambda world, event: (happened.append(event), report(world, event)))
    compile_kernels(Progress(shown=False))
    assert any(isinstance(event, SkillStarted) for event in happened)
    assert {event.agent for event in happened if isinstance(event, Departed)} == {"human1", "dog2", "walker3"}


def test_kernels_elsewhere_do_not_count_when_the_cache_has_a_place_of_its_own(monkeypatch, tmp_path):
    compile_kernels(Progress(shown=False))
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    assert not is_compiled()


def test_a_server_that_is_started_by_a_program_says_at_once_that_it_compiles(tmp_path):
    level = Path(__file__).parents[2] / "examples" / "levels" / "room.obj"
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
