"""Makes the pictures of ``docs/how-it-works/walking.md``, eight moments each: a person walks
over rolling ground, fast on
level ground, round a circle of 0.5 m of radius, goes up steps of 0.17 m and down steps of 0.15 m.

    python examples/walk_films.py [folder]
"""

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Sheet

from locomotion import Ground, Human
from locomotion.ground.ground import extruded
from locomotion.training.gaits.grounds import ground_height, training_ground
from runtime.bodies.figure import Figure
from runtime.views.filmstrip import show_frame
from runtime.views.render import Camera, Triangles, render

FRAMES, APART = 8, {"walk": 0.1, "turn": 0.2, "stairs": 0.2}
"""Moments of a strip, and the time between them [s]."""
FLIGHTS = (("up", 0.17, 0.29), ("down", 0.15, 0.33))
"""Way, height and depth of a step [m]."""
RADIUS = 0.5
"""[m] of the circle."""
STEPS, LANDING = 7, 3.0
"""Steps of a flight; level ground before and behind them [m]."""


def flight(riser: float, tread: float, down: bool) -> tuple[Ground, np.ndarray]:
    """A flight along x, and a path (k, 3) over it."""
    fronts = tread * np.arange(STEPS)
    x = np.concatenate([[-LANDING], np.repeat(fronts, 2), [fronts[-1] + LANDING]])
    z = riser * np.repeat(np.arange(STEPS + 1), 2)
    if down:
        z = z[::-1]
    along = np.arange(-1.0, x[-1] - 1.5, 0.25)
    ground = Ground.from_arrays(*extruded(np.column_stack([x, z]), 2.0))
    return ground, np.column_stack([along, 0.0 * along, np.interp(along, x, z)])


def strip(row: Sequence[Axes], human: Human, ground: Ground, apart: float) -> None:
    """Draw a person from now on, every ``apart`` [s]."""
    first = human.time
    figure, level = Figure.from_model(human.model), Triangles(ground.vertices, ground.faces)
    for k, axes in enumerate(row):
        while human.time < first + k * apart - 1e-9:
            human.tick()
        pose = human.body_transforms()[1:]
        pelvis = pose[0, :3]
        camera = Camera(pelvis + np.array([0.3, -3.4, 0.4]), pelvis + np.array([0.2, 0.0, -0.15]), 0.6)
        show_frame(axes, render(level, [figure.posed(pose)], camera, (230, 300)), f"{human.time:.2f} s")


def film(file: Path, human: Human, ground: Ground, apart: float) -> None:
    """Write one strip."""
    sheet = Sheet(figsize=(16, 2.9), dpi=75, layout="constrained")
    strip(sheet.subplots(1, FRAMES), human, ground, apart)
    sheet.savefig(file)


def walking(ground: Ground, path: np.ndarray, speed: float = 1.0) -> Human:
    """A person that sets off along a path."""
    human = Human(ground)
    human.reset(path[0], 0.0)
    human.follow(path, speed)
    return human


def main() -> None:
    """Walk over rolling ground, fast over level ground, in a circle, up and down stairs, and draw."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "docs/pictures")
    x = np.linspace(-5.0, 15.0, 81)
    for name, kind, speed in (("walk", "rolling", 1.0), ("walk-fast", "level", 2.0)):
        ground = training_ground(kind)
        human = walking(ground, np.column_stack([x, 0.0 * x, ground_height(kind, x, 0.0 * x)]), speed)
        while human.time < 6.0:
            human.tick()
        film(folder / f"{name}.png", human, ground, APART["walk"])

    ground, angle = training_ground("level"), np.linspace(0.0, 4.0 * np.pi, 200)
    human = walking(ground, RADIUS * np.column_stack([np.sin(angle), 1.0 - np.cos(angle), 0.0 * angle]))
    while human.time < 4.0:
        human.tick()
    film(folder / "walk-turn.png", human, ground, APART["turn"])

    sheet = Sheet(figsize=(16, 5.8), dpi=75, layout="constrained")
    for row, (way, riser, tread) in zip(sheet.subplots(len(FLIGHTS), FRAMES), FLIGHTS, strict=True):
        ground, path = flight(riser, tread, way == "down")
        human = walking(ground, path)
        while abs(human.position[2] - path[0, 2]) < 1.5 * riser:
            human.tick()
        strip(row, human, ground, APART["stairs"])
    sheet.savefig(folder / "stairs.png")


if __name__ == "__main__":
    main()
