"""Whether people of any size do what the usual one does.

    python -m benchmarks.sizes [--only walk run jump ...] [--people 100] [--seed 1] [--processes 1]

Each person has a size of its own by chance, 1.55 to 1.90 m tall. walk, run: a minute of goals and stops at
0.5 to 2 m/s, or at 0.8 to 4 m/s on 50 x 50 m, as of `benchmarks.walks`; it holds if nobody falls or gets
stuck. Skills: one obstacle of the middle size that people are to clear, the same for all, 9 to 16 m ahead of
a stand, with noise of 0.02 m/s and rad/s, a goal behind it, and rehearsals; it holds if it arrives without a
fall. Beside them the same trials with people of the usual size.
"""

import argparse
from typing import Any

import numpy as np

from benchmarks.walks import SCENES, Stage
from benchmarks.workers import add_place, place_of
from locomotion import MOVING, Ground, Human
from locomotion.human.sized_human import SizedHuman
from locomotion.skills.course import make_course
from locomotion.skills.registry import skill_called, skill_words
from locomotion.training.skills.vault import DEPTHS
from runtime import World
from runtime.evaluation.courses import SPEED
from runtime.evaluation.evaluation import NOISE
from surefoot.workers.pool import worker_pool

_SIZES = (0.88, 1.08)
_SCENES = {"walk": "orders", "run": "orders at a run"}
_LONGEST = 60.0  # [s]


def moves(what: str, size: float, seed: int, number: int) -> bool:
    """A minute of orders."""
    make, act = SCENES[_SCENES[what]]
    rng = np.random.default_rng([seed, number])
    stage = Stage(World(make(rng), seed=number), size)
    act(stage, rng)
    return stage.falls == 0 and stage.stuck == 0


def clears(what: str, size: float, seed: int, number: int) -> bool:
    """One obstacle."""
    rng = np.random.default_rng([seed, number])
    kind = skill_called(what)
    course = make_course(
        [(kind.affordance, 0.5 * sum(kind.sizes), float(np.mean(DEPTHS)))], [float(rng.uniform(9.0, 16.0))]
    )
    ground = Ground.from_arrays(course.vertices, course.faces)
    own = ground.scaled(1.0 / size)
    body = SizedHuman(Human(own), size)
    body.reset(course.path[0], 0.0)
    body.human.data.qvel[:] += NOISE * rng.normal(size=body.human.model.nv)
    body.follow(course.path, SPEED, course.obstacles)
    while body.human.status in MOVING and body.time < _LONGEST:
        body.tick(since_foresees=False)
    return body.human.status == "arrived"


def _try(task: tuple[str, float, int, int]) -> bool:
    return (moves if task[0] in _SCENES else clears)(*task)


def main() -> None:
    """Print a table."""
    every = [*_SCENES, *skill_words()]
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--only", nargs="+", choices=every, default=every)
    parser.add_argument("--people", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    add_place(parser)
    options = parser.parse_args()
    sizes = np.random.default_rng(options.seed).uniform(*_SIZES, options.people).round(2).tolist()
    print("| | of any size | of the usual size | sizes of those who failed |")
    print("| --- | --- | --- | --- |")
    with worker_pool(place_of(options), int, ()) as workers:
        for what in options.only:
            tasks: list[Any] = [(what, size, options.seed, k) for k, size in enumerate(sizes)]
            held = list(workers.imap(_try, tasks))
            usual = list(workers.imap(_try, [(what, 1.0, options.seed, k) for k in range(len(sizes))]))
            failed = [size for size, each in zip(sizes, held, strict=True) if not each]
            print(f"| {what} | {sum(held)} of {len(held)} | {sum(usual)} | {failed} |", flush=True)


if __name__ == "__main__":
    from benchmarks.sizes import main  # by its name, so that workers find what it sends them

    main()
