"""Run-ups of recorded people: whether they take off in step with the recording.

    python -m benchmarks.recorded_run_ups [--count 24] [--seed 1]

People start at random distances from an obstacle and at random speeds. Printed is by how much of a cycle
their steps are off where the recording of the skill begins, how many are off by more than a tenth, and how
far a joint then is from where the recording has it, which fades out.
"""

import argparse

import numpy as np

import navmesh
from locomotion.ground.ground import Ground
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.people import RecordedPeople
from locomotion.skills.course import make_course

__all__ = ["OBSTACLES", "take_offs"]

OBSTACLES = {"jump": 0.4, "vault": 0.7, "drop": 1.5, "gap": 1.2}
"""[m] size of each."""
_EDGE = 8.0


def take_offs(kind: str, count: int, seed: int) -> np.ndarray:
    """(count, 2) of people who take off: by how many cycles steps are off, -0.5 to 0.5, and the greatest
    difference of a joint [rad]."""
    rng = np.random.default_rng((seed, list(OBSTACLES).index(kind)))
    course = make_course([(kind, OBSTACLES[kind], 0.3)], [_EDGE])
    graph = navmesh.NodeGraph.build(navmesh.Terrain.from_arrays(course.vertices, course.faces))
    ground, found = Ground.from_arrays(course.vertices, course.faces), []
    for number in range(count):
        people = RecordedPeople(graph, ground=ground)
        start = (float(rng.uniform(1.0, 5.0)), 0.0, 0.0)
        ada = people.add(start, 0.0, 0, np.random.default_rng((seed, number)))
        ada.go_to([course.path[-1] - [10.0, 0.0, 0.0]], float(rng.uniform(1.0, 4.0)), None)
        phase, row = 0.0, people.rows[0]
        while row[at.CROSSES] != at.CLEARS:
            phase = float(row[at.PHASE])
            people.tick()
        off = (phase - people.skills[kind].phase + 0.5) % 1.0 - 0.5
        found.append((off, float(np.abs(row[at.OFFSETS][6:]).max())))
    return np.array(found)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--count", type=int, default=24)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    for kind in OBSTACLES:
        off, joint = np.abs(take_offs(kind, given.count, given.seed)).T
        print(
            f"{kind:6} {given.count} take-offs: off by {np.median(off):.2f} cycles in the median, "
            f"{off.max():.2f} at most, {(off > 0.1).sum()} by more than 0.1; a joint by "
            f"{np.degrees(np.median(joint)):.0f} degrees in the median, {np.degrees(joint.max()):.0f} at most"
        )


if __name__ == "__main__":
    main()
