"""What somebody sees who looks at the packages for the first time: names, help, versions, types, objects."""

import pydoc
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

import navmesh
import pathsmooth
import runtime
import surefoot
from locomotion.skills.registry import in_words, skill_called, skill_kinds
from navmesh.obstacles.kinds import affordances

ROOT = Path(__file__).parents[2]
PACKAGES = ("navmesh", "pathsmooth", "locomotion", "runtime", "surefoot")


@pytest.mark.parametrize("package", PACKAGES)
def test_packages_tell_their_version_and_are_typed(package):
    module = import_module(package)
    assert module.__version__ == surefoot.__version__ and "__version__" in module.__all__
    assert (ROOT / package / "py.typed").is_file()


@pytest.mark.parametrize("package", [*PACKAGES, "runtime.playtest"])
def test_every_public_name_is_listed_and_there(package):
    module = import_module(package)
    assert set(module.__all__) <= set(dir(module))
    for name in module.__all__:
        assert getattr(module, name) is not None


def test_help_names_what_is_public():
    text = pydoc.render_doc(runtime, renderer=pydoc.plaintext)
    for name in ("class World", "class Agent", "prepare(", "class SkillStarted"):
        assert name in text


def test_objects_tell_what_they_are(graph):
    world = runtime.World(graph)
    ada = world.spawn("walker", (2.0, 3.0, 0.0), name="ada")
    assert repr(world) == "<World on level.obj: 1 agent, 0.00 s>"
    assert repr(ada) == "<Agent 'ada': a walker, standing at [2.0, 3.0, 0.0]>"
    assert repr(graph).startswith("<NodeGraph of level.obj: ") and "obstacles" in repr(graph)
    assert repr(graph.terrain) == "<Terrain level.obj: 4 triangles, 20.0 x 6.0 x 0.0 m>"
    route = graph.find_path((1.0, 1.0, 0.0), (9.0, 1.0, 0.0), radius=0.3)
    assert repr(route) == f"<Route complete: {route.length:.2f} m, {len(route.waypoints)} waypoints>"
    routes = graph.find_paths([(1.0, 1.0, 0.0)] * 2, [(9.0, 1.0, 0.0), (18.0, 3.0, 0.0)], radius=0.3)
    assert repr(routes).startswith("<Routes: 1 complete, 1 ")
    corridor = route.corridor
    problem = pathsmooth.Problem.from_corridor(route.waypoints, corridor.centers, corridor.radii)
    assert repr(problem).startswith("<Problem: ") and repr(pathsmooth.solve(problem)).startswith("<Solution ")
    ada.remove()
    assert repr(ada) == "<Agent 'ada': a walker, removed from its world>"
    arrays = [value for value in (graph.obstacles, world.save()) if "array" in repr(value)]
    assert arrays == []


def test_skills_and_obstacles_have_one_word_each():
    assert [skill_called(kind.skill).affordance for kind in skill_kinds()] == list(affordances())
    assert in_words("leap", 1.2) == in_words("gap", 1.2) == "leaps over 1.20 m"
    assert in_words("drop-roll", 1.0) == "drops 1.00 m and rolls"


def test_terrain_of_arrays_is_called_a_terrain():
    terrain = navmesh.Terrain.from_arrays(np.eye(3), np.array([[0, 1, 2]]))
    assert repr(terrain) == "<Terrain terrain: 1 triangle, 1.0 x 1.0 x 1.0 m>"
