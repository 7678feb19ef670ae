"""Makes the picture of stairs in ``docs/walking.md``: a person goes up steps of 0.17 m and down steps of
0.15 m, eight moments each.

python examples/stairs_film.py [file]
"""

import sys

import numpy as np
from matplotlib.figure import Figure as Sheet

from locomotion import Ground, Human
from runtime.figure import Figure
from runtime.filmstrip import show_frame
from runtime.render import Camera, Triangles, render

FRAMES, APART = 8, 0.2
"""Moments, and the time between them [s]."""
FLIGHTS = (("up", 0.17, 0.29), ("down", 0.15, 0.33))
"""Way, height and depth of a step [m]."""
STEPS, BEFORE, AFTER = 7, 3.0, 3.0
"""Steps; level ground before and behind them [m]."""


def flight(riser: float, tread: float, down: bool) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Vertices (n, 3) and faces (m, 3) of a flight along x, and a path (k, 3) over it."""
    fronts = tread * np.arange(STEPS)
    x = np.concatenate([[-BEFORE], np.repeat(fronts, 2), [fronts[-1] + AFTER]])
    z = riser * np.repeat(np.arange(STEPS + 1), 2)
    if down:
        x, z = x[::-1].max() - BEFORE - x[::-1], z[::-1]
    low, n = np.arange(len(x) - 1), len(x)
    vertices = np.concatenate([np.column_stack([x, np.full(n, y), z]) for y in (-2.0, 2.0)])
    faces = np.concatenate(
        [np.column_stack([low, low + 1, low + n + 1]), np.column_stack([low, low + n + 1, low + n])]
    )
    along = np.arange(x[0] + 2.0, x[-1] - 1.5, 0.25)
    return vertices, faces, np.column_stack([along, np.zeros_like(along), np.interp(along, x, z)])


def main() -> None:
    """Walk up and down at 1 m/s and draw."""
    sheet = Sheet(figsize=(16, 5.8), dpi=75, layout="constrained")
    for row, (way, riser, tread) in zip(sheet.subplots(len(FLIGHTS), FRAMES), FLIGHTS, strict=True):
        vertices, faces, path = flight(riser, tread, way == "down")
        human = Human(Ground.from_arrays(vertices, faces))
        human.reset(path[0], 0.0)
        human.follow(path, 1.0)
        while abs(human.position[2] - path[0, 2]) < 1.5 * riser:
            human.tick()
        first = human.time
        figure, level = Figure.from_model(human.model), Triangles(vertices, faces)
        for k, axes in enumerate(row):
            while human.time < first + k * APART - 1e-9:
                human.tick()
            pose = human.body_transforms()[1:]
            pelvis = pose[0, :3]
            camera = Camera(pelvis + np.array([0.3, -3.4, 0.4]), pelvis + np.array([0.0, 0.0, -0.15]), 0.6)
            show_frame(axes, render(level, [figure.posed(pose)], camera, (230, 300)), f"{human.time:.2f} s")
    sheet.savefig(sys.argv[1] if len(sys.argv) > 1 else "docs/pictures/stairs.png")


if __name__ == "__main__":
    main()
