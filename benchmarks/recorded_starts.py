"""Feet of recorded people who set out from a stand: how far one goes from one frame to the next.

    python -m benchmarks.recorded_starts [--seeds 3]

In a hall people who stand are sent ahead, back to where they do not look, anywhere, and round on the spot,
and are looked at 60 times a second for three seconds. In a steady walk at 1.3 m/s a foot that swings goes on
by up to about 0.11 m a frame.
"""

import argparse
import math

import numpy as np
from numpy.typing import NDArray

from benchmarks.giving_way import floor
from locomotion.recorded.footfalls import FEET
from locomotion.recorded.skeletons import LEVELS, skeleton
from locomotion.recorded_people.people import RecordedPeople

__all__ = ["WAYS", "foot_steps"]

WAYS = {"ahead": (0.0, 0.5), "back": (math.pi, 0.5), "anywhere": (0.0, math.pi), "on the spot": None}
"""Middle and half width [rad] of the directions, from where they look, in which they are sent."""
_ROW, _APART, _FAR, _NEAR = 7, 8.0, 3.0, 0.2  # people beside each other; [m]
_SECONDS, _TICK, _FRAME = 3.0, 0.01, 1.0 / 60.0
_FIRST_SEED = 500  # not one of those that were developed on


def foot_steps(level: int, way: str, speed: float, seed: int) -> NDArray[np.float64]:
    """(frames, 49, 2) [m] by which both feet of 49 people go on from frame to frame, who are sent a ``way``
    of `WAYS` at a ``speed`` [m/s]; ``level``: number of one of `LEVELS`."""
    rng, side = np.random.default_rng(seed), _ROW * _APART
    people = RecordedPeople(floor((0.0, 0.0, side, side)), dt=_TICK)
    for k in range(_ROW * _ROW):
        spot = _APART * (0.5 + k % _ROW), _APART * (0.5 + k // _ROW), 0.0
        people.add(spot, rng.uniform(-math.pi, math.pi), level, np.random.default_rng((seed, k)))
    for person in people.people:
        middle, width = WAYS[way] or (0.0, math.pi)
        along = person.yaw + middle + rng.uniform(-width, width)
        far = _NEAR if WAYS[way] is None else _FAR
        x, y = person.position[:2] + far * np.array([math.cos(along), math.sin(along)])
        facing = float(rng.uniform(-math.pi, math.pi)) if WAYS[way] is None else None
        person.go_to([(x, y, 0.0)], speed, facing)
    feet = [skeleton("full").bodies.index(name) for name in FEET]
    each, places, ticks = np.arange(len(people)), [], 0
    for frame in range(round(_SECONDS / _FRAME)):
        while ticks * _TICK < frame * _FRAME - 1e-9:
            people.tick()
            ticks += 1
        places.append(people.transforms(each, frame * _FRAME - ticks * _TICK)[:, feet, :3])
    return np.linalg.norm(np.diff(places, axis=0), axis=-1)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--seeds", type=int, default=3)
    given = parser.parse_args()
    for speed in (1.3, 3.5):
        for way in WAYS:
            for level, name in enumerate(LEVELS):
                steps = [foot_steps(level, way, speed, _FIRST_SEED + k) for k in range(given.seeds)]
                most = np.concatenate([each.max(axis=(0, 2)) for each in steps])
                print(
                    f"{name:6} {way:11} {speed} m/s: {len(most)} starts, a foot goes on by {most.max():.3f} "
                    f"m a frame at most, {np.median(most):.3f} m in the median of starts"
                )


if __name__ == "__main__":
    main()
