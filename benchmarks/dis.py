"""DIS: the figures of `docs/guides/dis.md`, one row or all.

python -m benchmarks.dis                       # all rows
python -m benchmarks.dis --rows reckoning geodesy --seed 5
"""

import argparse
import shutil
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import navmesh
from benchmarks.dis_figures import original, seen
from benchmarks.dis_reckoning import errors_against_integration
from benchmarks.dis_safety import crowd_cost, fuzz
from benchmarks.dis_wireshark import differences, random_pdus
from benchmarks.missions import load_level
from benchmarks.shared_data import LEVELS, shared_folder, why_absent
from runtime.dis.dead_reckoning import MODELS
from runtime.dis.entity_state import decode
from runtime.dis.geodesy import LevelFrame, rotations_of
from runtime.planning.rules import person_walk_rules


def wireshark(seed: int) -> None:
    """Every field of 1,000 random PDUs as tshark reads it."""
    if shutil.which("tshark") is None:
        print("wireshark: needs tshark (apt-get install tshark)")
        return
    with tempfile.TemporaryDirectory() as folder:
        wrong = differences(random_pdus(1000, seed), Path(folder))
    print(f"wireshark: 1000 random PDUs, {len(wrong)} fields read otherwise by tshark {wrong[:3] or ''}")


def recorded(seed: int) -> None:
    """Recorded PDUs of others, read and written again."""
    shared = shared_folder()
    if shared is None or not (shared / "dis").is_dir():
        print(f"recorded: {why_absent()}")
        return
    files = sorted((shared / "dis").glob("*.raw"))
    same = sum(decode(file.read_bytes()).encode() == file.read_bytes() for file in files)
    print(f"recorded: {same} of {len(files)} are the same bytes when written again")


def reckoning(seed: int) -> None:
    """Dead reckoning against integration in steps of 0.1 ms, 5 s, at poles and ±180° too."""
    for model in range(1, len(MODELS)):
        metres, radians = errors_against_integration(model, count=60, seconds=5.0, step=1e-4, seed=seed)
        print(f"reckoning: {MODELS[model]:6} off by {metres:.1e} m, {radians:.1e} rad at most after 5 s")


def geodesy(seed: int) -> None:
    """100,000 places and orientations from a level to geocentric and back."""
    chance = np.random.default_rng(seed)
    far, turned = 0.0, 0.0
    for number in range(100):
        latitude = (90.0, -90.0, 0.0)[number] if number < 3 else float(chance.uniform(-90, 90))
        longitude = (180.0, -180.0)[number % 2] if number < 20 else float(chance.uniform(-180, 180))
        frame = LevelFrame((latitude, longitude, float(chance.uniform(-400.0, 9000.0))))
        places = chance.normal(0.0, 3000.0, (1000, 3))
        back = frame.to_level(frame.to_geocentric(places))
        far = max(far, float(np.abs(back - places).max()))
        angles = chance.uniform(-np.pi, np.pi, (1000, 3))
        angles[:50, 1] = np.pi / 2 - 10.0 ** chance.uniform(-16, -3, 50)
        rotations = rotations_of(angles)
        again = frame.rotations(frame.orientations(rotations))
        turned = max(turned, float(np.linalg.norm(again - rotations, axis=(1, 2)).max() / np.sqrt(2.0)))
    print(f"geodesy: 100,000 places there and back: off by {far:.1e} m, {turned:.1e} rad at most")


def figures(seed: int) -> None:
    """Remote figures against their originals, which walk and run through a level, by loss of packets."""
    for level in ("nav_test", "courtyard"):
        if level in LEVELS and shared_folder() is None:
            print(f"figures: {level}: {why_absent()}")
            continue
        graph = navmesh.NodeGraph.build(load_level(level), person_walk_rules())
        bodies = ("human", "human", "human", "walker", "walker", "dog")
        run = original(graph, bodies, seconds=60.0, seed=seed)
        moved = ", ".join(f"{each:.0f}" for each in run.distance)
        print(f"figures: {level}: {', '.join(bodies)} go {moved} m within {run.seconds:.0f} s")
        for loss in (0.0, 0.05, 0.2):
            found = seen(run, loss, seed)
            errors = found.errors[np.isfinite(found.errors)]
            sent = sum(map(len, run.packets)) / run.seconds / len(bodies)
            print(
                f"figures: {level}, {100 * loss:2.0f} % lost: off by {np.percentile(errors, 95):.2f} m (p95) "
                f"and {errors.max():.2f} m at most; {sent:.2f} packets a second each, {100.0 / sent:.0f} "
                f"x fewer than every tick; a correction changes the next frame by {100 * found.root:.1f} cm "
                f"(root), {np.degrees(found.joint):.1f}° (joint) at most; steps of the root differ by "
                f"{100 * found.step:.1f} cm at most from frame to frame"
            )


def crowd(seed: int) -> None:
    """500 remote figures, each of which tells of itself once a second."""
    graph = navmesh.NodeGraph.build(load_level("courtyard"), person_walk_rules())
    crowd_cost(graph, 50, 1.2, seed)  # compiles
    median, high, posing = crowd_cost(graph, 500, 10.0, seed)
    print(
        f"crowd: 500 figures: {median:.2f} ms a frame (median; 99 % within {high:.2f} ms) of processor time "
        f"for receiving, dead reckoning and animation, {posing:.1f} ms more to pose all of them"
    )


def attacks(seed: int) -> None:
    """A million random, cut and mutated packets."""
    graph = navmesh.NodeGraph.build(load_level("courtyard"), person_walk_rules())
    raised, changed, counts, grown = fuzz(graph, 1_000_000, seed)
    print(
        f"attacks: 1,000,000 packets: {raised} raised, {changed} good entities were changed, memory grew "
        f"by {grown:.2f} MB over the second half; counted as {counts}"
    )


ROWS: dict[str, Callable[[int], None]] = {
    "wireshark": wireshark,
    "recorded": recorded,
    "reckoning": reckoning,
    "geodesy": geodesy,
    "figures": figures,
    "crowd": crowd,
    "attacks": attacks,
}


def main() -> None:
    parser = argparse.ArgumentParser(description="DIS: codec, dead reckoning, geodesy, figures, safety.")
    parser.add_argument("--rows", nargs="*", choices=list(ROWS), default=list(ROWS))
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    for row in options.rows:
        begun = time.perf_counter()
        ROWS[row](options.seed)
        print(f"  ({row}: {time.perf_counter() - begun:.0f} s)", flush=True)


if __name__ == "__main__":
    main()
