"""People walk through a city of which only what is around one of them, the player, is loaded.

    python examples/open_world_people.py [--blocks 8] [--window 70] [--seconds 150] [--picture PNG]

A city of 30 m blocks is generated and written as an open world, and a world of agents is made of it. The
player, a dog and two walkers set out for places at the other end, where nothing is loaded yet. It prints what
happens to them, and how many chunks come and go. ``--picture`` draws three moments from above: what is loaded
is blue, and a cross is where somebody waits for more.
"""

import argparse
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

import runtime
from benchmarks.large_levels import large_level
from navmesh import OpenWorld, Terrain, bake_open_world
from runtime.planning.rules import obstacle_rules, person_walk_rules

RADII = (0.25, 0.3)  # [m] of those who walk there
SIDE = 30.0  # [m] of a chunk
BODIES = {"player": "human", "dog": "dog", "early": "walker", "late": "walker"}
SPEEDS = {"player": 3.0, "dog": 3.0, "early": 4.5, "late": 1.2}
COLOURS = {"player": "#c0392b", "dog": "#8e44ad", "early": "#e08e0b", "late": "#1e8449"}


def made(folder: Path, window: float, size: float) -> tuple[runtime.World, dict[str, np.ndarray]]:
    """The world with everybody in it and on the way, and where each of them goes."""
    start, far = np.array([15.0, 15.0, 0.0]), size - 6.0
    city = OpenWorld(folder, radius=window)
    city.keep_around(start, changes=100)
    world = runtime.World(city, seed=0)
    goals = {}
    for number, (name, body) in enumerate(BODIES.items()):
        agent = world.spawn(body, start + np.array([0.0, 0.8 * number, 0.0]), name=name)
        goals[name] = np.array([far - 2.0 * (number + 1), far, 0.0])
        agent.go_to(goals[name], speed=SPEEDS[name])
    world.players = [world.agents["player"]]
    return world, goals


def draw(
    axes: Axes, level: Terrain, world: runtime.World, trails: dict[str, list], goals: dict[str, np.ndarray]
) -> None:
    """The level from above, what of it is loaded, where everybody was and is."""
    low, high = level.bounds[:, :2]
    for name in world.loaded:
        corner = SIDE * np.array([int(each) for each in name.split(",")])
        axes.add_patch(Rectangle(corner, SIDE, SIDE, color="#dcebf7", zorder=0))
    triangles = level.vertices[level.faces]
    roofs = triangles[triangles[..., 2].min(axis=1) > 1.0][..., :2]
    axes.add_collection(PolyCollection(list(roofs), facecolors="#b5b5b5"))
    for name, agent in world.agents.items():
        colour = COLOURS[name]
        axes.plot(*np.array(trails[name])[:, :2].T, color=colour, lw=1.2)
        if agent.way is not None:
            axes.plot(*agent.way.points[:, :2].T, color=colour, lw=0.8, ls=":")
        marker = "X" if agent.status == "waiting" else "o"
        axes.plot(*agent.position[:2], marker, color=colour, ms=8, label=f"{name}: {agent.status}")
        axes.plot(*goals[name][:2], "*", color=colour, ms=8)
    axes.set(aspect="equal", xlim=(low[0], high[0]), ylim=(low[1], high[1]), xticks=[], yticks=[])
    axes.set_title(f"{world.time:.0f} s: {len(world.loaded)} chunks loaded", fontsize=9)
    axes.legend(loc="upper left", fontsize=7)


def walk(
    world: runtime.World, seconds: float, see: Callable[[float, dict[str, list]], None]
) -> tuple[int, int]:
    """Let everybody walk; ``see`` is called every half second. Returns how many chunks came and went."""
    trails: dict[str, list] = {name: [] for name in world.agents}
    before, came, gone = set(world.loaded), 0, 0
    while world.time < seconds and any(agent.status != "arrived" for agent in world.agents.values()):
        world.step(0.5)
        for event in world.events:
            print(f"{event.time:6.1f} s: {event}")
        for name, agent in world.agents.items():
            trails[name].append(agent.position)
        came, gone = came + len(set(world.loaded) - before), gone + len(before - set(world.loaded))
        before = set(world.loaded)
        see(world.time, trails)
    return came, gone


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--blocks", type=int, default=8, help="of 30 m, along each side")
    parser.add_argument("--window", type=float, default=70.0, help="around the player [m]")
    parser.add_argument("--seconds", type=float, default=150.0, help="at most, of simulated time")
    parser.add_argument("--picture", type=Path, help="draw three moments here (PNG)")
    options = parser.parse_args()
    level = large_level("city", options.blocks)
    rules = person_walk_rules(), obstacle_rules({})
    figure = Figure(figsize=(14.0, 5.0), layout="constrained")
    panels = list(zip((12.0, 55.0, 98.0), figure.subplots(1, 3), strict=True))
    with tempfile.TemporaryDirectory() as place:
        folder = bake_open_world(level, Path(place) / "city.world", RADII, SIDE, *rules)
        world, goals = made(folder, options.window, SIDE * options.blocks)

        def see(now: float, trails: dict[str, list]) -> None:
            if panels and now >= panels[0][0]:
                draw(panels.pop(0)[1], level, world, trails, goals)

        came, gone = walk(world, options.seconds, see)
        print(f"{came} chunks came and {gone} went; {len(world.loaded)} are loaded")
    if options.picture:
        figure.savefig(options.picture, dpi=80)


if __name__ == "__main__":
    main()
