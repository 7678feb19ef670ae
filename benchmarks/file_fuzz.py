"""Damaged files of every kind: is each refused in one sentence, or as good as before?

    python -m benchmarks.file_fuzz [--files 10000] [--seed 0] [--kinds graph state] [--out fuzz.json]

A good file of each kind is made, damaged (`benchmarks.file_mutations`), read, and used if accepted: a graph
answers queries, a world continues from a state. Everything runs in separate processes. Counted are:

  refused   one sentence, of the error that the kind's reader raises
  same      accepted, with the same content as the good file
  other     accepted, with other content: right for text, and for archives whose seal was corrected or
  removed,
            which are then different files; wrong for an archive whose seal was kept
  wrong     any other exception, or more than a sentence
  signal    the process died, or took more than 60 s for a file
  memory    greatest memory for a file, relative to the good one

Exit code 1 if anything is wrong, dies, takes more than four times the memory, or is other with its seal kept.
"""

import argparse
import json
import resource
import signal
import subprocess
import sys
import tempfile
import traceback
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.file_mutations import mutated_archive, mutated_glb, mutated_text
from surefoot import SurefootError

__all__ = ["OUTCOMES", "fuzz", "judge", "spoiled"]

OUTCOMES = ("refused", "same", "other", "kept other", "wrong", "signal")
_LIMIT, _SLOWEST = 8 * 2**30, 60  # [bytes] of a process; [s] for a file
_MOST_MEMORY = 4.0


def spoiled(kind: str, data: bytes, seed: int, number: int) -> tuple[bytes, str]:
    """File ``number`` of a ``kind``, made of the good ``data``, and what became of its seal."""
    rng = np.random.default_rng([seed, zlib.crc32(kind.encode()), number])
    if data[:2] == b"PK":
        return mutated_archive(data, rng)
    return mutated_glb(data, rng) if data[:4] == b"glTF" else mutated_text(data, rng)


def judge(kind: Any, path: Path, seal: str, good: str) -> tuple[str, str]:
    """What comes of the file at ``path``: one of `OUTCOMES`, and what is wrong."""
    from benchmarks.file_kinds import content

    try:
        with np.errstate(all="ignore"):
            read = kind.read(path)
            same = content(read) == good
            kind.use(read)
    except ValueError as error:
        told = str(error)
        if isinstance(error, SurefootError) and "\n" not in told and 0 < len(told) < 2000:
            return "refused", ""
        return "wrong", f"{type(error).__name__}: {told[:300]} {_where(error)}"
    except Exception as error:
        return "wrong", f"{type(error).__name__}: {str(error)[:300]} {_where(error)}"
    if same:
        return "same", ""
    return ("kept other", "taken, with its seal kept") if seal == "kept" else ("other", "")


def _where(error: BaseException) -> str:
    frames = traceback.extract_tb(error.__traceback__)[-3:]
    return " < ".join(f"{Path(frame.filename).name}:{frame.lineno}" for frame in reversed(frames))


def _memory(what: str) -> int:
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(what):
            return int(line.split()[1]) * 1024
    return 0


def _work(name: str, folder: Path, seed: int, first: int, count: int) -> None:
    """Judge files in this process; a line of JSON for each on standard output."""
    from benchmarks.file_kinds import KINDS, content

    resource.setrlimit(resource.RLIMIT_AS, (_LIMIT, _LIMIT))
    kind = KINDS[name]
    data = (folder / f"good{kind.ending}").read_bytes()
    path = folder / f"spoiled{kind.ending}"
    for _ in range(2):  # once to import and compile
        path.write_bytes(data)
        good = content(kind.read(path))
        _forget_peak()
        kind.use(kind.read(path))
    print(json.dumps({"memory": _memory("VmHWM")}), flush=True)
    for number in range(first, first + count):
        spoilt, seal = spoiled(name, data, seed, number)
        path.write_bytes(spoilt)
        del spoilt
        _forget_peak()
        signal.alarm(_SLOWEST)
        outcome, problem = judge(kind, path, seal, good)
        signal.alarm(0)
        line = {"number": number, "outcome": outcome, "problem": problem, "memory": _memory("VmHWM")}
        print(json.dumps(line), flush=True)


def _forget_peak() -> None:
    Path("/proc/self/clear_refs").write_text("5")


def fuzz(name: str, files: int, seed: int, first: int = 0) -> dict[str, Any]:
    """The figures of ``files`` spoiled files of a kind."""
    found: dict[str, Any] = dict.fromkeys(OUTCOMES, 0) | {"memory": 0.0, "problems": []}
    number, end = first, first + files
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        make = f"from benchmarks.file_kinds import *; from pathlib import Path; k = KINDS[{name!r}]; "
        make += f"k.make(Path({temporary!r}) / ('good' + k.ending))"
        subprocess.run([sys.executable, "-c", make], check=True)
        while number < end:
            command = [sys.executable, "-m", "benchmarks.file_fuzz", "--work", name, str(folder)]
            command += ["--seed", str(seed), "--first", str(number), "--files", str(end - number)]
            with subprocess.Popen(
                command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
            ) as worker:
                assert worker.stdout is not None
                begun = worker.stdout.readline()
                if not begun:
                    raise RuntimeError(f"the good file of {name} cannot be read or used")
                good = json.loads(begun)["memory"]
                for line in worker.stdout:
                    result = json.loads(line)
                    number = result["number"] + 1
                    found[result["outcome"]] += 1
                    found["memory"] = max(found["memory"], result["memory"] / good)
                    if result["problem"]:
                        found["problems"].append((result["number"], result["outcome"], result["problem"]))
            if number < end:
                found["signal"] += 1
                found["problems"].append((number, "signal", f"exit status {worker.returncode}"))
                number += 1
    return found


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--files", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--kinds", nargs="*")
    parser.add_argument("--out", type=Path)
    parser.add_argument("--work", nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.work:
        _work(options.work[0], Path(options.work[1]), options.seed, options.first, options.files)
        return 0
    from benchmarks.file_kinds import KINDS

    results = {}
    print(f"{'kind':14}" + "".join(f"{each:>11}" for each in (*OUTCOMES, "memory")), flush=True)
    for name in options.kinds or KINDS:
        found = results[name] = fuzz(name, options.files, options.seed, options.first)
        row = "".join(f"{found[each]:11}" for each in OUTCOMES)
        print(f"{name:14}{row}{found['memory']:10.2f}x", flush=True)
        for number, outcome, problem in found["problems"][:5]:
            print(f"    {number}: {outcome}: {problem}", flush=True)
    if options.out:
        options.out.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    bad = any(
        found["wrong"] or found["signal"] or found["kept other"] or found["memory"] > _MOST_MEMORY
        for found in results.values()
    )
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
