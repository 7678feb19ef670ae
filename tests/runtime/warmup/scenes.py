"""What happens in worlds: ``python -m tests.runtime.warmup.scenes`` prints how many kernels it compiles, and
which it uses that are not prepared."""

from pathlib import Path

import numpy as np

import navmesh
from runtime import World
from runtime.events import Fell, SkillStarted
from runtime.world.level_of_detail import Viewer
from surefoot.compile_notice import counted
from surefoot.kernels.cache import used
from surefoot.preparing import mark_of_kernels
from tests.scenarios.pinned_runs import box

LEVELS = Path(__file__).parents[3] / "examples" / "levels"


def another_level() -> None:
    """Neither bodies, queries nor calls are those that the uses have together."""
    graph = navmesh.NodeGraph.build(
        navmesh.Terrain.load(str(LEVELS / "room.obj"), up="z"), navmesh.WalkRules(resolution=0.2)
    )
    world = World(graph, seed=3)
    places = graph.random_points(np.random.default_rng(2), 12, radius=0.4)
    for k, body in enumerate(("human", "human", "walker", "walker", "walker")):
        world.spawn(body, places[k]).go_to(places[k + 5], speed=1.4)
    world.spawn("cat", (4.0, 3.0, 0.0)).go_to(places[11], speed=1.0)
    world.step(2.0)
    saved = world.save()
    world.step(1.0)
    world.restore(saved)
    world.step(0.5)
    graph.find_paths(places[:6], places[6:], radius=0.25)
    graph.cast_ray(places[0], places[1], 0.2)
    graph.random_points(np.random.default_rng(3), 2)


def whatever_happens() -> None:
    """Every kind of body, skills, a fall, postures, other levels of detail, orders in mid-way, a level that
    changes, saving and restoring."""
    graph = navmesh.NodeGraph.build(navmesh.Terrain.load(str(LEVELS / "courtyard.obj"), up="z"))
    world = World(graph, seed=4)
    jumper = world.spawn("human", (16.0, 4.4, 0.0), detail="physics")
    jumper.human.reset((16.0, 4.4, 0.0), 0.0, 3.3)  # it runs already
    faller = world.spawn("human", (6.0, 8.0, 0.0), facing=0.4)
    seen = world.spawn("human", (4.0, 24.0, 0.0), detail="auto")
    far = world.spawn("human", (4.0, 29.0, 0.0), detail="medium")
    walker = world.spawn("walker", (8.0, 27.0, 0.0))
    animals = [
        world.spawn(body, (x, y, 0.0))
        for body, x, y in (("dog", 4.0, 26.0), ("cat", 12.0, 24.0), ("horse", 16.0, 28.0))
    ]
    world.viewers = [Viewer((4.0, 24.0, 1.7), (1.0, 0.0, 0.0))]
    jumper.go_to((32.0, 4.4, 0.3), speed=3.3)
    faller.go_to((12.0, 8.0, 0.0), speed=1.3)
    for agent, goal in ((seen, 12.0), (far, 14.0), (walker, 4.0), *((each, 20.0) for each in animals)):
        agent.go_to((goal, 26.0, 0.0), speed=1.5)
    world.step(1.5)
    faller.human.data.xfrc_applied[faller.human.index.root, :2] = (-200.0, 900.0)
    world.step(0.2)
    faller.human.data.xfrc_applied[:] = 0.0
    far.detail, seen.detail = "full", "physics"
    animals[0].go_to((4.0, 31.0, 0.0), speed=2.5)
    animals[1].stop()
    saved = world.save()
    world.step(1.0)
    far.stop()
    far.hold("rifle")
    seen.stop()
    world.transforms()
    world.step(1.0)
    far.take_posture("prone")
    world.viewers = []
    seen.detail = "low"
    world.step(0.5)
    happened = {type(event) for event in world.events}
    world.restore(saved)
    world.change_level({"crate": box((10.0, 25.0, 0.0), (11.0, 27.0, 0.7))})
    walker.go_to((14.0, 24.0, 0.0), speed=1.5)
    world.step(0.5)
    for agent in (faller, jumper, far):
        agent.remove()
    assert {Fell, SkillStarted} <= happened


def main() -> None:
    mark = mark_of_kernels()
    assert mark is not None
    prepared, compiled = set(mark.read_text(encoding="utf-8").split()), []
    with counted(compiled.append):
        another_level()
        whatever_happens()
    assert len(used()) > 100
    print(f"{len(compiled)} compiled;", *sorted(used() - prepared))


if __name__ == "__main__":
    main()
