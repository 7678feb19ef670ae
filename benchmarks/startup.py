"""How long from starting Python to the first simulated step of a person on the courtyard?

    python -m benchmarks.startup [--repeats 5] [--json startup.json]

Kernels are compiled once by a first start that is not counted; each start is a process of its own. Wall time
is what a user waits; CPU time says the same on a machine that others use, too.
"""

import argparse
import json
import subprocess
import sys
import time
from pathlib import Path

LEVEL = Path(__file__).resolve().parents[1] / "examples" / "levels" / "courtyard.obj"
START = """
import time, sys
begun = time.perf_counter()
marks = {}
def mark(name):
    marks[name] = time.perf_counter() - begun
import navmesh, runtime; mark("imports")
terrain = navmesh.Terrain.load(sys.argv[1]); mark("level")
world = runtime.World(terrain); mark("graph")
agent = world.spawn("human", (2.4, 26.0, 0.0), facing=-1.57); mark("body")
agent.go_to((10.0, 3.4, 0.0), speed=3.5); mark("path")
world.step(0.01); mark("step")
import json; print(json.dumps({"marks": marks, "cpu": time.process_time()}))
"""


def start() -> dict[str, float]:
    """Seconds of one start: at the end of each stage, and in total from before Python was started."""
    begun = time.perf_counter()
    command = [sys.executable, "-c", START, str(LEVEL)]
    answer = subprocess.run(command, check=True, capture_output=True, text=True, cwd=LEVEL.parents[2])
    total = time.perf_counter() - begun
    values = json.loads(answer.stdout)
    return {**values["marks"], "total": total, "cpu": values["cpu"]}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--json", type=Path, help="file to write")
    options = parser.parse_args()
    print(f"first start, compiling what is not in the cache: {start()['total']:.1f} s")
    starts = [start() for _ in range(options.repeats)]
    starts.sort(key=lambda each: each["total"])
    print(f"{'until':12} {'median [s]':>10} {'best [s]':>10}")
    for name in starts[0]:
        values = sorted(each[name] for each in starts)
        print(f"{name:12} {values[len(values) // 2]:10.2f} {values[0]:10.2f}")
    if options.json:
        options.json.write_text(json.dumps(starts, indent=1))


if __name__ == "__main__":
    main()
