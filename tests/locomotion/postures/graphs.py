"""Posture graphs for tests: the package's own, and random ones."""

import numpy as np

from locomotion.body.person import JOINT_NAMES
from locomotion.postures.places import inverse
from locomotion.postures.posture_graph import PostureGraph

__all__ = ["random_graph"]


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
