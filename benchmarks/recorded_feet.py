"""Feet of recorded people in a world: how far they slide in a stance, and how far off the ground they are.

    python -m benchmarks.recorded_feet [--people 6] [--seed 1]

People walk one after the other over a level floor, up a flight of stairs, over a landing and down a slope, at
speeds of their own, and are looked at 60 times a second. A stance is the share of the cycle for which a foot
bears; its slide is how far the heel or the ball, whichever it stands on, moves meanwhile.
"""

import argparse

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

import navmesh
from locomotion.ground.ground import extruded
from locomotion.recorded.footfalls import BALL, BEARS, FEET, HEEL, STRIKES, footing_at
from locomotion.recorded.motion_set import load_motions
from locomotion.recorded.skeletons import LEVELS
from locomotion.recorded_people import layout as at
from runtime import Agent, World
from runtime.bodies.recorded import RecordedDriver
from runtime.planning.rules import person_walk_rules

__all__ = ["PARTS", "course", "slides_of", "walked"]

PARTS = {"level": (0.0, 10.0), "stairs": (10.0, 13.0), "slope": (16.0, 26.0)}
"""[m] along the course, x, of what there is; a landing lies between them."""
_STEPS, _RISE, _TREAD, _SLOPE, _HALF = 10, 0.17, 0.3, 0.15, 6.0
_MOTIONS = load_motions()
FRAME = 1.0 / 60.0


def course() -> navmesh.NodeGraph:
    """The level: a strip along x, 12 m wide."""
    profile = [(-2.0, 0.0)]
    for step in range(_STEPS):
        x = PARTS["stairs"][0] + _TREAD * step
        profile += [(x, _RISE * step), (x, _RISE * (step + 1))]
    low = _RISE * _STEPS - _SLOPE * 10.0
    profile += [(16.0, _RISE * _STEPS), (26.0, low), (34.0, low)]
    vertices, faces = extruded(profile, _HALF)
    terrain = navmesh.Terrain.from_arrays(vertices, faces)
    return navmesh.NodeGraph.build(terrain, person_walk_rules())


def walked(
    graph: navmesh.NodeGraph, level: str, people: int, seed: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
    """Ends of the soles (frames, people, foot, heel and ball, 3) and the heights of the ground under them, of
    people who walk along `course` and back at random speeds; and whether each foot bears."""
    world, rng = World(graph, seed=seed), np.random.default_rng(seed)
    agents = [
        world.spawn("human", (1.0 + 0.5 * (k % 3), -4.0 + 8.0 * k / max(people - 1, 1), 0.0), detail=level)
        for k in range(people)
    ]
    for agent in agents:
        away = [30.0, float(rng.uniform(-4.0, 4.0)), _RISE * _STEPS - _SLOPE * 10.0]
        back = [2.0, float(rng.uniform(-4.0, 4.0)), 0.0]
        agent.go_to(np.array([away, back]), speed=float(rng.uniform(0.7, 1.7)))
    feet = [agents[0].figure.bodies.index(name) for name in FEET]
    frames, bears = [], []
    while any(agent.moving for agent in agents) and world.time < 120.0:
        world.step(FRAME)
        frames.append(np.array([places[feet] for places in world.transforms().values()]))
        bears.append([_bears(agent) for agent in agents])
    places = np.array(frames)
    turns = Rotation.from_quat(places[..., 3:].reshape(-1, 4), scalar_first=True)
    ends = np.stack(
        [places[..., :3] + turns.apply(end).reshape((*places.shape[:3], 3)) for end in (HEEL, BALL)], axis=3
    )
    ground = agents[0].driver.ground
    assert ground is not None
    above = ends.reshape(-1, 3) + np.array([0.0, 0.0, 0.15])
    return ends, ground.surface_below(above)[0].reshape(ends.shape[:4]), np.array(bears)


def _bears(agent: Agent) -> list[bool]:
    """Whether the right and the left foot bears, of one that walks."""
    driver = agent.driver
    assert isinstance(driver, RecordedDriver)
    row = driver.person.row
    if row[at.GAIT] != 0.0:
        return [False, False]
    table = footing_at(_MOTIONS, _MOTIONS.gait("walk"), [row[at.SPEED]])[0]
    return [bool((driver.person.phase - foot[STRIKES]) % 1.0 < foot[BEARS]) for foot in table]


def slides_of(
    ends: NDArray[np.float64],
    heights: NDArray[np.float64],
    bears: NDArray[np.bool_],
    part: tuple[float, float],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Slides [m] of all stances on a ``part`` of the course, and how far the sole is over the ground in the
    middle of each [m] (below 0: under it)."""
    slides, gaps = [], []
    for person in range(ends.shape[1]):
        for foot in range(2):
            for first, last in _runs(bears[:, person, foot]):
                path = ends[first:last, person, foot]
                if last - first < 8 or path[..., 0].min() < part[0] or path[..., 0].max() > part[1]:
                    continue
                lowest = path[..., 2].min(axis=1)
                moved = [
                    float(np.linalg.norm(np.ptp(path[on, end, :2], axis=0)))
                    for end in range(2)
                    if (on := path[:, end, 2] < lowest + 0.003).any()
                ]
                slides.append(max(moved))
                middle = (last - first) // 2
                gaps.append(float(np.min(path[middle, :, 2] - heights[first + middle, person, foot])))
    return np.array(slides), np.array(gaps)


def _runs(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First and end of each run of true ones."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--people", type=int, default=6)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    graph = course()
    for level in LEVELS:
        found = walked(graph, level, given.people, given.seed)
        for name, part in PARTS.items():
            inner = (part[0] + 3.0, part[1]) if name == "level" else part
            slides, gaps = slides_of(*found, inner)
            print(
                f"{level:6} {name:6} {len(slides)} stances: slide {100 * np.median(slides):.2f} cm in the "
                f"median, {100 * np.percentile(slides, 95):.2f} at the 95th percentile, "
                f"{100 * slides.max():.2f} at most; sole over the ground {100 * np.nanmin(gaps):.1f} to "
                f"{100 * np.nanmax(gaps):.1f} cm"
            )


if __name__ == "__main__":
    main()
