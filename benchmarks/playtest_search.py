"""How soon bots find faults: those that push at the floor's edges against those that play at random.

    python -m benchmarks.playtest_search [--levels 8] [--seed 0] [--bots 64] [--seconds 300] [--json FILE]

Each level is a walled yard of 60 m with thirty walls in it and twenty pits of 0.7 to 1.2 m at random places:
half are holes, half have a bottom 1.5 m down that nobody gets out of. The same number of bots plays for the
same time: explorers, travellers, triers and roamers only, and with probers among them. What all bots have
spent together when the first one met a pit is the time to find it; a pit that nobody met is never found.
"""

import argparse
import json
import tempfile
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from rich.progress import track

from runtime.playtest.bots import ROLES, run_bot
from runtime.playtest.report import Setup
from runtime.playtest.run import Stage, open_stage

SIDE, PITS, WALLS = 60.0, 20, 30
NEAR = 2.0
"""[m] from a pit's middle that trouble is of it."""


def box(x0: float, x1: float, y0: float, y1: float, z0: float, z1: float) -> trimesh.Trimesh:
    return trimesh.creation.box(bounds=[(x0, y0, z0), (x1, y1, z1)])


def yard(rng: np.random.Generator) -> tuple[trimesh.Trimesh, np.ndarray]:
    """A level and the middles (`PITS`, 2) [m] of its pits."""
    corners, sizes = [], rng.uniform(0.7, 1.2, (PITS, 2))
    while len(corners) < PITS:
        corner = rng.uniform(2.0, SIDE - 3.0, 2)
        if all(np.abs(corner - other).max() > 4.0 for other in corners):
            corners.append(corner)
    low = np.array(corners)
    high = low + sizes
    sides = [(a, b, -0.3, SIDE + 0.3) for a, b in ((-0.3, 0.0), (SIDE, SIDE + 0.3))]
    sides += [(0.0, SIDE, a, b) for a, b in ((-0.3, 0.0), (SIDE, SIDE + 0.3))]
    parts = [box(*side, -0.2, 3.0) for side in sides]
    cuts = np.unique([0.0, SIDE, *low[:, 0], *high[:, 0]])
    for x0, x1 in pairwise(cuts.tolist()):
        open_here = np.flatnonzero((low[:, 0] < x1 - 1e-9) & (high[:, 0] > x0 + 1e-9))
        ends = [0.0, *np.sort([*low[open_here, 1], *high[open_here, 1]]), SIDE]
        parts += [box(x0, x1, y0, y1, -0.2, 0.0) for y0, y1 in zip(ends[::2], ends[1::2], strict=True)]
    for (x0, y0), (x1, y1) in zip(low[::2], high[::2], strict=True):
        parts.append(box(x0 - 0.1, x1 + 0.1, y0 - 0.1, y1 + 0.1, -1.7, -1.5))
    middles = 0.5 * (low + high)
    for _ in range(WALLS):
        x, y, length = *rng.uniform(1.0, SIDE - 8.0, 2), rng.uniform(2.0, 7.0)
        ends = (x, x + length, y, y + 0.3) if rng.random() < 0.5 else (x, x + 0.3, y, y + length)
        room = np.maximum(np.array(ends)[::2] - middles, middles - np.array(ends)[1::2]).max(axis=1)
        if (room > 2.0).all():
            parts.append(box(*ends, 0.0, 2.5))
    return trimesh.util.concatenate(parts), middles


def times_to_find(stage: Stage, pits: np.ndarray, numbers: list[int]) -> np.ndarray:
    """[s] of all bots together until each of the ``pits`` (p, 2) was met; inf where it was not."""
    first = np.full(len(pits), np.inf)
    setup = stage.setup
    for number in numbers:
        run = run_bot(stage.site, stage.goals, setup.seed, number, setup.seconds)
        for trouble in run.troubles:
            away = np.linalg.norm(pits - np.array(trouble.place[:2]), axis=1)
            pit = int(np.argmin(away))
            if away[pit] <= NEAR:
                first[pit] = min(first[pit], trouble.time)
    return len(numbers) * first


def measure(seed: int, bots: int, seconds: float) -> dict[str, list[float]]:
    """Times to find the pits of one level, by who plays."""
    mesh, pits = yard(np.random.default_rng(seed))
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "yard.obj"
        mesh.export(file)
        stage = open_stage(Setup(str(file), "z", None, None, "walker", bots, seconds, seed))
    everybody = list(range(bots))
    at_random = [n for n in range(2 * bots) if ROLES[n % len(ROLES)] != "prober"][:bots]
    return {
        name: times_to_find(stage, pits, numbers).tolist()
        for name, numbers in (("at random", at_random), ("with probers", everybody))
    }


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--levels", type=int, default=8)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--bots", type=int, default=64)
    parser.add_argument("--seconds", type=float, default=300.0)
    parser.add_argument("--json", type=Path, help="write every time here")
    options = parser.parse_args()
    seeds = range(options.seed, options.seed + options.levels)
    shown = track(list(seeds), "levels", transient=True)
    results = [measure(seed, options.bots, options.seconds) for seed in shown]
    report: dict[str, Any] = {}
    for name in results[0]:
        times = np.concatenate([each[name] for each in results])
        found, median = int(np.isfinite(times).sum()), float(np.median(times))
        report[name] = {"found": found, "of": len(times), "median": median}
        print(f"{name:14} {found} of {len(times)} pits, half of them within {median:.0f} s of all bots")
    if options.json:
        options.json.write_text(json.dumps(report | {"times": results}, indent=1))


if __name__ == "__main__":
    main()
