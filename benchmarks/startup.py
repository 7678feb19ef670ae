"""Time from starting `surefoot run` to the first simulated step, with compiled kernels.

    python -m benchmarks.startup [--repeats 5] [--json startup.json]

Each start is a new process that runs the courtyard's mission through the command line and exits after the
first step. "to the first step" counts from before Python starts; "whole process" until it has ended. Wall
time is what a user waits; CPU time is comparable on a shared machine. For comparison, a process that only
imports NumPy, Numba and MuJoCo alternates with the starts. A first start, not counted, compiles the kernels.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MISSION = ROOT / "examples" / "missions" / "courtyard.yaml"
START = """
import sys, time
import runtime.cli.app

class FirstStep:
    # leaves when the recorder's first step has been made; sees the world's class without importing it first
    def find_spec(self, name, path=None, target=None):
        if name == "runtime.traces.recording":
            from runtime.world.world import World
            step = World.step
            def first(world, dt):
                step(world, dt)
                print(time.time(), time.process_time())
                raise SystemExit
            World.step = first
        return None

sys.meta_path.insert(0, FirstStep())
runtime.cli.app.main(["run", sys.argv[1]])
"""
PEERS = "import time, numpy, numba, mujoco; print(time.time(), time.process_time())"


def start(code: str) -> dict[str, float]:
    """Wall and CPU seconds of one process: until it printed its times, and until it had ended."""
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begun, clock = time.time(), time.perf_counter()
    answer = subprocess.run(
        [sys.executable, "-c", code, str(MISSION)],
        check=True, stdout=subprocess.PIPE, text=True, cwd=ROOT, env=environment,
    )  # fmt: skip
    whole = time.perf_counter() - clock
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    at, cpu = (float(value) for value in answer.stdout.split()[-2:])
    return {
        "to the first step, wall": at - begun,
        "to the first step, CPU": cpu,
        "whole process, wall": whole,
        "whole process, CPU": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--json", type=Path, help="file to write")
    options = parser.parse_args()
    print(f"first start, compiling what is not in the cache: {start(START)['whole process, wall']:.1f} s")
    rows = [(start(START), start(PEERS)) for _ in range(options.repeats)]
    print(f"{'':26} {'median [s]':>10} {'best [s]':>10} {'peers [s]':>10} {'ratio':>6}")
    for name in rows[0][0]:
        ours, peers = (sorted(row[side][name] for row in rows) for side in (0, 1))
        middle = len(rows) // 2
        ratio = ours[middle] / peers[middle]
        print(f"{name:26} {ours[middle]:10.2f} {ours[0]:10.2f} {peers[middle]:10.2f} {ratio:6.2f}")
    if options.json:
        options.json.write_text(json.dumps([{"surefoot": a, "peers": b} for a, b in rows], indent=1) + "\n")


if __name__ == "__main__":
    main()
