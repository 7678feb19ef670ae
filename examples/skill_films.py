"""Makes the film strips of ``docs``: each skill at the lowest, the default and the greatest of its heights.

    python examples/skill_films.py [folder]

A strip shows every 0.12 s from just before the skill begins, seen from the side, of the first start
that arrives.
"""

import sys
from pathlib import Path

import mujoco
import numpy as np
from matplotlib.figure import Figure as Sheet

from locomotion import Human, skill_kinds
from runtime.bodies.figure import Figure
from runtime.evaluation.courses import Course, make_course, run_course
from runtime.views.filmstrip import show_frame
from runtime.views.render import Camera, Triangles, render

FRAMES, COLUMNS, APART = 14, 7, 12
"""Pictures, in a row, and ticks between them."""


def strip(course: Course, frames: list[np.ndarray], before: float, file: Path) -> None:
    """Draw one strip, which begins ``before`` [m] the edge."""
    model, obstacle = Human().model, course.obstacles[0]
    data, figure = mujoco.MjData(model), Figure.from_model(model)
    level = Triangles(course.vertices, course.faces)
    edge = obstacle.position[0]
    first = next(k for k, qpos in enumerate(frames) if qpos[0] > edge - before)
    sheet = Sheet(figsize=(15, 6.0), dpi=75, layout="constrained")
    for k, axes in enumerate(sheet.subplots(FRAMES // COLUMNS, COLUMNS).flat):
        data.qpos[:] = frames[min(first + k * APART, len(frames) - 1)]
        mujoco.mj_kinematics(model, data)
        target = data.qpos[:3] + np.array([0.1, 0.0, -0.15])
        camera = Camera(target + np.array([-0.6, -3.6, 0.7]), target, 0.62)
        shapes = figure.posed(np.hstack([data.xpos, data.xquat])[1:])
        show_frame(axes, render(level, [shapes], camera, (300, 400)), f"{k * APART / 100.0:.2f} s")
    sheet.savefig(file)


def main() -> None:
    """Try starts until one arrives, and draw it."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "docs/pictures")
    usual = {kind.affordance: kind.usual for kind in skill_kinds()}
    for skill in Human().clearing:
        low, high = skill.heights
        for height in (low, usual[skill.affordance], high):
            for distance in np.arange(12.0, 20.0, 0.7):
                course = make_course([(skill.affordance, height, 0.3)], [float(distance)])
                run = run_course(course, keep_frames=True)
                if run.ended == "arrived":
                    file = folder / f"{skill.affordance}-{height:g}.png"
                    strip(course, run.frames, 0.7 * skill.approach(height)[1] + 0.1, file)
                    print(f"wrote {file}", flush=True)
                    break


if __name__ == "__main__":
    main()
