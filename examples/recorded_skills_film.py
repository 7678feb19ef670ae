"""Makes the picture of recorded skills in ``docs/guides/recorded-motion.md``: obstacles of other sizes than
those that were recorded.

python examples/recorded_skills_film.py [file]
"""

import sys

import numpy as np
from matplotlib.figure import Figure as Sheet

import navmesh
import runtime
from locomotion.skills.course import make_course
from runtime.planning.rules import person_walk_rules
from runtime.views.filmstrip import show_frame
from runtime.views.render import Camera, Triangles, render

OBSTACLES = (
    ("jump", 0.25, "full"), ("jump", 0.6, "low"), ("vault", 0.62, "full"), ("vault", 0.9, "medium"),
    ("drop", 1.0, "full"), ("drop", 1.9, "low"), ("gap", 0.6, "medium"), ("gap", 1.6, "full"),
)  # fmt: skip
"""Kind and size [m], and the level of detail that clears it."""
FRAMES, EVERY = 9, 0.13
THICK = 0.25  # [m] of the walls


def main() -> None:
    """Draw all."""
    file = sys.argv[1] if len(sys.argv) > 1 else "docs/pictures/recorded-skills.png"
    sheet = Sheet(figsize=(18, 15.0), dpi=75, layout="constrained")
    for (kind, size, level), row in zip(OBSTACLES, sheet.subplots(len(OBSTACLES), FRAMES), strict=True):
        course = make_course([(kind, size, THICK)], [7.0])
        terrain = navmesh.Terrain.from_arrays(course.vertices, course.faces)
        ground = Triangles(course.vertices, course.faces)
        world = runtime.World(navmesh.NodeGraph.build(terrain, person_walk_rules()), seed=0)
        ada = world.spawn("human", at=(1.0, 0.0, 0.0), detail=level)
        ada.go_to(course.path[-1], speed=1.4)
        while not any(isinstance(event, runtime.SkillStarted) for event in world.events):
            world.step(1.0 / 60.0)
        for number, axes in enumerate(row):
            pose = ada.pose.transforms
            target = np.array([pose[0, 0], 0.0, pose[0, 2] - 0.2])
            camera = Camera(target + np.array([0.4, -3.8, 0.6]), target, 0.55)
            show_frame(axes, render(ground, [ada.figure.posed(pose)], camera, (210, 210)), "")
            if number == 0:
                axes.text(0.05, 0.88, f"{kind} {size:g} m\n{level}", transform=axes.transAxes, fontsize=12)
            world.step(EVERY)
    sheet.savefig(file)


if __name__ == "__main__":
    main()
