"""Makes the pictures of ``docs/how-it-works/learned-walk.md``: the learned walk above the planned one,
from the side and from the front, twelve moments of one cycle; how it comes to a stand, is pushed there,
and sets off; the same views of the learned run above the planned one; how it begins and ends; and eight
people who walk and run, each in its own way.

python examples/learned_walk_film.py [speed of the walk in m/s] [folder]
"""

import sys
from functools import cache
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure as Sheet

from locomotion.body.person import CONTROL_DT, build_person
from locomotion.body.traits import by_chance
from locomotion.gaits.policy.skill import load_policy
from locomotion.human.human import Human
from locomotion.training.policies.trial import PolicyTrial
from runtime.bodies.figure import Figure
from runtime.views.filmstrip import show_frame
from runtime.views.render import Camera, Triangles, render

FRAMES, CYCLE, RUN_CYCLE = 12, 1.1, 0.75
"""Pictures in a row, and the seconds of a walk and a run that they show."""
RUN = 3.5
"""[m/s]"""
SECONDS = 6.0
"""[s] of walking or running before them."""
CHANGE, PUSH = 2.6, 150.0
"""[s] of a change, and [N] for 0.1 s."""
VIEWS = {"side": np.array([0.3, -3.4, 0.3]), "front": np.array([3.4, 0.0, 0.3])}
CORNER = np.array([1.6, -2.9, 0.4])
"""Where the camera is, from the pelvis [m]."""
PEOPLE = 8
HALF = 50.0  # [m] of the ground


def filmed(trial: PolicyTrial, seconds: float) -> np.ndarray:
    """Poses (ticks, bodies, 7) from now on."""
    poses = []
    for _ in range(round(seconds / CONTROL_DT)):
        trial.tick()
        poses.append(np.hstack([trial.data.xpos, trial.data.xquat])[1:])
    return np.array(poses)


def learned(speed: float, seconds: float) -> np.ndarray:
    """Poses of the learned walk or run."""
    trial = PolicyTrial(load_policy())
    trial.go(1.0)
    trial.asked[0] = speed
    trial.go(SECONDS)
    return filmed(trial, seconds)


def planned(speed: float, seconds: float) -> np.ndarray:
    """The same of the planned one."""
    human = Human(None, clearing=(), rehearsals=0)
    human.reset(np.zeros(3), 0.0)
    human.follow(np.array([[0.0, 0.0, 0.0], [1000.0, 0.0, 0.0]]), speed)
    poses = []
    for _ in range(round((SECONDS + seconds) / CONTROL_DT)):
        human.tick()
        poses.append(human.body_transforms()[1:])
    return np.array(poses[-round(seconds / CONTROL_DT) :])


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
        films[name] = filmed(trial, CHANGE)
        trial.go(SECONDS)
    return films


def starts_and_stops(speed: float) -> dict[str, np.ndarray]:
    """Poses of the learned run as it begins out of a walk, and as it ends."""
    trial, films = PolicyTrial(load_policy()), {}
    trial.asked[0] = 1.25
    trial.go(SECONDS)
    for name, told in (("out of a walk", speed), ("to a stand", 0.0)):
        trial.asked[0] = told
        films[name] = filmed(trial, CHANGE)
        trial.go(SECONDS)
    return films


def anybody(speed: float) -> np.ndarray:
    """A pose (people, bodies, 7) of each of some people at this speed, all at the same moment."""
    poses = []
    for seed in range(PEOPLE):
        trial = PolicyTrial(load_policy(), by_chance(seed))
        trial.asked[0] = speed
        poses.append(filmed(trial, SECONDS)[-1])
    return np.array(poses)


def draw_people(rows: dict[str, np.ndarray], file: Path) -> None:
    """A row of pictures for each of ``rows`` of people."""
    sheet = Sheet(figsize=(16, 3.0 * len(rows)), dpi=75, layout="constrained")
    for axes, (name, poses) in zip(sheet.subplots(len(rows), PEOPLE), rows.items(), strict=True):
        for each, pose in zip(axes, poses, strict=True):
            show_frame(each, seen(pose, CORNER, 0.6, (220, 330)), "")
        axes[0].set_title(name, fontsize=10, loc="left")
    sheet.savefig(file)


@cache
def scene() -> tuple[Triangles, Figure]:
    """The ground, and the person's shapes."""
    corners = HALF * np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])
    return Triangles(corners, np.array([[0, 1, 2], [0, 2, 3]])), Figure.from_model(build_person())


def seen(pose: np.ndarray, away: np.ndarray, width: float, size: tuple[int, int]) -> np.ndarray:
    """A picture of a person, seen from ``away`` of its pelvis."""
    ground, figure = scene()
    pelvis = np.array([*pose[0, :2], 0.9])
    camera = Camera(pelvis + away, pelvis + np.array([0.0, 0.0, -0.05]), width)
    return render(ground, [figure.posed(pose)], camera, size)


def draw(films: dict[str, np.ndarray], away: np.ndarray, file: Path) -> None:
    """A row of pictures for each of ``films``, seen from ``away`` of the pelvis."""
    sheet = Sheet(figsize=(18, 2.7 * len(films)), dpi=75, layout="constrained")
    for row, (name, poses) in zip(sheet.subplots(len(films), FRAMES), films.items(), strict=True):
        for axes, k in zip(row, np.linspace(0, len(poses) - 1, FRAMES).round(), strict=True):
            show_frame(axes, seen(poses[int(k)], away, 0.55, (200, 330)), f"{CONTROL_DT * k:.2f} s")
        row[0].set_title(name, fontsize=10, loc="left")
    sheet.savefig(file)


def main() -> None:
    """Walk and draw."""
    speed = float(sys.argv[1]) if len(sys.argv) > 1 else 1.25
    folder = Path(sys.argv[2]) if len(sys.argv) > 2 else Path("docs/pictures")
    for gait, pace, seconds in (("walk", speed, CYCLE), ("run", RUN, RUN_CYCLE)):
        films = {f"{made.__name__}, {pace:g} m/s": made(pace, seconds) for made in (learned, planned)}
        for view, away in VIEWS.items():
            draw(films, away, folder / f"learned-{gait}-{view}.png")
    draw(changes(speed), VIEWS["side"], folder / "learned-walk-rest.png")
    draw(starts_and_stops(RUN), VIEWS["side"], folder / "learned-run-rest.png")
    rows = {f"{pace:g} m/s": anybody(pace) for pace in (speed, RUN)}
    draw_people(rows, folder / "learned-styles.png")


if __name__ == "__main__":
    main()
