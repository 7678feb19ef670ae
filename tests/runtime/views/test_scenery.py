"""What live views draw of a level: its surface, its graph, its obstacles, and the paths through it."""

from typing import Any

import numpy as np
import pytest

from runtime.traces.trace import LevelTrace, PathTrace
from runtime.views.obstacle_colours import obstacle_colour, parts_of_colour
from runtime.views.scenery import draw_level, draw_paths, silent


class Scene:
    """Keeps what is added to it, by name."""

    def __init__(self):
        self.added: dict[str, tuple[str, tuple[Any, ...], dict[str, Any]]] = {}

    def __getattr__(self, kind):
        def add(name, *values, **options):
            assert name not in self.added
            self.added[name] = kind.removeprefix("add_"), values, options
            return name

        return add

    def kinds(self):
        return {name.removeprefix("/run/level"): kind for name, (kind, *_) in self.added.items()}


def level(radii, edges, rims=()):
    n = len(radii)
    return LevelTrace(
        vertices=np.zeros((3, 3)), faces=np.array([[0, 1, 2]]),
        positions=np.column_stack([np.arange(n), np.zeros(n), np.zeros(n)]), radii=np.array(radii),
        edges=np.array(edges, int).reshape(-1, 2), affordances=tuple("jump" for _ in rims),
        rim=np.array(rims).reshape(-1, 2, 3), normal=np.zeros((len(rims), 3)), height=np.full(len(rims), 0.4),
    )  # fmt: skip


def test_of_the_graph_only_wide_discs_and_the_edges_between_them_are_drawn():
    scene = Scene()
    assert draw_level(scene, level([0.5, 0.6, 0.1], [[0, 1], [1, 2]])) == "/run/level"
    assert scene.kinds() == {
        "": "frame", "/surface": "mesh_simple", "/graph/discs": "line_segments",
        "/graph/edges": "line_segments",
    }  # fmt: skip
    discs = scene.added["/run/level/graph/discs"][1][0]
    assert discs.shape == (40, 2, 3)
    away = np.linalg.norm(discs[:20, :, :2] - [0.0, 0.0], axis=2)
    assert away == pytest.approx(0.5)
    assert np.array_equal(discs[:, 1][:19], discs[:, 0][1:20])  # closed line
    (edges,) = scene.added["/run/level/graph/edges"][1]
    assert edges[:, :, 0].tolist() == [[0.0, 1.0]]


def test_a_level_without_wide_discs_has_no_edges():
    scene = Scene()
    draw_level(scene, level([0.2, 0.1], [[0, 1]]))
    assert "/graph/edges" not in scene.kinds()


def test_long_obstacles_are_named_beside_their_edge():
    scene = Scene()
    rims = [[[0.0, 0, 0], [3.0, 0, 0]], [[0.0, 5, 0], [1.0, 5, 0]]]
    draw_level(scene, level([0.5], [], rims))
    _, _, options = scene.added["/run/level/obstacles/jump 0"]
    assert options["colors"] == parts_of_colour(obstacle_colour("jump"))
    kind, (text,), options = scene.added["/run/level/obstacles/jump 0/label"]
    assert (kind, text) == ("label", "jump 0.40 m") and options["position"][0] == pytest.approx(1.5)
    assert "/run/level/obstacles/jump 1" in scene.added
    assert "/run/level/obstacles/jump 1/label" not in scene.added


def test_paths_are_three_lines_each_or_nothing():
    points = np.array([[0.0, 0, 0], [1.0, 0, 0], [2.0, 1, 0]])
    scene = Scene()
    draw_paths(
        scene, "/ada", [PathTrace(points[:2], points, points), PathTrace(points[:2], points[:2], points)]
    )
    counts = {name: len(values[0]) for name, (_, values, _) in scene.added.items()}
    assert counts == {"/ada/raw": 2, "/ada/pulled": 3, "/ada/smooth": 4}
    scene = Scene()
    draw_paths(scene, "/tom", [])
    assert {kind for kind, *_ in scene.added.values()} == {"frame"}


def test_what_the_viewer_says_is_not_printed(capsys):
    with silent():
        print("listening")
    assert capsys.readouterr().out == ""
