"""Whether bodies fit through doors hardly wider than they are, and not through narrower ones. Prints a table.

    python -m benchmarks.narrow_doors [--doors 60] [--seed 1]

Two rooms of 5 x 5 m with one door between them, anywhere on the grid and turned by any angle, in walls of no
thickness, 2 cm, 20 cm and 1.5 m, at the default resolution. A door counts as passed if the route from room to
room is complete.
"""

import argparse

import numpy as np

from navmesh import NodeGraph, Terrain, WalkRules

__all__ = ["door", "passed"]

RADII = (0.2, 0.3, 0.45, 0.6)
THICK = (0.0, 0.02, 0.2, 1.5)
SPARE = (-0.05, -0.01, 0.02, 0.05, 0.1)
"""[m] by which the door is wider than the body."""


def _box(x0: float, x1: float, y0: float, y1: float) -> tuple[np.ndarray, np.ndarray]:
    corners = np.array([(x, y, z) for x in (x0, x1) for y in (y0, y1) for z in (-0.1, 2.5)])
    sides = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    return corners, np.array([f for a, b, c, d in sides for f in ((a, b, c), (a, c, d))])


def door(rng: np.random.Generator, width: float, thick: float) -> tuple[Terrain, np.ndarray, float]:
    """A level with one door of ``width`` in a wall of ``thick`` [m]; the matrix (3, 3) by which it is turned,
    and where along the wall the door's middle is [m]."""
    middle = 2.5 + rng.uniform(-0.2, 0.2)
    angle = rng.uniform(0.0, 2.0 * np.pi)
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    vertices = [np.array([(0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (10.0, 5.0, 0.0), (0.0, 5.0, 0.0)])]
    faces = [np.array([(0, 1, 2), (0, 2, 3)])]
    count = 4
    for low, high in ((0.0, middle - 0.5 * width), (middle + 0.5 * width, 5.0)):
        corners, sides = _box(5.0 - 0.5 * thick, 5.0 + 0.5 * thick, low, high)
        vertices.append(corners)
        faces.append(sides + count)
        count += len(corners)
    return Terrain.from_arrays(np.concatenate(vertices) @ turn.T, np.concatenate(faces)), turn, middle


def passed(rng: np.random.Generator, width: float, thick: float, radius: float) -> bool:
    """Whether the route through such a door is complete."""
    terrain, turn, _ = door(rng, width, thick)
    graph = NodeGraph.build(terrain, WalkRules(), None)
    return graph.find_path(turn @ (1.0, 2.5, 0.0), turn @ (9.0, 2.5, 0.0), radius).status == "complete"


def main() -> int:
    parser = argparse.ArgumentParser(description="Doors hardly wider than the body, and narrower ones.")
    parser.add_argument("--doors", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    wrong = 0
    print(f"passed of {options.doors}".ljust(34) + "".join(f"{spare * 100:+6.0f} cm" for spare in SPARE))
    for radius in RADII:
        for thick in THICK:
            row = []
            for spare in SPARE:
                rng = np.random.default_rng(
                    [options.seed, *(int(1e4 * v) for v in (radius, thick, spare + 1))]
                )
                row.append(sum(passed(rng, 2 * radius + spare, thick, radius) for _ in range(options.doors)))
                wrong += row[-1] if spare < 0 else options.doors - row[-1]
            print(f"radius {radius} m, wall {thick} m".ljust(34) + "".join(f"{count:9d}" for count in row))
    print(f"{wrong} of {len(RADII) * len(THICK) * len(SPARE) * options.doors} wrong")
    return int(wrong > 0)


if __name__ == "__main__":
    raise SystemExit(main())
