"""Makes ``docs/pictures/characters.png``: a person, and below it the characters of ``make_characters.py``
that show what it does: a jump onto 0.5 m, and postures.

    python examples/character_film.py [folder]
"""

import sys
import tempfile
from pathlib import Path

import mujoco
import numpy as np
from make_characters import CHARACTERS, write_character
from matplotlib.figure import Figure as Sheet

from locomotion import Ground, Human, Rig
from locomotion.characters.skinning import posed_points
from locomotion.data import POSTURES
from locomotion.postures.posture_file import load_postures
from runtime.bodies.figure import Figure
from runtime.evaluation.courses import make_course, run_course
from runtime.views.render import Camera, Triangles, render

HEIGHT, APART = 0.5, 14
SHOWN = ("kneel", "all-fours", "crouch")


def moments() -> tuple[np.ndarray, np.ndarray, list[np.ndarray]]:
    """Vertices and faces of the course, and the poses (46,) to show on it."""
    for distance in np.arange(13.0, 20.0, 0.7):
        course = make_course([("jump", HEIGHT, 0.3)], [float(distance)])
        run = run_course(course, keep_frames=True)
        if run.ended == "arrived":
            break
    edge = course.obstacles[0].position[0]
    first = next(k for k, qpos in enumerate(run.frames) if qpos[0] > edge - 1.9)
    poses = [run.frames[first + k * APART] for k in range(6)]
    graph = load_postures(POSTURES / "person.yaml")
    return course.vertices, course.faces, poses + [graph.poses[graph.postures.index(name)] for name in SHOWN]


def main() -> None:
    """Draw all of them."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "docs/pictures")
    vertices, faces, poses = moments()
    model = Human().model
    data, figure = mujoco.MjData(model), Figure.from_model(model)
    level, ground = Triangles(vertices, faces), Ground.from_arrays(vertices, faces)
    with tempfile.TemporaryDirectory() as temporary:
        files = [Path(temporary) / f"{who.name}.glb" for who in CHARACTERS]
        for who, file in zip(CHARACTERS, files, strict=True):
            write_character(who, file)
        rigs = [Rig.load(file) for file in files]
    sheet = Sheet(figsize=(1.6 * len(poses), 7.6), dpi=75, layout="constrained")
    grid = sheet.subplots(4, len(poses))
    for column, qpos in enumerate(poses):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        places = np.hstack([data.xpos, data.xquat])[1 : 1 + len(figure.bodies)]
        target = np.array([qpos[0], qpos[1], 1.1 if column < 6 else 0.75])
        camera = Camera(target + np.array([0.9, -4.0, 0.6]), target, 0.66)
        pictures = [render(level, [figure.posed(places)], camera, (220, 260))]
        for rig in rigs:
            points = posed_points(rig.skeleton, rig.pose_from(places, figure.bodies, ground))
            mesh = rig.skeleton.mesh
            skin = Triangles(points, mesh.faces, mesh.colours)
            pictures.append(render(level, [], camera, (220, 260), skins=[skin]))
        for axes, picture in zip(grid[:, column], pictures, strict=True):
            axes.imshow(picture)
            axes.set_axis_off()
    sheet.savefig(folder / "characters.png")


if __name__ == "__main__":
    main()
