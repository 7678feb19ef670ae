"""A square full of people: the nearest are simulated, the others play recorded motion, and nobody sees which.

    python -m examples.square                      # prints an address; open it in a browser
    python -m examples.square --picture square.png # or draws it from three cameras after 20 s
    python -m examples.square --page square.html --people 100 --character hero.glb     # or a page of 4 s

A viewer goes round the square. Some people walk across it, some wait, kneel or sit, and dogs run about.
"""

import argparse
import math
import time
from pathlib import Path

import numpy as np

import navmesh
import runtime
from locomotion import Rig

WIDTH = 60.0
"""[m]"""
_PILLARS = [(x, y) for x in (-15.0, 0.0, 15.0) for y in (-15.0, 0.0, 15.0)]
_FRAME = 1 / 60
_FRAMES_A_PICTURE = 4
"""On a page: 15 pictures a second."""
_POSTURES = ("kneel", "sit", "crouch")


def square() -> navmesh.Terrain:
    """The level: a floor with nine pillars of 1 m."""
    half = 0.5 * WIDTH
    corners = [(-half, -half, 0.0), (half, -half, 0.0), (half, half, 0.0), (-half, half, 0.0)]
    faces = [(0, 1, 2), (0, 2, 3)]
    for x, y in _PILLARS:
        first = len(corners)
        for z in (0.0, 4.0):
            corners += [(x + a, y + b, z) for a, b in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))]
        for k in range(4):
            a, b = first + k, first + (k + 1) % 4
            faces += [(a, b, b + 4), (a, b + 4, a + 4)]
        faces += [(first + 4, first + 5, first + 6), (first + 4, first + 6, first + 7)]
    return navmesh.Terrain.from_arrays(np.array(corners), np.array(faces))


def viewer_at(moment: float) -> runtime.Viewer:
    """Somebody who goes round the square once in two minutes and looks at its middle."""
    angle = 2.0 * math.pi * moment / 120.0
    x, y = 24.0 * math.cos(angle), 24.0 * math.sin(angle)
    return runtime.Viewer((x, y, 2.2), (-x, -y, -1.5), math.radians(70.0))


class Square:
    """The world, and what its people do next. A fifth of them may be at full detail, two fifths at medium."""

    def __init__(self, people: int, dogs: int, seed: int) -> None:
        self.world = runtime.World(square(), seed=seed)
        self._places = np.random.default_rng(seed)
        self.world.viewers = [viewer_at(0.0)]
        self.world.budget = runtime.Budget(full=people // 5, medium=2 * people // 5)
        self.people = [
            self.world.spawn("human", self._place(), facing=float(self._places.uniform(-3, 3)), detail="auto")
            for _ in range(people)
        ]
        self.dogs = [self.world.spawn("dog", self._place()) for _ in range(dogs)]
        self._next = dict.fromkeys(self.people + self.dogs, 0.0)

    def _place(self) -> np.ndarray:
        return self.world.graph.random_points(self._places, 1, 1.0)[0]

    def step(self) -> None:
        """One frame."""
        world = self.world
        world.viewers = [viewer_at(world.time)]
        world.step(_FRAME)
        for agent, due in self._next.items():
            if not agent.moving and world.time >= due:
                self._next[agent] = world.time + float(self._places.uniform(1.0, 6.0))
                self._tell(agent)

    def _tell(self, agent: runtime.Agent) -> None:
        chance = float(self._places.random())
        if agent.body == "dog":
            agent.go_to(self._place(), speed=float(self._places.uniform(1.0, 4.0)))
        elif agent.level != "physics" and chance < 0.15:
            agent.take_posture(str(self._places.choice(_POSTURES)))
            self._next[agent] += 8.0
        elif agent.status != "fallen":
            agent.go_to(self._place(), speed=3.2 if chance > 0.93 else float(self._places.uniform(0.8, 1.6)))

    @property
    def counts(self) -> dict[str, int]:
        """How many people there are at each level."""
        levels = [agent.level for agent in self.people]
        return {level: levels.count(level) for level in ("physics", "full", "medium", "low")}


def watch(scene: Square, seconds: float) -> None:
    """Show it in a browser, in real time."""
    view = runtime.LiveView(scene.world)
    print(f"open {view.address}", flush=True)
    begun = time.monotonic()
    while scene.world.time < seconds:
        scene.step()
        view.show()
        time.sleep(max(begun + scene.world.time - time.monotonic(), 0.0))
    view.close()


def draw(scene: Square, path: Path, size: tuple[int, int] = (640, 400)) -> None:
    """Draw it as the viewer, as one on the other side, and from above."""
    from matplotlib.image import imsave

    from runtime.views.render import Camera, Triangles, render

    terrain, agents = scene.world.graph.terrain, scene.world.agents
    shapes = [agents[name].figure.posed(pose) for name, pose in scene.world.transforms().items()]
    eye = np.array(scene.world.viewers[0].position)
    middle = np.array([0.0, 0.0, 0.8])
    eyes = [(eye, middle), (eye * [-1, -1, 1], middle), (np.array([-28.0, -28.0, 24.0]), np.zeros(3))]
    level = Triangles(terrain.vertices, terrain.faces)
    pictures = [render(level, shapes, Camera(*each), size, reach=90.0) for each in eyes]
    imsave(path, np.concatenate(pictures))


def write(scene: Square, path: Path, seconds: float, character: Rig | None) -> None:
    """A page that plays the next ``seconds`` in a browser; people wear the ``character``, if there is one."""
    from runtime.traces.recording import Recorder
    from runtime.views.view import write_page

    recorder = Recorder(scene.world)
    recorder.sample()
    for _ in range(round(seconds / (_FRAMES_A_PICTURE * _FRAME))):
        for _ in range(_FRAMES_A_PICTURE):
            scene.step()
        recorder.sample()
    simulated = next((agent.name for agent in scene.people if agent.level == "physics"), None)
    write_page(recorder.trace({"mission": "a square"}), path, simulated, character)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--people", type=int, default=400)
    parser.add_argument("--dogs", type=int, default=4)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=600.0, help="a picture: 20 at most; a page: 4")
    parser.add_argument("--picture", type=Path)
    parser.add_argument("--page", type=Path, help="an HTML file; of 100 people 6 MB, of 400 23 MB")
    parser.add_argument("--character", type=Path, help="a rigged glTF file, which people wear on the page")
    given = parser.parse_args()
    if given.picture is not None and given.page is not None:
        parser.error("--picture or --page, not both")
    if given.character is not None and given.page is None:
        parser.error("--character is shown on a page: give --page, too")
    character = None if given.character is None else Rig.load(given.character)
    scene = Square(given.people, given.dogs, given.seed)
    if given.page is not None:
        given.page.parent.mkdir(parents=True, exist_ok=True)
        write(scene, given.page, min(given.seconds, 4.0), character)
        print(scene.counts)
        print(f"{given.page}: {given.page.stat().st_size / 1e6:.1f} MB; open it in a browser")
        return
    if given.picture is None:
        watch(scene, given.seconds)
        return
    while scene.world.time < min(given.seconds, 20.0):
        scene.step()
    print(scene.counts)
    draw(scene, given.picture)


if __name__ == "__main__":
    main()
