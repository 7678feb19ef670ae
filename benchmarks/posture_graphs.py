"""Posture graphs: the quickest way against all ways, and whether anything ever jumps.

    python -m benchmarks.posture_graphs [--graphs 1000] [--moments 1000] [--seed 1]

Random graphs: the least time between all postures, against a search through every path without a posture
twice. The package's graph of a person: random requests at random moments, with things in the hands, and the
fatal posture from random moments; steps are between frames of 1/60 s.
"""

import argparse
from pathlib import Path

import numpy as np

from locomotion.body.person import JOINT_NAMES
from locomotion.data import POSTURES
from locomotion.errors import LocomotionError
from locomotion.postures.places import inverse
from locomotion.postures.playback import Playback, asked_for, at_rest, pose_at, settled
from locomotion.postures.posture_file import load_postures
from locomotion.postures.posture_graph import PostureGraph

__all__ = ["brute_force", "fatal_figures", "random_graph", "request_figures", "unequal"]

FRAME = 1.0 / 60.0


def brute_force(graph: PostureGraph) -> np.ndarray:
    """(p, p) [s] by trying every path without a posture twice."""
    count = len(graph.postures)
    least = np.full((count, count), np.inf)

    def walk(first: int, here: int, spent: float, seen: set[int]) -> None:
        least[first, here] = min(least[first, here], spent)
        for arc in np.flatnonzero(graph.start == here).tolist():
            end = int(graph.end[arc])
            if end not in seen:
                walk(first, end, spent + graph.seconds[arc], {*seen, end})

    for first in range(count):
        walk(first, first, 0.0, {first})
    return least


def random_graph(rng: np.random.Generator, postures: int = 6, arcs: int = 12) -> PostureGraph:
    """Postures of random angles, arcs of a few frames that lead anywhere, some with opposites."""
    size = 7 + len(JOINT_NAMES)
    poses = np.zeros((postures, size))
    poses[:, 2], poses[:, 3], poses[:, 7:] = 0.9, 1.0, rng.uniform(-0.5, 0.5, (postures, size - 7))
    start, end, frames, moves, seconds, first, backwards = [], [], [], [], [], [], []
    for _ in range(arcs):
        a, b = rng.choice(postures, 2, replace=False)
        move = np.array([*rng.uniform(-1, 1, 2), rng.uniform(-3, 3)])
        share = np.linspace(0.0, 1.0, 5)[:, None]
        made = (1 - share) * poses[a] + share * poses[b]
        made[:, :2] = share * move[:2]
        made[:, 3], made[:, 6] = np.cos(0.5 * share[:, 0] * move[2]), np.sin(0.5 * share[:, 0] * move[2])
        for reverse in (False, True)[: 1 + int(rng.random() < 0.5)]:
            start.append(b if reverse else a)
            end.append(a if reverse else b)
            first.append(5 * len(frames))
            backwards.append(reverse)
            seconds.append(seconds[-1] if reverse else rng.uniform(0.2, 2.0))
            moves.append(inverse(move) if reverse else move)
        frames.append(made)
    return PostureGraph(
        "random", tuple(f"p{k}" for k in range(postures)), postures - 1, 0.7, poses,
        np.array(start, np.int32), np.array(end, np.int32), np.array(seconds), np.array(moves),
        np.array(backwards), np.concatenate(frames), np.array(first, np.int32),
        np.full(len(start), 5, np.int32),
    )  # fmt: skip


def unequal(graphs: int, rng: np.random.Generator) -> int:
    """How many random graphs have a least time that differs from that of all ways."""
    wrong = 0
    for _ in range(graphs):
        graph = random_graph(rng, postures=int(rng.integers(2, 7)), arcs=int(rng.integers(1, 12)))
        wrong += not np.allclose(graph.least, brute_force(graph))
    return wrong


def step(
    graph: PostureGraph, playback: Playback, now: float, before: np.ndarray
) -> tuple[np.ndarray, float, float]:
    """The pose at ``now``, and by how much a joint [degrees] and the root [m] differ from ``before``."""
    pose = pose_at(graph, playback, now)
    apart = float(np.linalg.norm(pose[:3] - before[:3]))
    return pose, float(np.degrees(np.abs(pose[7:] - before[7:]).max())), apart


def request_figures(graph: PostureGraph, requests: int, rng: np.random.Generator) -> tuple[float, float]:
    """Greatest step of a joint [degrees] and of the root [m] in so many requests at random moments."""
    playback, now, joint, root = at_rest(graph, graph.postures[0], (0.0, 0.0, 0.0)), 0.0, 0.0, 0.0
    pose = pose_at(graph, playback, now)
    for _ in range(requests):
        until = now + float(rng.exponential(0.7))
        while now < until:
            now += FRAME
            pose, turned, moved = step(graph, playback, now, pose)
            joint, root = max(joint, turned), max(root, moved)
        try:
            playback = asked_for(graph, playback, str(rng.choice(graph.postures)), now)
        except LocomotionError:  # from the fatal posture there is no way
            playback = at_rest(graph, graph.postures[0], (0.0, 0.0, 0.0))
            pose = pose_at(graph, playback, now)
    return joint, root


def fatal_figures(graph: PostureGraph, moments: int, rng: np.random.Generator) -> tuple[int, float]:
    """From how many of so many random moments the fatal posture is not reached, and the greatest step of a
    joint [degrees] on the way."""
    missed, worst = 0, 0.0
    able = [k for k in range(len(graph.postures)) if k != graph.fatal]
    for _ in range(moments):
        here, there = rng.choice(able, 2)
        playback = at_rest(graph, graph.postures[here], (0.0, 0.0, 0.0))
        playback = asked_for(graph, playback, graph.postures[there], 0.0)
        now = float(rng.uniform(0.0, 4.0))
        pose = pose_at(graph, playback, now)
        playback = asked_for(graph, playback, graph.postures[graph.fatal], now)
        for _ in range(round(graph.fatal_seconds / FRAME) + 2):
            pose, turned, _ = step(graph, playback, now, pose)
            worst, now = max(worst, turned), now + FRAME
        done = settled(graph, playback, now)
        missed += done.posture != graph.fatal or not np.allclose(pose[7:], graph.poses[graph.fatal, 7:])
    return missed, worst


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--graphs", type=int, default=1000)
    parser.add_argument("--moments", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    rng, graph = np.random.default_rng(given.seed), load_postures(Path(POSTURES) / "person.yaml")
    print(f"least times: {unequal(given.graphs, rng)} of {given.graphs} random graphs differ from all ways")
    joint, root = request_figures(graph, given.moments, rng)
    many = given.moments
    print(f"{many} requests: a joint moves by {joint:.1f} degrees, the root by {100 * root:.1f} cm at most")
    missed, worst = fatal_figures(graph, given.moments, rng)
    print(f"dead from {many} moments: {missed} do not end there; joints move by {worst:.1f} degrees at most")


if __name__ == "__main__":
    main()
