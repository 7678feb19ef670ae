"""How many courses of ten obstacles people complete, and where the others end.

    python -m benchmarks.courses [--courses 200] [--obstacles 10] [--kinds jump vault drop] [--rehearsals 16]

Kinds and heights are drawn evenly (heights from what each skill has learned), 8 to 15 m apart, on a level of
triangles; from standing, with noise of 0.02 m/s and rad/s. Path tracking, speed planner and skills are those
of missions.
"""

import argparse
import json
import time
from collections import Counter
from pathlib import Path

import numpy as np

from locomotion import Human
from locomotion.rehearsal.trials import REHEARSALS
from locomotion.training.skills.vault import DEPTHS
from runtime.evaluation.courses import Course, make_course, run_course
from runtime.evaluation.evaluation import start_noise

APART = (8.0, 15.0)


def draw_course(rng: np.random.Generator, count: int, kinds: list[str]) -> Course:
    """A random course."""
    heights = {skill.affordance: skill.heights for skill in Human().clearing}
    chosen = [str(rng.choice(kinds)) for _ in range(count)]
    obstacles = [(k, round(float(rng.uniform(*heights[k])), 2), float(rng.uniform(*DEPTHS))) for k in chosen]
    return make_course(obstacles, rng.uniform(*APART, count).tolist())


def main() -> None:
    """Run the courses, print a table, write JSON."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--courses", type=int, default=200)
    parser.add_argument("--obstacles", type=int, default=10)
    parser.add_argument("--kinds", nargs="+", default=["jump", "vault", "drop"])
    parser.add_argument("--rehearsals", type=int, default=REHEARSALS, help="as of Human")
    parser.add_argument("--json", type=Path, help="file to write")
    options = parser.parse_args()
    rows, last, met, began = [], Counter(), Counter(), time.process_time()
    for number in range(options.courses):
        course = draw_course(np.random.default_rng([5, number]), options.obstacles, options.kinds)
        run = run_course(course, noise=start_noise(5, number), rehearsals=options.rehearsals)
        kinds = [obstacle.affordance for obstacle in course.obstacles]
        cleared = sum(p.cleared for p in run.reports)
        rows.append({"kinds": kinds, "ended": run.ended, "cleared": cleared, "seconds": run.seconds})
        met.update(kinds[: len(run.reports)])
        if run.ended != "arrived":
            at = kinds[len(run.reports) - 1] if run.reports else "no obstacle yet"
            last[f"{run.ended}, {at}"] += 1
        if (number + 1) % 20 == 0:
            print(f"{number + 1} courses, {sum(row['ended'] == 'arrived' for row in rows)} whole", flush=True)
    whole = np.mean([row["ended"] == "arrived" for row in rows])
    print(f"{100 * whole:.1f} % of {len(rows)} courses of {options.obstacles} obstacles whole;"
          f" {np.mean([row['cleared'] for row in rows]):.1f} cleared on average")  # fmt: skip
    seconds, cpu = sum(row["seconds"] for row in rows), time.process_time() - began
    print(f"{seconds / len(rows):.0f} s a course; {seconds / cpu:.0f} times real time, rehearsals included")
    print("taken off for:", dict(met))
    print("ended (where, last obstacle):", dict(last.most_common()))
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1) + "\n")


if __name__ == "__main__":
    main()
