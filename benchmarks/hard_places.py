"""Places in which skills are hard to do: how many people get through, without rehearsals and with them.

    python -m benchmarks.hard_places [--only thin thick gap slippery pair short platform] [--trials 40]
        [--seed 1] [--processes 1] [--json hard.json]

People start from a stand, with noise of 0.02 m/s and rad/s, and are to be at a goal 15 m behind the last
obstacle. thin, thick: a wall 0.1 or 0.6 m thick, of any height that is vaulted. gap: 1.8 m wide. slippery:
shoes and ground with a coefficient of friction of 0.45, an obstacle of any kind and size. pair: two
obstacles of any kinds and sizes 6 m apart. short: one 5 m ahead, of any kind and size, cleared within 15 s.
platform: jumped onto, 1.5 m long, then a drop of any height.
All but short start 9 to 16 m away. Time: until the last obstacle is cleared.
"""

import argparse
import json
from collections import Counter
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.workers import add_place, place_of
from locomotion import MOVING, Human
from locomotion.body_events import Cleared
from locomotion.preconditions.moments import make_slippery
from locomotion.rehearsal.choices import REHEARSALS
from locomotion.skills.registry import skill_kind, skill_kinds
from locomotion.training.skills.vault import DEPTHS
from runtime.evaluation.courses import enter_course, make_course
from runtime.evaluation.evaluation import start_noise
from surefoot.workers.pool import worker_pool

Obstacle = tuple[str, float, float]  # affordance, size [m], thickness [m]
_SLIPPERY = 0.45
_SOON = 15.0  # [s]
_LONGEST = 6000  # ticks


def _wall(thickness: float, rng: np.random.Generator) -> tuple[list[Obstacle], list[float]]:
    return [("vault", float(rng.uniform(*skill_kind("vault").sizes)), thickness)], [_far(rng)]


def _gap(rng: np.random.Generator) -> tuple[list[Obstacle], list[float]]:
    return [("gap", 1.8, 0.0)], [_far(rng)]


def _any(rng: np.random.Generator) -> Obstacle:
    kind = skill_kinds()[int(rng.integers(len(skill_kinds())))]
    return kind.affordance, float(rng.uniform(*kind.sizes)), float(rng.uniform(*DEPTHS))


def _one(rng: np.random.Generator) -> tuple[list[Obstacle], list[float]]:
    return [_any(rng)], [_far(rng)]


def _pair(rng: np.random.Generator) -> tuple[list[Obstacle], list[float]]:
    return [_any(rng), _any(rng)], [_far(rng), 6.0]


def _short(rng: np.random.Generator) -> tuple[list[Obstacle], list[float]]:
    return [_any(rng)], [5.0]


def _platform(rng: np.random.Generator) -> tuple[list[Obstacle], list[float]]:
    up, down = (float(rng.uniform(*skill_kind(kind).sizes)) for kind in ("jump", "drop"))
    return [("jump", up, 0.0), ("drop", down, 0.0)], [_far(rng), 1.5]


def _far(rng: np.random.Generator) -> float:
    return float(rng.uniform(9.0, 16.0))


PLACES: dict[str, Callable[[np.random.Generator], tuple[list[Obstacle], list[float]]]] = {
    "thin": partial(_wall, 0.1), "thick": partial(_wall, 0.6), "gap": _gap, "slippery": _one, "pair": _pair,
    "short": _short, "platform": _platform,
}  # fmt: skip


def try_place(place: str, number: int, seed: int, rehearsals: int) -> dict[str, Any]:
    """One trial: what was ahead, how it ended, and when [s] the last obstacle was cleared."""
    rng = np.random.default_rng([seed, list(PLACES).index(place), number])
    obstacles, distances = PLACES[place](rng)
    course = make_course(obstacles, distances)
    human = enter_course(course, noise=start_noise(seed, number), rehearsals=rehearsals)
    if place == "slippery":
        _make_slippery(human)
    cleared, at = 0, 0.0
    while human.status in MOVING and human.ticks < _LONGEST:
        human.tick()
        for event in human.events:
            if isinstance(event, Cleared):
                cleared, at = cleared + 1, human.time
        human.events.clear()
    ended = human.status if human.status not in MOVING else "too slow"
    if ended == "arrived" and place == "short" and at > _SOON:
        ended = "late"
    what = ", ".join(f"{kind} {size:.2f} m" for kind, size, _ in obstacles)
    return {"what": what, "ended": ended, "held": ended == "arrived", "cleared": cleared, "time": at}


def _make_slippery(human: Human) -> None:
    """It is told of the ground as a game would: by the ground's friction."""
    human.ground.friction = _SLIPPERY
    make_slippery(human.model, _SLIPPERY)


def _try(task: tuple[str, int, int, int]) -> dict[str, Any]:
    return try_place(*task)


def main() -> None:
    """Try all, print a table, write JSON."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--only", nargs="+", default=list(PLACES), choices=list(PLACES))
    parser.add_argument("--trials", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--json", type=Path, help="file to write")
    add_place(parser)
    options = parser.parse_args()
    found: dict[str, list[dict[str, Any]]] = {}
    with worker_pool(place_of(options), int, ()) as workers:
        for place in options.only:
            for rehearsals in (0, REHEARSALS):
                tasks = [(place, number, options.seed, rehearsals) for number in range(options.trials)]
                rows = list(workers.imap(_try, tasks))
                name = f"{place}, {'with' if rehearsals else 'without'} rehearsals"
                found[name] = rows
                held = [row for row in rows if row["held"]]
                times = np.array([row["time"] for row in held] or [0.0])
                others = dict(Counter(row["ended"] for row in rows if not row["held"]))
                share = f"{100 * len(held) / len(rows):.0f} % of {len(rows)}"
                took = f"{np.median(times):.1f} s, {times.max():.1f} at most"
                print(f"{name}: {share}; {took}; others {others}", flush=True)
    if options.json:
        options.json.write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    from benchmarks.hard_places import main  # by its name, so that other machines find what it sends them

    main()
