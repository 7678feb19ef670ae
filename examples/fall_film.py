"""Makes the picture of falls in ``docs/how-it-works/getting-up.md``: people who stand, walk and run are
pushed over, forward, to a side and backward; eight moments of each, from when the fall is noticed.

python examples/fall_film.py [file]
"""

import math
import sys
from collections.abc import Iterator

import numpy as np
from matplotlib.figure import Figure as Sheet
from numpy.typing import NDArray

from locomotion import Human
from locomotion.body.person import CONTROL_DT
from locomotion.body_events import Fell
from locomotion.gaits.policy.skill import load_policy
from runtime.bodies.figure import Figure
from runtime.views.filmstrip import show_frame
from runtime.views.render import Camera, Triangles, render

FALLS = (
    ("runs, pushed forward to its left", 3.5, 60.0, 550.0),
    ("walks, pushed forward", 1.25, 0.0, 500.0),
    ("stands, pushed to its left", 0.0, 90.0, 450.0),
    ("walks, pushed backward", 1.25, 180.0, 450.0),
)
"""What it says, speed [m/s], side of the push [deg from ahead], force [N]."""
MOMENTS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 0.9)
"""[s] after the fall was noticed."""
_CORNERS = np.array([[-5.0, -9.0, 0.0], [60.0, -9.0, 0.0], [60.0, 9.0, 0.0], [-5.0, 9.0, 0.0]])


def moments(human: Human, speed: float, side: float, newtons: float) -> Iterator[NDArray[np.float64]]:
    """Poses of the fall."""
    human.events.clear()
    human.reset((0.0, 0.0, 0.0), 0.0)
    if speed > 0.0:
        human.follow([[0.0, 0.0, 0.0], [60.0, 0.0, 0.0]], speed)
    for _ in range(round(4.0 / CONTROL_DT)):
        human.tick()
    angle = math.radians(side)
    human.push((newtons * math.cos(angle), newtons * math.sin(angle), 0.0), 0.3)
    while not any(isinstance(event, Fell) for event in human.events):
        human.tick()
    noticed = human.time
    for moment in MOMENTS:
        while human.time < noticed + moment - 1e-9:
            human.tick()
        yield human.body_transforms()[1:]


def main() -> None:
    """Push people over and draw."""
    human = Human(None, clearing=(), gets_up=True, policy=load_policy())
    figure, floor = Figure.from_model(human.model), Triangles(_CORNERS, np.array([[0, 1, 2], [0, 2, 3]]))
    sheet = Sheet(figsize=(16, 2.5 * len(FALLS)), dpi=60, layout="constrained")
    for row, (words, speed, side, newtons) in zip(
        sheet.subplots(len(FALLS), len(MOMENTS)), FALLS, strict=True
    ):
        poses = moments(human, speed, side, newtons)
        for axes, moment, pose in zip(row, MOMENTS, poses, strict=True):
            x, y = pose[0, :2]
            camera = Camera(np.array([x + 1.2, y - 3.0, 1.0]), np.array([x, y, 0.55]), 0.62)
            label = words if moment == 0.0 else f"{moment:.1f} s"
            show_frame(axes, render(floor, [figure.posed(pose)], camera, (230, 270)), label)
    sheet.savefig(sys.argv[1] if len(sys.argv) > 1 else "docs/pictures/fall.png")


if __name__ == "__main__":
    main()
