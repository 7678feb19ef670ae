"""Time to compile all kernels from an empty cache.

    python -m benchmarks.compiling [--keep FOLDER]

`runtime.prepare()` in a process of its own whose cache is an empty folder; the user's cache is left alone.
Printed are when each use compiled its first kernel, wall time, processor time of all processes together
(comparable on a shared machine), and the number of kernels and their size; then the same of another process,
which only loads them.
"""

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PREPARE = """
import time, runtime
begun, seen = time.time(), set()
def told(share, what):
    if what not in seen:
        print(f"  {time.time() - begun:6.1f} s  {share:4.0%}  {what}", flush=True)
        seen.add(what)
runtime.prepare(told)
"""


def prepare(folder: Path, shown: bool) -> tuple[float, float]:
    """Wall and processor seconds of a process that prepares with its cache in ``folder``."""
    before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(
        [sys.executable, "-c", PREPARE], check=True, cwd=ROOT,
        env={**os.environ, "NUMBA_CACHE_DIR": str(folder)},
        stdout=None if shown else subprocess.DEVNULL,
    )  # fmt: skip
    wall, after = time.perf_counter() - begun, resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--keep", type=Path, help="folder for the kernels, by default a temporary one")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary)
        for name in ("from an empty cache", "again"):
            wall, processor = prepare(folder, name != "again")
            print(f"{name}: {wall:.1f} s, {processor:.1f} s of processor time")
        files = list((folder / "surefoot").glob("*.kernel"))
        print(f"{len(files)} kernels, {sum(file.stat().st_size for file in files) / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
