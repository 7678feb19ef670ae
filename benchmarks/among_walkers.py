"""People who go from place to place in a hall full of walkers, beside the same people alone.

    python -m benchmarks.among_walkers --seeds 3

prints, for each number of walkers, how many journeys are made, as a share of those made alone; the longest
that anybody stood; the least distance to a walker, as a share of both radii; falls.
"""

import argparse
from dataclasses import dataclass, field

import numpy as np

import navmesh
import runtime
from runtime import Arrived, Fell

SIZE = 30.0, 20.0
"""[m] of the hall."""
PEOPLE = 6
_EDGE, _SPEEDS = 1.0, (1.3, 3.0)
_STOOD = 0.05  # [m] in `_LOOK` up to which somebody stands
_LOOK = 0.25  # [s]


@dataclass
class Seen:
    """Of one run: journeys made, the longest that anybody stood [s], the least distance to a walker as a
    share of both radii, and falls."""

    journeys: int = 0
    stood: float = 0.0
    nearest: float = np.inf
    falls: int = 0
    _stands: dict[str, float] = field(default_factory=dict)

    def look(self, name: str, way: float) -> None:
        """Somebody has gone ``way`` [m] since the last look."""
        self._stands[name] = 0.0 if way > _STOOD else self._stands.get(name, 0.0) + _LOOK
        self.stood = max(self.stood, self._stands[name])


def run(walkers: int, seconds: float, seed: int) -> Seen:
    """Let `PEOPLE` people and so many walkers go about for ``seconds``."""
    x, y = SIZE
    corners = np.array([[0, 0, 0], [x, 0, 0], [x, y, 0], [0, y, 0]], dtype=float)
    hall = navmesh.Terrain.from_arrays(corners, np.array([[0, 1, 2], [0, 2, 3]]))
    world = runtime.World(hall, seed=seed)
    rng = np.random.default_rng(seed)

    def place() -> np.ndarray:
        return np.append(rng.uniform([_EDGE, _EDGE], np.array(SIZE) - _EDGE), 0.0)

    def spawned(body: str) -> runtime.Agent:
        while True:
            try:
                return world.spawn(body, place())
            except runtime.RuntimeInputError:  # somebody stands there
                pass

    people = [spawned("human") for _ in range(PEOPLE)]
    crowd = [spawned("walker") for _ in range(walkers)]
    seen, before = Seen(), [person.position for person in people]
    names = {person.name for person in people}
    radii = 2.0 * 0.3
    while world.time < seconds:
        for number, person in enumerate(people):
            if not person.moving:
                person.go_to(place(), speed=_SPEEDS[number % len(_SPEEDS)])
        for walker in crowd:
            if not walker.moving:
                walker.go_to(place())
        world.step(_LOOK)
        for event in world.events:
            if event.agent in names:
                seen.journeys += isinstance(event, Arrived)
                seen.falls += isinstance(event, Fell)
        for number, person in enumerate(people):
            here = person.position
            seen.look(person.name, float(np.linalg.norm(here - before[number])))
            before[number] = here
            if crowd:
                apart = np.linalg.norm([walker.position[:2] - here[:2] for walker in crowd], axis=1)
                seen.nearest = min(seen.nearest, float(apart.min()) / radii)
    return seen


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--first", type=int, default=500, help="the first seed")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--walkers", type=int, nargs="+", default=[50, 100, 200])
    told = parser.parse_args()
    seeds = range(told.first, told.first + told.seeds)
    alone = sum(run(0, told.seconds, seed).journeys for seed in seeds)
    print(f"{PEOPLE} people alone: {alone} journeys in {told.seeds} runs of {told.seconds:g} s")
    for walkers in told.walkers:
        seen = [run(walkers, told.seconds, seed) for seed in seeds]
        print(
            f"{walkers:4d} walkers: {sum(each.journeys for each in seen) / alone:.2f} of the journeys, "
            f"stood for {max(each.stood for each in seen):.1f} s at most, "
            f"nearest {min(each.nearest for each in seen):.2f} of both radii, "
            f"{sum(each.falls for each in seen)} falls"
        )


if __name__ == "__main__":
    main()
