"""Players walk through a city of which only what is around them is loaded.

    python examples/open_world.py [--blocks 20] [--players 2] [--window 90] [--folder city.world] [--picture
    PNG]

A city of 30 m blocks is generated and written as an open world; then each player goes to a place at the other
end, 40 m at a time. After each step it is printed which chunks came and went, what the process holds in
memory above what it held without the level, and how far each player still has to go: over what is loaded, and
beyond. ``--picture`` draws two moments of the first player's walk.
"""

import argparse
import gc
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import psutil
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from benchmarks.large_levels import large_level
from navmesh import OpenWorld, Terrain, WorldRoute, bake_open_world
from surefoot.freed_memory import give_back

STEP = 40.0  # [m]
CHANGES = 2  # chunks in a call
BODY = 0.3  # [m]


@dataclass
class Player:
    """One that walks."""

    at: np.ndarray
    goal: np.ndarray
    walked: list[np.ndarray] = field(default_factory=list)


def held() -> float:
    """Memory of this process [MB], without what it has freed."""
    gc.collect()
    give_back()
    return psutil.Process().memory_info().rss / 1e6


def along(line: np.ndarray, far: float) -> np.ndarray:
    """The place (3,) ``far`` [m] along a ``line`` (k, 3) [m], or its end."""
    at = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    return np.array([np.interp(far, at, line[:, axis]) for axis in range(3)])


def places(world: OpenWorld, size: float, count: int, rng: np.random.Generator) -> list[Player]:
    """Players at one end of the city with goals at the other, all on the ground, where they can be
    reached."""
    found: list[Player] = []
    while len(found) < count:
        start, goal = rng.uniform(0.05, 0.95, (2, 2)) * size
        start[0], goal[0] = 0.03 * size, 0.97 * size
        player = Player(np.append(start, 0.0), np.append(goal, 0.0))
        if world.route(player.at, player.goal, BODY).status == "complete":
            found.append(player)
    return found


def draw(axes: Axes, level: Terrain, there: dict[str, Terrain], player: Player, route: WorldRoute) -> None:
    """The level from above, what of it is loaded, and a player's route."""
    low, high = level.bounds[:, :2]
    for chunk in there.values():
        corner, size = chunk.bounds[0, :2], np.ptp(chunk.bounds[:, :2], axis=0)
        axes.add_patch(Rectangle(corner, *size, color="#dcebf7", zorder=0))
    triangles = level.vertices[level.faces]
    roofs = triangles[triangles[..., 2].min(axis=1) > 1.0][..., :2]
    axes.add_collection(PolyCollection(list(roofs), facecolors="#9a9a9a"))
    if player.walked:
        axes.plot(*np.array([*player.walked, player.at])[:, :2].T, color="#777777", lw=1.2, label="walked")
    if route.fine is not None:
        axes.plot(*route.fine.waypoints[:, :2].T, color="#c0392b", lw=1.8, label="fine route")
    if len(route.beyond):
        first = player.at if route.fine is None else route.fine.waypoints[-1]
        beyond = np.concatenate([first[None], route.beyond])[:, :2]
        axes.plot(*beyond.T, "o--", color="#e08e0b", ms=3, lw=1.0, label="coarse waypoints")
    axes.plot(*player.at[:2], "o", color="#c0392b", ms=7)
    axes.plot(*player.goal[:2], "*", color="#1e8449", ms=11, label="goal")
    axes.set(aspect="equal", xlim=(low[0], high[0]), ylim=(low[1], high[1]), xticks=[], yticks=[])


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--blocks", type=int, default=20, help="of 30 m, along each side")
    parser.add_argument("--players", type=int, default=2)
    parser.add_argument("--window", type=float, default=90.0, help="around each player [m]")
    parser.add_argument("--folder", type=Path, help="where to keep the world; default: nowhere")
    parser.add_argument("--picture", type=Path, help="draw two moments here (PNG)")
    options = parser.parse_args()
    level = large_level("city", options.blocks)
    with tempfile.TemporaryDirectory() as place:
        folder = bake_open_world(level, options.folder or Path(place) / "city.world", (BODY,), 45.0)
        walk(folder, level, options)


def walk(folder: Path, level: Terrain, options: argparse.Namespace) -> None:
    """Let players walk until all have arrived."""
    before = held()
    world = OpenWorld(folder, options.window)
    players = places(world, 30.0 * options.blocks, options.players, np.random.default_rng(0))
    there: dict[str, Terrain] = {}
    figure = Figure(figsize=(11.0, 5.6), layout="constrained")
    panels = list(figure.subplots(1, 2))
    step = 0
    print(f"{world}; holds {held() - before:.0f} MB")
    while players:
        came, gone = 0, 0
        while changes := world.keep_around([player.at for player in players], CHANGES):
            came += sum(chunk is not None for chunk in changes.values())
            gone += sum(chunk is None for chunk in changes.values())
            there |= {name: chunk for name, chunk in changes.items() if chunk is not None}
            there = {name: there[name] for name in world.loaded}
        routes = [world.route(player.at, player.goal, BODY) for player in players]
        ways = "; ".join(
            f"{each.fine.length if each.fine else 0.0:.0f} m and {each.beyond_length:.0f} m beyond"
            for each in routes
        )
        print(
            f"step {step}: +{came} -{gone} chunks, {len(there)} there, {held() - before:.0f} MB; "
            f"to go: {ways}"
        )
        if step in (0, 7) and panels:
            draw(panels.pop(0), level, there, players[0], routes[0])
        for player in players:
            route = routes.pop(0)
            if route.fine is None:
                raise RuntimeError(f"no way on from {player.at}: {route}")
            player.walked.append(player.at)
            player.at = along(route.fine.waypoints, STEP)
        del route  # a route keeps the graph that it was found on
        players = [player for player in players if np.linalg.norm(player.at - player.goal) > 1.0]
        step += 1
    if options.picture:
        figure.axes[0].legend(loc="upper right", fontsize=8)
        figure.savefig(options.picture, dpi=100)


if __name__ == "__main__":
    main()
