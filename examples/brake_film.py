"""Makes the picture of a stop in ``docs/how-it-works/walking.md``: a person that runs at 3 m/s is told
to stop; eight moments, and how far it has come.

python examples/brake_film.py [file]
"""

import sys

import numpy as np
from matplotlib.figure import Figure as Sheet

from locomotion import Human
from runtime.bodies.figure import Figure
from runtime.views.filmstrip import show_frame
from runtime.views.render import Camera, Triangles, render

SPEED, TOLD = 3.0, 3.5
"""[m/s] asked for; [s] after which it is told to stop."""
MOMENTS = (0.0, 0.15, 0.3, 0.45, 0.6, 0.8, 1.1, 2.0)
"""[s] after it is told."""


def main() -> None:
    """Run, stop and draw."""
    human = Human(None, clearing=())
    human.reset((0.0, 0.0, 0.0), 0.0, SPEED)
    human.follow([[0.0, 0.0, 0.0], [60.0, 0.0, 0.0]], SPEED)
    while human.time < TOLD:
        human.tick()
    told_at = human.com[0]
    human.stop()
    corners = np.array([[-5.0, -5.0, 0.0], [40.0, -5.0, 0.0], [40.0, 5.0, 0.0], [-5.0, 5.0, 0.0]])
    figure = Figure.from_model(human.model)
    floor = Triangles(corners, np.array([[0, 1, 2], [0, 2, 3]]))
    sheet = Sheet(figsize=(16, 2.9), dpi=75, layout="constrained")
    for axes, moment in zip(sheet.subplots(1, len(MOMENTS)), MOMENTS, strict=True):
        while human.time < TOLD + moment - 1e-9:
            human.tick()
        pose = human.body_transforms()[1:]
        x, y = pose[0, :2]
        camera = Camera(np.array([x + 0.1, y - 3.6, 1.2]), np.array([x + 0.1, y, 0.85]), 0.6)
        label = f"{moment:.2f} s, {human.com[0] - told_at:.2f} m"
        show_frame(axes, render(floor, [figure.posed(pose)], camera, (230, 300)), label)
    sheet.savefig(sys.argv[1] if len(sys.argv) > 1 else "docs/pictures/brake.png")


if __name__ == "__main__":
    main()
