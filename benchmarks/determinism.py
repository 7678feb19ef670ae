"""Does one mission end the same way every time, in one process and in two?

    python -m benchmarks.determinism [--runs 100] [--mission examples/missions/courtyard.yaml]

The mission is run that often in one process and as often in a pool of two; every run gives the hash of its
last state and of its events. Then it is run to the middle of a skill, saved to a file, and gone on with from
there in a process of its own. Exit code 0 when there is one hash.
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

from runtime import World, WorldState
from runtime.mission import load_mission
from runtime.mission_run import prepare_mission
from runtime.progress import Progress

MISSION = Path(__file__).resolve().parents[1] / "examples" / "missions" / "courtyard.yaml"
SECONDS = 25.0
_prepared: dict[Path, tuple] = {}


def prepare(path: Path) -> tuple:
    """The mission and its graph, once for each process."""
    if path not in _prepared:
        loaded = load_mission(path)
        _prepared[path] = loaded, prepare_mission(loaded, Progress(shown=False)).graph
    return _prepared[path]


def begin(path: Path) -> World:
    loaded, graph = prepare(path)
    world = World(graph, seed=loaded.mission.seed)
    for spec in loaded.mission.agents:
        agent = world.spawn(spec.body, spec.start, 0.0, spec.name)
        agent.go_to(spec.goto, spec.speed)
    return world


def finish(world: World) -> str:
    """Hash of the state and the events at the end."""
    while world.time < SECONDS:
        world.step(1 / 60)
    events = "".join(repr(event) for event in world.events)
    return hashlib.sha256(f"{world.state_hash()}{events}".encode()).hexdigest()[:32]


def run(path: Path) -> str:
    return finish(begin(path))


def go_on(paths: tuple[Path, Path]) -> str:
    """From a file that `save_in_mid_air` left."""
    world = World(prepare(paths[0])[1])
    world.restore(WorldState.read(paths[1]))
    return finish(world)


def save_in_mid_air(path: Path, file: Path) -> bool:
    """Run until 0.15 s into the first skill and save; False when none was begun."""
    world = begin(path)
    while not any(agent.status == "jumping" for agent in world.agents.values()):
        if world.time > SECONDS:
            return False
        world.step(1 / 60)
    for _ in range(9):
        world.step(1 / 60)
    world.save().write(file)
    return True


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=100)
    parser.add_argument("--mission", type=Path, default=MISSION)
    parser.add_argument("--json", type=Path, help="file to write")
    options = parser.parse_args()
    context = multiprocessing.get_context("spawn")
    counts: dict[str, Counter] = {}
    for processes in (1, 2):
        begun = time.perf_counter()
        with context.Pool(processes) as pool:
            counts[f"{processes} processes"] = Counter(
                pool.imap_unordered(run, [options.mission] * options.runs)
            )
        seconds = time.perf_counter() - begun
        print(
            f"{options.runs} runs, {processes} processes: {len(counts[f'{processes} processes'])} hashes, ",
            end="",
        )
        print(f"{seconds:.0f} s")
    with tempfile.TemporaryDirectory() as folder, context.Pool(1) as pool:
        file = Path(folder) / "state.npz"
        if save_in_mid_air(options.mission, file):
            counts["from a save in mid-air"] = Counter([pool.apply(go_on, ((options.mission, file),))])
    for name, each in counts.items():
        print(f"{name:24} {dict(each)}")
    held = len(set().union(*counts.values())) == 1
    print("one hash" if held else "more than one hash")
    if options.json:
        options.json.write_text(json.dumps({**counts, "held": held}, indent=1) + "\n")
    sys.exit(not held)


if __name__ == "__main__":
    main()
