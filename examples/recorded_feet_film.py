"""Makes the picture of feet on stairs and a slope in ``docs/guides/recorded-motion.md``.

python examples/recorded_feet_film.py [file]
"""

import sys

import numpy as np
from matplotlib.figure import Figure as Sheet

import navmesh
import runtime
from runtime.views.filmstrip import show_frame
from runtime.views.render import Camera, Triangles, render

LEVELS = ("full", "medium", "low")
FRAMES = 8
STEPS, RISE, TREAD, SLOPE = 8, 0.17, 0.3, 0.25


def course() -> navmesh.Terrain:
    """A floor, stairs up, a landing and a slope down, along x."""
    profile = [(-2.0, 0.0)]
    for step in range(STEPS):
        x = 4.0 + TREAD * step
        profile += [(x, RISE * step), (x, RISE * (step + 1))]
    top, end = RISE * STEPS, 8.0 + RISE * STEPS / SLOPE
    profile += [(8.0, top), (end, 0.0), (end + 4.0, 0.0)]
    line = np.array(profile)
    corners = np.column_stack(
        [np.tile(line[:, 0], 2), np.repeat([-3.0, 3.0], len(line)), np.tile(line[:, 1], 2)]
    )
    right = np.arange(len(line) - 1)
    left = right + len(line)
    faces = np.concatenate(
        [np.column_stack([right, right + 1, left + 1]), np.column_stack([right, left + 1, left])]
    )
    return navmesh.Terrain.from_arrays(corners, faces)


def main() -> None:
    """Draw all."""
    file = sys.argv[1] if len(sys.argv) > 1 else "docs/pictures/recorded-feet.png"
    terrain = course()
    ground = Triangles(terrain.vertices, terrain.faces)
    sheet = Sheet(figsize=(18, 12.0), dpi=75, layout="constrained")
    rows = iter(sheet.subplots(2 * len(LEVELS), FRAMES))
    for level in LEVELS:
        for begin in (4.3, 9.0):
            world = runtime.World(terrain, seed=0)
            ada = world.spawn("human", at=(1.0, 0.0, 0.0), detail=level)
            ada.go_to((12.0, 0.0, 0.0), speed=1.1)
            while ada.position[0] < begin:
                world.step(0.02)
            for number, axes in enumerate(next(rows)):
                target = np.array([ada.position[0] + 0.1, 0.0, ada.position[2] + 0.55])
                camera = Camera(target + np.array([0.3, -2.9, 0.5]), target, 0.55)
                show_frame(
                    axes, render(ground, [ada.figure.posed(ada.pose.transforms)], camera, (230, 230)), ""
                )
                if number == 0:
                    axes.text(0.05, 0.9, level, transform=axes.transAxes, fontsize=13)
                world.step(0.16)
    sheet.savefig(file)


if __name__ == "__main__":
    main()
