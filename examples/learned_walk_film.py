"""Makes the pictures of ``docs/how-it-works/learned-walk.md``: the learned walk above the planned one,
from the side and from the front, twelve moments of one cycle; and how it comes to a stand, is pushed there,
and sets off.

python examples/learned_walk_film.py [speed in m/s] [folder]
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure as Sheet

from locomotion.body.person import CONTROL_DT, build_person
from locomotion.gaits.policy.skill import load_policy
from locomotion.human.human import Human
from locomotion.training.policies.trial import PolicyTrial
from runtime.bodies.figure import Figure
from runtime.views.filmstrip import show_frame
from runtime.views.render import Camera, Triangles, render

FRAMES, CYCLE = 12, 1.1
"""Pictures in a row, and the seconds that they show."""
SECONDS = 6.0
"""[s] of walking before them."""
CHANGE, PUSH = 2.6, 150.0
"""[s] of a change, and [N] for 0.1 s."""
VIEWS = {"side": np.array([0.3, -3.4, 0.3]), "front": np.array([3.4, 0.0, 0.3])}
"""Where the camera is, from the pelvis [m]."""
HALF = 50.0  # [m] of the ground


def learned(speed: float) -> np.ndarray:
    """Poses (ticks, bodies, 7) of the learned walk."""
    trial = PolicyTrial(load_policy())
    trial.go(1.0)
    trial.asked[0] = speed
    trial.go(SECONDS)
    poses = []
    for _ in range(round(CYCLE / CONTROL_DT)):
        trial.tick()
        poses.append(np.hstack([trial.data.xpos, trial.data.xquat])[1:])
    return np.array(poses)


def planned(speed: float) -> np.ndarray:
    """The same of the planned walk."""
    human = Human(None, clearing=(), rehearsals=0)
    human.reset(np.zeros(3), 0.0)
    human.follow(np.array([[0.0, 0.0, 0.0], [1000.0, 0.0, 0.0]]), speed)
    poses = []
    for _ in range(round((SECONDS + CYCLE) / CONTROL_DT)):
        human.tick()
        poses.append(human.body_transforms()[1:])
    return np.array(poses[-round(CYCLE / CONTROL_DT) :])


def changes(speed: float) -> dict[str, np.ndarray]:
    """Poses of the learned walk as it comes to rest, is pushed, and sets off."""
    trial, films = PolicyTrial(load_policy()), {}
    trial.asked[0] = speed
    trial.go(SECONDS)
    for name, told, push in (
        ("to a stand", 0.0, 0.0),
        (f"pushed with {PUSH:g} N", 0.0, PUSH),
        ("from a stand", speed, 0.0),
    ):
        trial.asked[0] = told
        if push:
            trial.push(push, 0.0)
        poses = []
        for _ in range(round(CHANGE / CONTROL_DT)):
            trial.tick()
            poses.append(np.hstack([trial.data.xpos, trial.data.xquat])[1:])
        films[name] = np.array(poses)
        trial.go(SECONDS)
    return films


def draw(films: dict[str, np.ndarray], away: np.ndarray, file: Path) -> None:
    """A row of pictures for each of ``films``, seen from ``away`` of the pelvis."""
    corners = HALF * np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])
    ground, figure = Triangles(corners, np.array([[0, 1, 2], [0, 2, 3]])), Figure.from_model(build_person())
    sheet = Sheet(figsize=(18, 2.7 * len(films)), dpi=75, layout="constrained")
    for row, (name, poses) in zip(sheet.subplots(len(films), FRAMES), films.items(), strict=True):
        for axes, k in zip(row, np.linspace(0, len(poses) - 1, FRAMES).round(), strict=True):
            pose = poses[int(k)]
            pelvis = np.array([*pose[0, :2], 0.9])
            camera = Camera(pelvis + away, pelvis + np.array([0.0, 0.0, -0.05]), 0.55)
            show_frame(
                axes, render(ground, [figure.posed(pose)], camera, (200, 330)), f"{CONTROL_DT * k:.2f} s"
            )
        row[0].set_title(name, fontsize=10, loc="left")
    sheet.savefig(file)


def main() -> None:
    """Walk and draw."""
    speed = float(sys.argv[1]) if len(sys.argv) > 1 else 1.25
    folder = Path(sys.argv[2]) if len(sys.argv) > 2 else Path("docs/pictures")
    walks = {f"learned, {speed:g} m/s": learned(speed), f"planned, {speed:g} m/s": planned(speed)}
    for view, away in VIEWS.items():
        draw(walks, away, folder / f"learned-walk-{view}.png")
    draw(changes(speed), VIEWS["side"], folder / "learned-walk-rest.png")


if __name__ == "__main__":
    main()
