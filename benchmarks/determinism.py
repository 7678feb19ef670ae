"""Whether a mission ends the same way every time, in one process and in two.

    python -m benchmarks.determinism [--runs 100] [--mission examples/missions/courtyard.yaml]

The mission runs that often in one process and as often in a pool of two; every run gives the hash of its last
state and of its events. Then a person runs the courtyard's first lane without a break, and again from a file
saved in mid-air, in another process. Exit code 0 if all runs of a kind agree.
"""

import argparse
import hashlib
import json
import multiprocessing
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import navmesh
from runtime import World, WorldState
from runtime.missions.mission import load_mission
from runtime.missions.run import run_mission

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
MISSION = EXAMPLES / "missions" / "courtyard.yaml"
LEVEL = EXAMPLES / "levels" / "courtyard.obj"
SECONDS = 25.0


def run(path: Path) -> str:
    """Hash of the state and the events at the end of a mission."""
    trace = run_mission(load_mission(path)).trace
    told = json.dumps([trace.state_hash, list(trace.events)], sort_keys=True)
    return hashlib.sha256(told.encode()).hexdigest()[:32]


def lane() -> World:
    return World(navmesh.Terrain.load(LEVEL, up="z"), seed=1)


def finish(world: World) -> str:
    while world.time < SECONDS:
        world.step(1 / 60)
    return world.state_hash()


def without_pause(file: Path) -> str:
    """The end of the run, and ``file`` from 0.15 s after its take-off."""
    world = lane()
    ada = world.spawn("human", (6.0, 4.0, 0.0), name="ada")
    ada.go_to((46.0, 4.0, 0.3), speed=3.3)
    while ada.status != "jumping":
        world.step(1 / 60)
        if not ada.moving:
            raise SystemExit(f"ada has not jumped: {ada.status}")
    for _ in range(9):
        world.step(1 / 60)
    world.save().write(file)
    return finish(world)


def from_file(file: Path) -> str:
    world = lane()
    world.restore(WorldState.read(file))
    return finish(world)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=100)
    parser.add_argument("--mission", type=Path, default=MISSION)
    parser.add_argument("--json", type=Path, help="file to write")
    options = parser.parse_args()
    context = multiprocessing.get_context("spawn")
    missions: Counter[str] = Counter()
    for processes in (1, 2):
        begun = time.perf_counter()
        with context.Pool(processes) as pool:
            found = Counter(pool.imap_unordered(run, [options.mission] * options.runs))
        seconds = time.perf_counter() - begun
        print(f"{options.runs} runs, {processes} processes: {dict(found)}, {seconds:.0f} s", flush=True)
        missions += found
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "state.npz"
        ends = []
        for work in (without_pause, from_file):
            with context.Pool(1) as pool:
                ends.append(pool.apply(work, (file,)))
    print(f"without a pause {ends[0]}, from a save in mid-air {ends[1]}")
    held = len(missions) == 1 and ends[0] == ends[1]
    print("all agree" if held else "they do not agree")
    if options.json:
        result = {"missions": missions, "lane": ends, "held": held}
        options.json.write_text(json.dumps(result, indent=1) + "\n")
    sys.exit(not held)


if __name__ == "__main__":
    main()
