"""The longest ticks of a person: with rehearsals ahead of time, and all at once.

    python -m benchmarks.longest_ticks [--courses 5]

On the courses of `benchmarks.courses`, processor time. Both end in bit-identical states.
"""

import argparse
import gc
import time

import numpy as np

from benchmarks.courses import draw_course
from locomotion.human.state import MOVING
from locomotion.rehearsal.lookahead import Lookahead
from runtime.evaluation.courses import enter_course
from runtime.evaluation.evaluation import start_noise

LONGEST = 400.0  # [s] of a course
LIMITS_MS = (20.0, 50.0, 100.0)


def run(number: int) -> tuple[np.ndarray, str]:
    """Processor time of each tick [ms] over one course, and the state at its end."""
    course = draw_course(np.random.default_rng([5, number]), 10, ["jump", "vault", "drop"])
    human = enter_course(course, noise=start_noise(5, number))
    spent = []
    while human.status in MOVING and human.time < LONGEST:
        began = time.thread_time_ns()
        human.tick()
        spent.append((time.thread_time_ns() - began) / 1e6)
    return np.array(spent), human.state_hash()


def report(name: str, courses: int) -> list[str]:
    """Print a row, give the states at the ends."""
    run(0)  # loads what was compiled
    gc.freeze()  # as a game does that must not wait for the collector
    spent, ends = zip(*(run(number) for number in range(courses)), strict=True)
    ticks = np.concatenate(spent)
    above = "".join(f"{(ticks > limit).sum():10d}" for limit in LIMITS_MS)
    row = f"{name:14}{len(ticks):9d}{np.median(ticks):9.2f}{ticks.max():9.0f}{above}"
    print(f"{row}{10.0 * len(ticks) / ticks.sum():10.0f} x", flush=True)
    return list(ends)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--courses", type=int, default=5)
    courses = parser.parse_args().courses
    limits = "".join(f"{f'> {limit:g} ms':>10}" for limit in LIMITS_MS)
    print(f"{'rehearses':14}{'ticks':>9}{'median':>9}{'longest':>9}{limits}{'real time':>12}")
    beforehand = report("beforehand", courses)
    Lookahead.go_on = lambda *_: None
    if report("at the moment", courses) != beforehand:
        raise SystemExit("they do not end alike")


if __name__ == "__main__":
    main()
