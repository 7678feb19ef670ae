"""How many courses of ten obstacles people complete, and where the others end.

    python -m benchmarks.courses [--courses 200] [--obstacles 10] [--kinds jump vault drop] [--rehearsals 16]
        [--rehearsal-ticks 20] [--processes 1] [--cluster ADDRESS]

Kinds and heights are drawn evenly (heights from what each skill has learned), 8 to 15 m apart, on a level of
triangles; from standing, with noise of 0.02 m/s and rad/s. ``--rehearsal-ticks``: in each tick of the person,
as of `runtime.World`; without it each decision takes what it needs at the moment. Path tracking, speed
planner and skills are those of missions.
"""

import argparse
import json
import time
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.workers import add_place, place_of
from locomotion import Human
from locomotion.rehearsal.choices import REHEARSALS
from locomotion.training.skills.vault import DEPTHS
from runtime.evaluation.courses import Course, make_course, run_course
from runtime.evaluation.evaluation import start_noise
from surefoot.workers.pool import worker_pool

APART = (8.0, 15.0)


def draw_course(rng: np.random.Generator, count: int, kinds: list[str]) -> Course:
    """A random course."""
    heights = {skill.affordance: skill.heights for skill in Human().clearing}
    chosen = [str(rng.choice(kinds)) for _ in range(count)]
    obstacles = [(k, round(float(rng.uniform(*heights[k])), 2), float(rng.uniform(*DEPTHS))) for k in chosen]
    return make_course(obstacles, rng.uniform(*APART, count).tolist())


_asked: tuple[int, list[str], int, int | None] | None = None  # of a worker


def _begin(obstacles: int, kinds: list[str], rehearsals: int, ticks: int | None) -> None:
    global _asked
    _asked = obstacles, kinds, rehearsals, ticks


def _run(number: int) -> dict[str, Any]:
    """Course ``number``: its kinds, how it ended, and which of them the person took off for."""
    assert _asked is not None
    obstacles, among, rehearsals, ticks = _asked
    began = time.process_time()
    course = draw_course(np.random.default_rng([5, number]), obstacles, among)
    run = run_course(course, noise=start_noise(5, number), rehearsals=rehearsals, rehearsal_ticks=ticks)
    kinds = [obstacle.affordance for obstacle in course.obstacles]
    return {
        "kinds": kinds, "ended": run.ended, "cleared": sum(p.cleared for p in run.reports),
        "seconds": run.seconds, "tried": kinds[: len(run.reports)], "cpu": time.process_time() - began,
    }  # fmt: skip


def main() -> None:
    """Run the courses, print a table, write JSON."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--courses", type=int, default=200)
    parser.add_argument("--obstacles", type=int, default=10)
    parser.add_argument("--kinds", nargs="+", default=["jump", "vault", "drop"])
    parser.add_argument("--rehearsals", type=int, default=REHEARSALS, help="as of Human")
    parser.add_argument("--rehearsal-ticks", type=int)
    parser.add_argument("--json", type=Path, help="file to write")
    add_place(parser)
    options = parser.parse_args()
    rows, last, met = [], Counter(), Counter()
    asked = options.obstacles, options.kinds, options.rehearsals, options.rehearsal_ticks
    with worker_pool(place_of(options), _begin, asked) as workers:
        for row in workers.imap(_run, range(options.courses)):
            rows.append(row)
            met.update(row["tried"])
            if row["ended"] != "arrived":
                last[f"{row['ended']}, {row['tried'][-1] if row['tried'] else 'no obstacle yet'}"] += 1
            if len(rows) % 20 == 0:
                whole = sum(each["ended"] == "arrived" for each in rows)
                print(f"{len(rows)} courses, {whole} whole", flush=True)
    whole = np.mean([row["ended"] == "arrived" for row in rows])
    print(f"{100 * whole:.1f} % of {len(rows)} courses of {options.obstacles} obstacles whole;"
          f" {np.mean([row['cleared'] for row in rows]):.1f} cleared on average")  # fmt: skip
    seconds, cpu = (sum(row[key] for row in rows) for key in ("seconds", "cpu"))
    print(f"{seconds / len(rows):.0f} s a course; {seconds / cpu:.0f} times real time, rehearsals included")
    print("taken off for:", dict(met))
    print("ended (where, last obstacle):", dict(last.most_common()))
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1) + "\n")


if __name__ == "__main__":
    from benchmarks.courses import main  # by its name, so that other machines find what it sends them

    main()
