"""Strips of people at all levels of detail: docs/pictures/postures.png, a switch as level-switch.png, and
people of several sizes as recorded-sizes.png.

python -m examples.posture_films docs/pictures
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure as Page

import runtime
from benchmarks.giving_way import floor
from runtime.bodies.held_things import Looks
from runtime.views.filmstrip import show_frame
from runtime.views.render import Camera, Triangles, render

LEVELS = ("full", "medium", "low")
POSTURES = ("stand", "crouch", "kneel", "all-fours", "prone", "sit", "dead")
_SIZE, _WIDE = (160, 168), (400, 260)
_APART = 2 / 60  # [s] between pictures of a switch
_Pictures = list[list[tuple[np.ndarray, str]]]


class Artist:
    """Draws an agent from its right."""

    def __init__(self) -> None:
        self.graph = floor((-5.0, -5.0, 60.0, 40.0))
        terrain = self.graph.terrain
        self._level = Triangles(terrain.vertices, terrain.faces)

    def draw(self, agent: runtime.Agent) -> np.ndarray:
        """(height, width, 3) uint8."""
        place = agent.pose.transforms
        target = np.array([*place[0, :2], 0.8])
        camera = Camera(target + np.array([0.3, -3.6, 0.8]), target, 0.62)
        figure, place = Looks().look(agent.name, agent.figure, place, agent.held[0])
        return render(self._level, [figure.posed(place)], camera, _SIZE)

    def draw_all(self, world: runtime.World) -> np.ndarray:
        """(height, width, 3) uint8 all agents of a ``world``, from before them."""
        agents = list(world.agents.values())
        target = np.mean([agent.position for agent in agents], axis=0) + np.array([0.0, 0.0, 0.9])
        camera = Camera(target + np.array([5.5, -1.5, 0.6]), target, 0.62)
        figures = [agent.figure.posed(agent.pose.transforms) for agent in agents]
        return render(self._level, figures, camera, _WIDE)


def postures(artist: Artist) -> _Pictures:
    """A row for each level: all postures, a rifle in use, a walk, a run."""
    rows = []
    for level in LEVELS:
        world, row = runtime.World(artist.graph, seed=1), []
        for posture in POSTURES:
            agent = world.spawn("human", (0.0, 5.0, 0.0), facing=-1.2, detail=level)
            agent.take_posture(posture)
            world.step(6.0)
            row.append((artist.draw(agent), f"{level}: {posture}"))
            agent.remove()
        agent = world.spawn("human", (0.0, 5.0, 0.0), facing=-1.2, detail=level)
        agent.hold("rifle", "in use")
        world.step(2.0)
        row.append((artist.draw(agent), f"{level}: rifle in use"))
        for speed, name in ((1.4, "walk"), (3.4, "run")):
            agent = world.spawn("human", (0.0, 15.0 + 5.0 * speed, 0.0), detail=level)
            agent.go_to((55.0, 15.0 + 5.0 * speed, 0.0), speed=speed)
            world.step(3.0)
            row.append((artist.draw(agent), f"{level}: {name}"))
        rows.append(row)
    return rows


def switches(artist: Artist) -> _Pictures:
    """A row for each switch: on a walk and on a run, to physics and from it, with the fourth picture."""
    world, rows = runtime.World(artist.graph, seed=2), []
    for speed in (1.3, 3.3):
        for first, then in (("full", "physics"), ("physics", "full")):
            agent = world.spawn("human", (0.0, 5.0, 0.0), detail=first)
            agent.go_to((55.0, 5.0, 0.0), speed=speed)
            world.step(4.0)
            row = []
            for k in range(10):
                if k == 3:
                    agent.detail = then
                row.append((artist.draw(agent), f"{agent.level}, {k * _APART:.2f} s"))
                world.step(_APART)
            rows.append(row)
            agent.remove()
    return rows


def sizes(artist: Artist) -> _Pictures:
    """People of 1.55 to 1.90 m who walk side by side, simulated and at each level of recorded motion."""
    row = []
    for level in ("physics", *LEVELS):
        world = runtime.World(artist.graph, seed=3)
        for number, size in enumerate(np.linspace(0.88, 1.08, 5)):
            agent = world.spawn("human", (0.0, 5.0 + 0.8 * number, 0.0), detail=level)
            agent.set_style(size=float(size))
            agent.go_to((55.0, 5.0 + 0.8 * number, 0.0), speed=1.3)
        world.step(4.0)
        row.append((artist.draw_all(world), f"{level}: 1.55 to 1.90 m"))
    return [row]


def write(rows: _Pictures, path: Path) -> None:
    """Put the pictures into one file."""
    height, width = rows[0][0][0].shape[:2]
    page = Page(figsize=(0.01 * width * len(rows[0]), 0.01 * height * len(rows)), dpi=75)
    page.subplots_adjust(0.0, 0.0, 1.0, 1.0, 0.02, 0.02)
    for line, row in zip(page.subplots(len(rows), len(rows[0]), squeeze=False), rows, strict=True):
        for axes, (picture, label) in zip(line, row, strict=True):
            show_frame(axes, picture, label)
    page.savefig(path)


if __name__ == "__main__":
    folder, painter = Path(sys.argv[1]), Artist()
    write(postures(painter), folder / "postures.png")
    write(switches(painter), folder / "level-switch.png")
    write(sizes(painter), folder / "recorded-sizes.png")
