"""Compiled kernels: kept by what they depend on, compiled by one process, large ones not copied."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numba
import pytest

from surefoot.kernels import folder

ROOT = Path(__file__).parents[3]
LOW = """
from surefoot.kernels import allocating_kernel
FACTOR = 2.0

@allocating_kernel
def big(x):
    {body}
    return x * FACTOR

@allocating_kernel
def other(x):
    return x + 1.0
"""
HIGH = """
import low
from surefoot.kernels import allocating_kernel
from low import big

@allocating_kernel
def top(x):
    return big(x) + 1.0

@allocating_kernel
def apart(x):
    return low.other(x)
"""
ASK = """
import json, sys
from numba.core import event
from surefoot.compiling import _Listener
from surefoot.kernels import dependencies
dependencies.PACKAGES = ("low", "high")
compiled = []
class Listener(event.Listener):
    def on_start(self, e):
        kernel = e.data["dispatcher"].py_func
        if kernel.__module__ in ("low", "high"):
            compiled.append(kernel.__name__)
    def on_end(self, e):
        pass
event.register("numba:compile", Listener())
import high
answer = [high.top(3.0), high.apart(3.0)]
module = high.top.overloads[high.top.signatures[0]].library._final_module
called = [f.is_declaration for f in module.functions if "3big" in f.name]
print(json.dumps([answer, compiled, called]))
"""
# more than LLVM would copy into a caller by itself
BODY = "\n    ".join(f"x = x + {k}.5 if x < {k}.25 * x * x else x - {k}.125 / (x + 7.0)" for k in range(40))


@pytest.fixture
def place(tmp_path):
    (tmp_path / "low.py").write_text(LOW.format(body="pass"))
    (tmp_path / "high.py").write_text(HIGH)
    return tmp_path


def begin(place, script=ASK):
    paths = {"PYTHONPATH": os.pathsep.join([str(place), str(ROOT)]), "NUMBA_CACHE_DIR": str(place / "kept")}
    return subprocess.Popen(
        [sys.executable, "-B", "-c", script], env={**os.environ, **paths}, stdout=subprocess.PIPE, text=True
    )


def ask(place, script=ASK):
    process = begin(place, script)
    out, _ = process.communicate()
    assert process.returncode == 0
    return json.loads(out)


def test_what_depends_on_an_edit_is_compiled_anew_and_nothing_else(place):
    assert ask(place)[:2] == [[7.0, 4.0], ["top", "big", "apart", "other"]]
    assert ask(place)[:2] == [[7.0, 4.0], []]
    source = place / "low.py"
    source.write_text("# a comment\n" + source.read_text())
    assert ask(place)[1] == []
    source.write_text(source.read_text().replace("FACTOR = 2.0", "FACTOR = 5.0"))
    assert ask(place)[:2] == [[16.0, 4.0], ["top", "big"]]
    source.write_text(source.read_text().replace("x + 1.0", "x + 2.0"))
    assert ask(place)[:2] == [[16.0, 5.0], ["apart", "other"]]
    assert not list(place.glob("__pycache__"))


def test_a_large_kernel_is_not_copied_and_is_found_in_a_later_process(place):
    assert ask(place)[2] == []  # a small one is inlined
    (place / "low.py").write_text(LOW.format(body=BODY))
    answer, compiled, called = ask(place)
    assert compiled == ["top", "big"] and called == [True]
    assert ask(place)[:2] == [answer, []]
    # without the kernel that it calls the caller is compiled again
    (kept,) = [
        each for each in (place / "kept" / "surefoot").glob("low.big-*") if each.stat().st_size > 20_000
    ]
    kept.unlink()
    again, compiled, _ = ask(place)
    assert again == answer and sorted(compiled) == ["big", "top"]
    assert ask(place)[:2] == [answer, []]


def test_a_damaged_file_is_compiled_again(place):
    first = ask(place)[0]
    for file in (place / "kept" / "surefoot").glob("high.*"):
        file.write_bytes(file.read_bytes()[:100])
    assert ask(place)[:2] == [first, ["top", "apart"]]


def test_processes_that_start_together_compile_each_kernel_once(place):
    (place / "low.py").write_text(LOW.format(body=BODY))
    answers = [json.loads(process.communicate()[0]) for process in [begin(place) for _ in range(3)]]
    assert len({json.dumps(answer[0]) for answer in answers}) == 1
    assert sorted(name for answer in answers for name in answer[1]) == ["apart", "big", "other", "top"]


def test_one_that_cannot_be_compiled_keeps_nobody_waiting(place):
    """It gives its turn back, and so does the one that calls it."""
    (place / "low.py").write_text(LOW.format(body="return [x] + x"))
    tried = (
        ASK.split("answer =")[0]
        + """
for _ in range(2):
    try:
        high.top(3.0)
    except Exception as error:
        said = str(error)
from surefoot.kernels import cache
print(json.dumps(["List" in said or "list" in said, len(cache._turns._locks)]))
"""
    )
    assert ask(place, tried) == [True, 0]


def test_the_chosen_folder_wins(monkeypatch, tmp_path):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "chosen"))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "caches"))
    assert folder.cache_folder() == tmp_path / "chosen" / "surefoot"
    monkeypatch.setattr(numba.config, "CACHE_DIR", "")
    folder._folder.cache_clear()
    assert folder.cache_folder() == tmp_path / "caches" / "surefoot"
    folder._folder.cache_clear()


@pytest.mark.skipif(sys.platform == "win32", reason="who may write is told elsewhere there")
def test_a_folder_that_others_can_write_to_is_not_used(monkeypatch, tmp_path):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    (tmp_path / "surefoot").mkdir()
    (tmp_path / "surefoot").chmod(0o777)
    assert folder.cache_folder() is None


def test_the_command_tells_where_they_are_and_clears_them(place):
    ask(place)
    command = [sys.executable, "-m", "surefoot", "cache", "--json"]
    paths = {"PYTHONPATH": str(ROOT), "NUMBA_CACHE_DIR": str(place / "kept")}
    told = [
        json.loads(
            subprocess.run(each, env={**os.environ, **paths}, stdout=subprocess.PIPE, check=True).stdout
        )
        for each in (command, [*command, "--clear"])
    ]
    assert [each["folder"] for each in told] == 2 * [str(place / "kept" / "surefoot")]
    assert told[0]["bytes"] > 10_000 and told[1]["bytes"] == 0
