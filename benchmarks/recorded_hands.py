"""Hands of recorded people who vault: how far they are from the top of the wall while they rest on it.

    python -m benchmarks.recorded_hands

People run at walls of several heights and thicknesses at random speeds, at each level of detail and in
several sizes. Printed is how far the hand that rests on the wall is from its top, up or down, and how far
beside the wall: with the recording as it is, and with the hand brought to the wall.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

import navmesh
from locomotion.body.arm_reach import HAND_RADIUS
from locomotion.body.hand_hold import HAND_POINT
from locomotion.body.traits import by_hand
from locomotion.ground.ground import Ground
from locomotion.recorded.skeletons import LEVELS
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.hand_holds import HandHold
from locomotion.recorded_people.people import RecordedPeople
from locomotion.skills.course import make_course
from runtime.bodies.joints import person_figure

__all__ = ["HEIGHTS", "misses"]

HEIGHTS, DEPTHS, SIZES = (0.6, 0.8, 1.0), (0.1, 0.3, 0.5), (0.88, 1.0, 1.08)
_EDGE = 5.0


def misses(level: int, brought: bool, seed: int = 1) -> Iterator[tuple[float, float]]:
    """How far the resting hand is from the top [m], and beside it [m], at each moment of all vaults."""
    rng = np.random.default_rng(seed)
    for height in HEIGHTS:
        for depth in DEPTHS:
            course = make_course([("vault", height, depth)], [_EDGE])
            graph = navmesh.NodeGraph.build(navmesh.Terrain.from_arrays(course.vertices, course.faces))
            ground = Ground.from_arrays(course.vertices, course.faces)
            for size in SIZES:
                people = RecordedPeople(graph, ground=ground)
                skill = people.skills["vault"]
                if not brought:
                    people.skills = {**people.skills, "vault": replace(skill, holds=())}
                ada = people.add((1.0, 0.0, 0.0), 0.0, level, np.random.default_rng(3))
                ada.set_traits(by_hand(ada.row[at.TRAITS], size=size))
                ada.go_to([course.path[-1] - [10.0, 0.0, 0.0]], float(rng.uniform(1.0, 2.5)), None)
                yield from _watched(people, size, height, depth, skill.holds)


def _watched(
    people: RecordedPeople, size: float, height: float, depth: float, holds: tuple[HandHold, ...]
) -> Iterator[tuple[float, float]]:
    ada = people.people[0]
    for _ in range(1500):
        people.tick()
        if people.rows[0, at.CROSSES] == at.CLEARS:
            moment = ada.course.moment(ada.time)
            for hold in holds:
                if hold.first <= moment <= hold.last:
                    x, _, z = _hand(people.transforms(np.array([0]))[0], hold.side, size)
                    beside = max(_EDGE - x, x - _EDGE - depth, 0.0)
                    yield z - size * HAND_RADIUS - height, beside
        elif ada.status in ("arrived", "stuck"):
            break


def _hand(places: NDArray[np.float64], side: float, size: float) -> NDArray[np.float64]:
    """(3,) the point of a hand [m]."""
    place = places[person_figure().bodies.index("left_hand" if side > 0 else "right_hand")]
    w, v, point = place[3], place[4:], size * np.array(HAND_POINT)
    return place[:3] + point + 2.0 * np.cross(v, np.cross(v, point) + w * point)


def main() -> None:
    for name in LEVELS:
        for brought in (False, True):
            off = 100.0 * np.abs(np.array(list(misses(LEVELS.index(name), brought))))
            what = "brought to the wall" if brought else "as recorded"
            print(
                f"{name:6} {what:19} {len(off)} moments: hand off the top by {np.median(off[:, 0]):.1f} cm "
                f"in the median, {off[:, 0].max():.1f} at most; beside it by {off[:, 1].max():.1f} at most"
            )


if __name__ == "__main__":
    main()
