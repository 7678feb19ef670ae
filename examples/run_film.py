"""Makes the picture of ``docs/how-it-works/running.md``: the person runs at three speeds,
eight moments of two steps each.

python examples/run_film.py [file]
"""

import sys

import numpy as np
from matplotlib.figure import Figure as Sheet

from locomotion.gaits.run import controller
from locomotion.gaits.run.skill import load_run_skill
from locomotion.training.gaits.rollout import Scenario, Simulator
from runtime.bodies.figure import Figure
from runtime.views.filmstrip import show_frame
from runtime.views.render import Camera, Triangles, render

SPEEDS, FRAMES = (2.0, 3.5, 5.0), 8
"""[m/s], one row each; moments of two steps."""
SECONDS = 6.0
"""[s] of each run; its last two steps are shown."""
HALF = 50.0  # [m] of the ground


def main() -> None:
    """Run at each speed and draw."""
    simulator, skill = Simulator(), load_run_skill()
    corners = HALF * np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])
    ground, figure = Triangles(corners, np.array([[0, 1, 2], [0, 2, 3]])), Figure.from_model(simulator.model)
    sheet = Sheet(figsize=(16, 3.0 * len(SPEEDS)), dpi=75, layout="constrained")
    for row, speed in zip(sheet.subplots(len(SPEEDS), FRAMES), SPEEDS, strict=True):
        poses: list[np.ndarray] = []
        touchdowns: list[int] = []

        def note(sim: Simulator, poses: list = poses, touchdowns: list = touchdowns) -> None:
            if sim.state[controller.STEP_TIME] == 0.0:
                touchdowns.append(len(poses))
            poses.append(np.hstack([sim.data.xpos, sim.data.xquat])[1:])

        simulator.run(skill, Scenario(SECONDS, np.array([[0.0, speed]])), note)
        for axes, k in zip(row, np.linspace(touchdowns[-3], touchdowns[-1], FRAMES).round(), strict=True):
            pose = poses[int(k)]
            pelvis = pose[0, :3]
            camera = Camera(pelvis + np.array([0.3, -3.4, 0.4]), pelvis + np.array([0.2, 0.0, -0.15]), 0.62)
            picture = render(ground, [figure.posed(pose)], camera, (230, 300))
            show_frame(axes, picture, f"{0.01 * (k - touchdowns[-3]):.2f} s")
        row[0].set_title(f"{speed:g} m/s", fontsize=10, loc="left")
    sheet.savefig(sys.argv[1] if len(sys.argv) > 1 else "docs/pictures/run.png")


if __name__ == "__main__":
    main()
