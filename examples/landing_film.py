"""Makes the picture of landings in ``docs/how-it-works/landing.md``: a person vaults over a wall without
rehearsals, as planned, from the first of some starts from which it falls behind the wall, and from there
once more with the network that corrects landings.

python examples/landing_film.py [file]
"""

import sys

import numpy as np
from matplotlib.figure import Figure as Sheet

from locomotion import MOVING, Ground, Human
from locomotion.human.human import BetweenGaits
from locomotion.skills.course import Course, make_course
from runtime.bodies.figure import Figure
from runtime.views.filmstrip import show_frame
from runtime.views.render import Camera, Triangles, render

HEIGHT, THICKNESS = 0.85, 0.3
STARTS = np.arange(9.0, 16.0, 0.35)
"""[m] of the wall; from the start to it."""
SPEED = 3.5
"""[m/s] asked for."""
MOMENTS = (-0.3, 0.0, 0.2, 0.4, 0.7, 1.0, 1.4, 1.9, 2.4)
"""[s] after the landing."""


def vault(course: Course, corrected: bool) -> tuple[list[np.ndarray], int, Human]:
    """Places of the bodies in each tick, the tick of the landing, and the person."""
    between = BetweenGaits(landing=True if corrected else None)
    human = Human(Ground.from_arrays(course.vertices, course.faces), rehearsals=0, between=between)
    human.reset(course.path[0], 0.0)
    human.follow(course.path, SPEED, course.obstacles)
    poses, landed = [], 0
    while not human.held and (not landed or len(poses) < landed + 100.0 * MOMENTS[-1] + 1):
        human.tick()
        poses.append(human.body_transforms()[1:])
        if not landed and human.on_feet.landing.acts:
            landed = len(poses)
        if not landed and human.status not in MOVING:
            break
    return poses, landed, human


def main() -> None:
    """Find a start, vault twice and draw."""
    for distance in STARTS:
        course = make_course([("vault", HEIGHT, THICKNESS)], [float(distance)])
        planned = vault(course, corrected=False)
        if planned[1] and planned[2].status == "fallen":
            break
    figure = Figure.from_model(planned[2].model)
    floor = Triangles(course.vertices, course.faces)
    sheet = Sheet(figsize=(16, 5.6), dpi=75, layout="constrained")
    rows = sheet.subplots(2, len(MOMENTS))
    for row, (poses, landed, _), name in zip(
        rows, (planned, vault(course, corrected=True)), ("as planned", "corrected"), strict=True
    ):
        for axes, moment in zip(row, MOMENTS, strict=True):
            pose = poses[min(landed + round(100 * moment), len(poses) - 1)]
            x, y = pose[0, :2]
            camera = Camera(np.array([x + 0.1, y - 3.6, 1.2]), np.array([x + 0.1, y, 0.85]), 0.6)
            view = render(floor, [figure.posed(pose)], camera, (230, 300))
            show_frame(axes, view, name if moment < 0.0 else f"{moment:.1f} s")
    sheet.savefig(sys.argv[1] if len(sys.argv) > 1 else "docs/pictures/landing.png")


if __name__ == "__main__":
    main()
