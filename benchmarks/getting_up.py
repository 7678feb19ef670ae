"""People who are pushed over: whether they get up, how soon, and whether they go on.

    python -m benchmarks.getting_up [--falls 100] [--slope 0] [--seed 0]

On a plane they walk or run straight ahead and are pushed at the chest with 300 to 700 N for 0.15 to 0.3 s
from any side at a random time; pushes without a fall do not count. With a slope (rise over run; from 0.45)
they move along it on hands and feet instead.
"""

import argparse
import math
from collections.abc import Iterator

import numpy as np

from locomotion import MOVING, Ground, Human
from locomotion.body_events import Fell, GotUp

SPEEDS = (0.8, 1.2, 3.0, 4.0)  # [m/s] that they go at
GIVEN = 15.0  # [s] in which they are to be up
_LONGEST = 40.0


def plane(slope: float) -> Ground | None:
    """The endless plane, or a square of 200 m that rises towards y."""
    if slope == 0.0:
        return None
    half, rise = 100.0, 100.0 * slope
    corners = [[-half, -half, -rise], [half, -half, -rise], [half, half, rise], [-half, half, rise]]
    return Ground.from_arrays(corners, [[0, 1, 2], [0, 2, 3]], max_slope=math.atan(slope))


def falls(human: Human, count: int, rng: np.random.Generator) -> Iterator[tuple[float, bool]]:
    """``count`` falls: after how long it was up [s], inf if it was not; whether it was not down again within
    4 s."""
    way = np.array([[x, 0.0, 0.0] for x in np.arange(0.0, 60.0)])
    chest, tries = human.index.chest, 0
    while count > 0:
        human.events.clear()
        human.reset((0, 0, 0), 0.0)
        human.follow(way, SPEEDS[tries % len(SPEEDS)])
        tries += 1
        begin, lasts = rng.uniform(3.0, 7.0), rng.uniform(0.15, 0.3)
        side, force = rng.uniform(0.0, 2.0 * math.pi), rng.uniform(300.0, 700.0)
        start, up, again = human.time, math.inf, False
        while human.status in MOVING and human.time - start < begin + _LONGEST:
            pushed = begin <= human.time - start < begin + lasts
            human.data.xfrc_applied[chest, :2] = np.array([math.cos(side), math.sin(side)]) * force * pushed
            before = len(human.events)
            human.tick()
            for event in human.events[before:]:
                if isinstance(event, GotUp) and up == math.inf:
                    up, risen = event.seconds, human.time
                again = again or (isinstance(event, Fell) and up < math.inf)
            fell = any(isinstance(event, Fell) for event in human.events)
            if (up < math.inf and human.time > risen + 4.0) or (
                not fell and human.time - start > begin + 3.0
            ):
                break
        if any(isinstance(event, Fell) for event in human.events):
            count -= 1
            yield up, up < math.inf and not again


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--falls", type=int, default=100)
    parser.add_argument("--slope", type=float, default=0.0, help="rise over run")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    human = Human(plane(options.slope), clearing=(), gets_up=True)
    seen = list(falls(human, options.falls, np.random.default_rng(options.seed)))
    times, steady = np.array([time for time, _ in seen]), sum(stays for _, stays in seen)
    print(f"up within {GIVEN:g} s: {np.sum(times <= GIVEN)} of {len(times)}, within {_LONGEST:g} s:", end=" ")
    print(
        f"{np.sum(np.isfinite(times))}; median {np.median(times):.1f} s; not down again within 4 s: {steady}"
    )


if __name__ == "__main__":
    main()
