"""Makes the film strips of ``docs/guides/dogs.md``: each motion in six moments, from the side and from above,
some of them from the front, too.

python examples/dog_films.py [folder] [name ...]
"""

import math
import sys
from pathlib import Path

import numpy as np
import trimesh
from matplotlib.figure import Figure as Sheet

import navmesh
from locomotion import Ground
from locomotion.quadruped import Herd, lay_trail, load_body
from runtime import World
from runtime.bodies.animal_figure import animal_figure
from runtime.bodies.figure import Shapes
from runtime.planning.rules import walk_rules
from runtime.views.render import Camera, Triangles, render

COLUMNS = 6
SIZE = (260, 195)
TICK = 0.01


def floor(half: float = 30.0) -> trimesh.Trimesh:
    """A square floor at z = 0."""
    corners = [[-half, -half, 0], [half, -half, 0], [half, half, 0], [-half, half, 0]]
    return trimesh.Trimesh(corners, [[0, 1, 2], [0, 2, 3]], process=False)


def wall(x0: float, x1: float, y0: float, y1: float, height: float = 0.7) -> trimesh.Trimesh:
    """A box on the floor."""
    return trimesh.creation.box(bounds=[[x0, y0, 0.0], [x1, y1, height]])


def dots(points: np.ndarray, colour: tuple[float, float, float], size: float) -> Shapes:
    """Flat dots on the floor."""
    place = np.zeros((len(points), 7))
    place[:, :3], place[:, 3] = points, 1.0
    return Shapes(
        place, np.full((len(points), 3), size) * [1.0, 1.0, 0.3], np.ones(len(points), bool),
        np.tile(colour, (len(points), 1)),
    )  # fmt: skip


class Film:
    """Moments of a run and how to draw them."""

    def __init__(self, title: str, level: trimesh.Trimesh, reach: float) -> None:
        self.title, self.reach = title, reach
        self.level = Triangles(np.asarray(level.vertices), np.asarray(level.faces))
        self.moments: list[tuple[float, np.ndarray, np.ndarray, float]] = []
        self.path = np.empty((0, 3))
        self.view = 0.0
        self.rise = 0.16
        self.front = False
        """Whether it is drawn from the front, too."""

    def draw(self, figure, path: Path, span: tuple[float, float] | None = None) -> None:
        """Write the strip: six moments, evenly spaced between two times."""
        times = np.array([moment[0] for moment in self.moments])
        first, last = span or (times[0], times[-1])
        picks = np.searchsorted(times, np.linspace(first, last, COLUMNS)).clip(0, len(times) - 1)
        rows = 3 if self.front else 2
        sheet = Sheet(figsize=(COLUMNS * 2.6, rows * 1.95 + 0.4), dpi=100, layout="constrained")
        sheet.suptitle(self.title, fontsize=10)
        axes = sheet.subplots(rows, COLUMNS)
        for column, pick in enumerate(picks):
            now, pose, middle, yaw = self.moments[pick]
            shapes = figure.posed(pose)
            near = self.path[::2][np.linalg.norm(self.path[::2] - middle, axis=1) < 1.1 * self.reach]
            drawn = [shapes]
            if len(near):
                drawn.append(dots(near + np.array([0.0, 0.0, 0.004]), (0.84, 0.15, 0.16), 0.014))
            along = self.view
            side = np.array([math.sin(along), -math.cos(along), 0.0])
            ahead = np.array([math.cos(yaw), math.sin(yaw), self.rise])
            cameras = [
                Camera(middle + self.reach * (side + np.array([0.0, 0.0, self.rise])), middle, 0.5),
                Camera(middle + self.reach * np.array([0.0, -0.001, 1.15]), middle, 0.5),
            ]
            if self.front:
                cameras.insert(1, Camera(middle + self.reach * ahead, middle, 0.5))
            for row, camera in enumerate(cameras):
                ax = axes[row, column]
                ax.imshow(render(self.level, drawn, camera, SIZE, cutaway=self.reach - 0.7))
                ax.set_axis_off()
            axes[0, column].set_title(f"{now:.2f} s", fontsize=8)
        sheet.savefig(path)


def follow(
    name: str, title: str, points: np.ndarray, speed: float, flex: float | None = None, reach: float = 2.6
) -> tuple[Film, object]:
    """A body follows points on the floor."""
    mesh = floor(max(30.0, float(np.abs(points).max()) + 5.0))
    ground = Ground.from_arrays(mesh.vertices, mesh.faces)
    body = load_body(name)
    if flex is not None:
        body = body.model_copy(update={"spine": body.spine.model_copy(update={"flex": flex})})
    herd = Herd(ground)
    trail = lay_trail(points, body, ground)
    index = herd.add(body, points[0], trail.heading(0.0))
    herd.follow(index, trail, speed)
    film = Film(title, mesh, reach)
    film.path = trail.points
    while not herd.resting(index):
        herd.tick()
        root, front = herd.root(index), herd.front(index)
        middle = np.array([*(0.5 * (root[:2] + front)), 0.3])
        film.moments.append((len(film.moments) * TICK, herd.pose(index), middle, float(root[3])))
    return film, animal_figure(body)


def straight(speed: float, length: float = 8.0) -> np.ndarray:
    """A straight path along x, long enough to see one stride at full speed."""
    return np.array([[0.0, 0.0, 0.0], [length + 2.0 * speed, 0.0, 0.0]])


def s_curve() -> np.ndarray:
    """Two bends of 0.5 m radius."""
    turn = np.linspace(0.0, 1.5 * math.pi, 40)
    first = np.column_stack([0.5 * np.sin(turn), 0.5 - 0.5 * np.cos(turn)])
    back = first[-1] - (first[::-1] - first[-1])
    track = np.concatenate([[[-1.5, 0.0]], first, back[1:], [back[-1] + [1.5, 0.0]]])
    return np.column_stack([track, np.zeros(len(track))])


def walk(name: str, gait: str, speed: float, reach: float) -> tuple[Film, object, tuple[float, float]]:
    """One stride at full speed."""
    body = load_body(name)
    gathers = speed**2 / body.movement.acceleration
    way = straight(speed, 8.0 + gathers)
    film, figure = follow(name, f"{name}: {gait} at {speed:g} m/s, one stride", way, speed, None, reach)
    film.front = True
    frequency = body.gaits[gait].frequency[0] + body.gaits[gait].frequency[1] * speed
    middle = film.moments[-1][0] * 0.5
    return film, figure, (middle, middle + 1.0 / frequency)


def into_gallop(name: str, reach: float) -> tuple[Film, object, tuple[float, float]]:
    """From the last of the trot to where the gallop's order has been found."""
    body = load_body(name)
    speed = 1.3 * body.gaits["trot"].up_to
    film, figure = follow(name, f"{name}: trot into gallop", straight(speed, 20.0), speed, None, reach)
    changes = (body.gaits["trot"].up_to) / body.movement.acceleration  # [s]
    stride = 1.0 / (body.gaits["gallop"].frequency[0])
    return film, figure, (changes - 0.3 * stride, changes + 1.9 * stride)


def stands(name: str, reach: float) -> tuple[Film, object, tuple[float, float]]:
    """What one does that nobody tells to do anything, over half a minute."""
    mesh = floor()
    herd = Herd(Ground.from_arrays(mesh.vertices, mesh.faces))
    body = load_body(name)
    herd.add(body, (0.0, 0.0, 0.0), 0.0)
    film = Film(f"{name}: standing", mesh, reach)
    film.front = True
    for tick in range(3600):
        herd.tick()
        if tick % 50 == 0:
            middle = np.array([0.5 * body.spine.length, 0.0, 0.3])
            film.moments.append((tick * TICK, herd.pose(0), middle, 0.0))
    return film, animal_figure(body), (4.0, 34.0)


def world_film(title: str, level: trimesh.Trimesh, at, facing: float, goals, speeds, reach: float = 3.0):
    """A dog in a world, from goal to goal."""
    terrain = navmesh.Terrain.from_arrays(np.asarray(level.vertices), np.asarray(level.faces))
    graph = navmesh.NodeGraph.build(terrain, walk_rules(["dog"], resolution=0.1))
    world = World(graph, seed=0)
    dog = world.spawn("dog", at, facing)
    film = Film(title, level, reach)
    for goal, speed in zip(goals, speeds, strict=True):
        dog.go_to(goal, speed)
        while dog.status == "running" and world.time < 60.0:
            world.step(TICK)
            root = dog.animal.herd.root(dog.animal.index)
            middle = np.array([*(0.5 * (root[:2] + dog.position[:2])), 0.3])
            film.moments.append((world.time, dog.pose.transforms, middle, float(root[3])))
    film.path = np.concatenate([plan.points for plan in dog.plans])
    return film, dog.figure


def dead_end() -> trimesh.Trimesh:
    """A room, and a passage of 0.5 m off it that is closed at its end."""
    parts = [
        floor(6.0),
        wall(0.0, 2.6, 0.25, 0.45),
        wall(0.0, 2.6, -0.45, -0.25),
        wall(2.4, 2.6, -0.25, 0.25),
    ]
    return trimesh.util.concatenate(parts)


def films() -> dict:
    """Every strip: what makes (film, figure, span)."""
    return {
        "dog-walk": lambda: walk("dog", "walk", 1.0, 2.6),
        "dog-trot": lambda: walk("dog", "trot", 2.2, 2.6),
        "dog-gallop": lambda: walk("dog", "gallop", 5.0, 3.0),
        "dog-into-gallop": lambda: into_gallop("dog", 2.8),
        "horse-into-gallop": lambda: into_gallop("horse", 7.5),
        "cat-gallop": lambda: walk("cat", "gallop", 5.0, 1.6),
        "horse-gallop": lambda: walk("horse", "gallop", 11.0, 7.0),
        "dog-stands": lambda: stands("dog", 2.6),
        "horse-stands": lambda: stands("horse", 7.0),
        "cat-walk": lambda: walk("cat", "walk", 0.6, 1.6),
        "horse-walk": lambda: walk("horse", "walk", 1.5, 7.0),
        "dog-curve-little": lambda: (
            *follow("dog", "S-curve of 0.5 m radius, little flex (0.2)", s_curve(), 0.8, 0.2), (2.0, 6.0),
        ),
        "dog-curve-much": lambda: (
            *follow("dog", "S-curve of 0.5 m radius, much flex (1.3)", s_curve(), 0.8, 1.3), (2.0, 6.0),
        ),
        "dog-start": lambda: (
            *world_film(
                "start: the front turns onto the path, then the dog sets off", floor(6.0), (0, 0, 0), 0.6,
                [(4.0, 0.0, 0.0)], [1.2],
            ), (0.0, 1.8),
        ),
        "dog-stop": lambda: _stop(),
        "dog-dead-end": lambda: _dead_end(),
    }  # fmt: skip


def _stop():
    film, figure = world_film(
        "stop out of a bend: the front stays, the rear slides out", floor(6.0), (-3, 0, 0), 0.0,
        [[(0.0, 0.0, 0.0), (0.1, 0.4, 0.0)]], [1.2],
    )  # fmt: skip
    end = film.moments[-1][0]
    return film, figure, (end - 1.2, end)


def _dead_end():
    film, figure = world_film(
        "dead end of 0.5 m: backing out along the crumbs, turning where there is room", dead_end(),
        (-2, 0, 0), 0.0, [(2.0, 0.0, 0.0), (-3.0, 0.5, 0.0)], [1.0, 1.0], 3.4,
    )  # fmt: skip
    film.rise = 1.5
    return film, figure, (3.5, film.moments[-1][0] - 1.0)


def main(folder: Path, names: list[str]) -> None:
    """Write the strips of ``names``, or all, into ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    made = films()
    for name in names or made:
        film, figure, span = made[name]()
        film.draw(figure, folder / f"{name}.png", span)
        print(folder / f"{name}.png")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("docs/pictures"), sys.argv[2:])
