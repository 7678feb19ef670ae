"""Grounds, walls and planners for the tests of quadrupeds."""

import numpy as np

from locomotion import Ground, SmoothPath
from locomotion.quadruped import Animal, Body, Herd, load_body
from locomotion.quadruped import layout as at


def quads(*corners) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces of four-sided faces, each four corners counter-clockwise."""
    vertices = [corner for quad in corners for corner in quad]
    faces = [
        (4 * k + a, 4 * k + b, 4 * k + c) for k in range(len(corners)) for a, b, c in ((0, 1, 2), (0, 2, 3))
    ]
    return np.array(vertices, dtype=np.float64), np.array(faces)


def floor(x0=-20.0, x1=20.0, y0=-20.0, y1=20.0, z=0.0, slope=0.0):
    """A rectangle of floor that rises by ``slope`` along x from x = 0."""
    return [
        (x0, y0, z + slope * x0),
        (x1, y0, z + slope * x1),
        (x1, y1, z + slope * x1),
        (x0, y1, z + slope * x0),
    ]


def wall(a, b, height=1.2):
    """An upright face over the line from a to b."""
    return [(*a, 0.0), (*b, 0.0), (*b, height), (*a, height)]


def plane() -> Ground:
    return Ground.from_arrays(*quads(floor()))


def stairs(rise=0.15, tread=0.4, count=6) -> Ground:
    """A floor, steps up along x from x = 2, and a floor on top."""
    parts = [floor(x1=2.0)]
    for k in range(count):
        x, z = 2.0 + k * tread, k * rise
        parts.append([(x, -20, z), (x, 20, z), (x, 20, z + rise), (x, -20, z + rise)][::-1])
        parts.append(floor(x0=x, x1=x + tread if k < count - 1 else 20.0, z=z + rise))
    return Ground.from_arrays(*quads(*parts))


class Straight:
    """A planner that knows straight lines, or one line."""

    def __init__(self, line: np.ndarray | None = None) -> None:
        self.line = line

    def way(self, start, goal, direction) -> SmoothPath:
        return SmoothPath(np.stack([start, goal]) if self.line is None else self.line, (), True)

    def leads(self, start, goal):
        return True

    def room_to_turn(self, points, length):
        return np.ones(len(points), bool)


def animal_on(ground: Ground, body: Body | None = None, at_=(0.0, 0.0, 0.0), yaw=0.0, line=None) -> Animal:
    herd = Herd(ground)
    return Animal(herd, herd.add(body or load_body("dog"), at_, yaw), Straight(line))


def run(animal: Animal, ticks: int = 6000, each=None) -> None:
    """Advance until it is not on its way any more."""
    for _ in range(ticks):
        animal.herd.tick()
        animal.tick()
        if each is not None:
            each()
        if animal.status != "running":
            return
    raise AssertionError(f"still running after {ticks} ticks, {animal.position}")


def bone_toes(animal: Animal) -> np.ndarray:
    """(4, 3) where the last bone of each leg ends, by the transforms."""
    herd, body = animal.herd, animal.body
    names = herd.names(animal.index)
    toes = np.empty((4, 3))
    for leg, name in enumerate(at.LEGS):
        x, y, z, w, i, j, k = herd.pose(animal.index)[names.index(f"{name}_foot")]
        along = np.array([1 - 2 * (j * j + k * k), 2 * (i * j + w * k), 2 * (i * k - w * j)])
        toes[leg] = np.array([x, y, z]) + (body.front_legs if leg < 2 else body.rear_legs).foot * along
    return toes
