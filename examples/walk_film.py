"""Makes the picture of ``docs/walking.md``: a person walks over rolling ground, eight moments of two steps.

python examples/walk_film.py [file]
"""

import sys

import numpy as np
from matplotlib.figure import Figure as Sheet

from locomotion import Human
from locomotion.training.grounds import ground_height, training_ground
from runtime.figure import Figure
from runtime.filmstrip import show_frame
from runtime.render import Camera, Triangles, render

FRAMES, FIRST, APART = 8, 6.0, 0.1
"""Moments, and their times [s]."""


def main() -> None:
    """Walk 14 m at 1 m/s and draw."""
    ground = training_ground("rolling")
    x = np.linspace(-5.0, 9.0, 57)
    path = np.column_stack([x, np.zeros_like(x), ground_height("rolling", x, np.zeros_like(x))])
    human = Human(ground)
    human.reset(path[0], 0.0)
    human.follow(path, 1.0)
    figure, level = Figure.from_model(human.model), Triangles(ground.vertices, ground.faces)
    sheet = Sheet(figsize=(16, 2.9), dpi=75, layout="constrained")
    for k, axes in enumerate(sheet.subplots(1, FRAMES)):
        while human.time < FIRST + k * APART - 1e-9:
            human.tick()
        pose = human.body_transforms()[1:]
        pelvis = pose[0, :3]
        camera = Camera(pelvis + np.array([0.3, -3.4, 0.4]), pelvis + np.array([0.2, 0.0, -0.15]), 0.6)
        show_frame(axes, render(level, [figure.posed(pose)], camera, (230, 300)), f"{human.time:.2f} s")
    sheet.savefig(sys.argv[1] if len(sys.argv) > 1 else "docs/pictures/walk.png")


if __name__ == "__main__":
    main()
