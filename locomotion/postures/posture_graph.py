"""Posture graphs: static postures as nodes, recorded motions between them as arcs.

Granieri, Crabtree and Badler (1995), "Production and playback of human figure motion for visual simulation",
section 3: a request for a posture plays the arcs of the path that takes the least time. An arc may be its
opposite played backwards; from anywhere there is an arc to one posture, such as "dead", that is made when it
is needed (`locomotion.postures.playback`).

Arcs are stored where the figure stands when they begin: root at x = y = 0, facing +x. An arc that is played
backwards has no frames of its own.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

from locomotion.postures.held_objects import Capsule
from locomotion.postures.places import placed
from locomotion.postures.step_order import Gait

__all__ = ["PostureGraph", "blended", "frame_at", "least_times"]


@dataclass(frozen=True, eq=False)
class PostureGraph:
    """p postures and a arcs between them.

    Attributes:
        name: for display. postures: their names. fatal: the posture that there is an arc to from anywhere,
            or -1. fatal_seconds: how long it takes [s].
        poses: (p, 46) float64, ``qpos`` of the person (`locomotion.body.person`), root at x = y = 0.
        start, end: (a,) int32, postures of each arc. seconds: (a,) float64, > 0, how long it takes.
        moves: (a, 3) float64: where the arc takes the figure: x, y [m], turn [rad].
        backwards: (a,) bool: whether it is played from its last frame to its first. frames: (f, 46) float64.
        first, count: (a,) int32: the frames of each arc, evenly spaced over its seconds.
        objects: of each thing to hold the states, but for "stowed" (`locomotion.postures.held_objects`).
        shapes: what each of them looks like.
        gaits: how figures move (`locomotion.postures.step_order`).
    """

    name: str
    postures: tuple[str, ...]
    fatal: int
    fatal_seconds: float
    poses: np.ndarray
    start: np.ndarray
    end: np.ndarray
    seconds: np.ndarray
    moves: np.ndarray
    backwards: np.ndarray
    frames: np.ndarray
    first: np.ndarray
    count: np.ndarray
    objects: dict[str, tuple[str, ...]] = field(default_factory=dict)
    shapes: dict[str, tuple[Capsule, ...]] = field(default_factory=dict)
    gaits: tuple[Gait, ...] = ()
    least: np.ndarray = field(init=False)
    """(p, p) float64 [s]: the least time from each posture to each other; inf where there is no path."""
    next_arc: np.ndarray = field(init=False)
    """(p, p) int32: the first arc of that path, -1 where there is none."""
    opposite: np.ndarray = field(init=False)
    """(a,) int32: the arc that is this one played backwards, or -1."""

    def __post_init__(self) -> None:
        least, next_arc = least_times(len(self.postures), self.start, self.end, self.seconds)
        shared = (self.first[:, None] == self.first) & (self.backwards[:, None] != self.backwards)
        opposite = np.where(shared.any(axis=1), shared.argmax(axis=1), -1).astype(np.int32)
        for name, value in (("least", least), ("next_arc", next_arc), ("opposite", opposite)):
            object.__setattr__(self, name, value)


def least_times(
    postures: int, start: np.ndarray, end: np.ndarray, seconds: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The least time (p, p) [s] between postures and the first arc (p, p) int32 on the way; of arcs that are
    equally quick, the first in the file."""
    next_arc = np.full((postures, postures), -1, np.int32)
    if not len(start):
        return np.where(np.eye(postures, dtype=bool), 0.0, np.inf), next_arc
    # of parallel arcs only the quickest counts; a sparse matrix would add them up
    order = np.lexsort((np.arange(len(start)), seconds, end, start))
    pair = start[order].astype(np.int64) * postures + end[order]
    quickest = order[np.concatenate(([True], pair[1:] != pair[:-1]))]
    arcs = coo_matrix((seconds[quickest], (start[quickest], end[quickest])), (postures, postures)).tocsr()
    least = np.asarray(dijkstra(arcs))
    for here in range(postures):
        leaving = np.sort(quickest[start[quickest] == here])
        for there in range(postures):
            if here == there or not np.isfinite(least[here, there]):
                continue
            total = seconds[leaving] + least[end[leaving], there]
            next_arc[here, there] = leaving[int(np.argmin(total))]
    return least, next_arc


def frame_at(graph: PostureGraph, arc: int, elapsed: float) -> np.ndarray:
    """The pose (46,) of ``arc`` when it has been played for ``elapsed`` seconds, where it began: between two
    frames joints and places change evenly, and the root turns evenly."""
    share = min(max(elapsed / graph.seconds[arc], 0.0), 1.0)
    if graph.backwards[arc]:
        share = 1.0 - share
    at = share * (graph.count[arc] - 1)
    low = min(int(at), int(graph.count[arc]) - 2)
    before, after = graph.frames[graph.first[arc] + low], graph.frames[graph.first[arc] + low + 1]
    pose = blended(before, after, at - low)
    if graph.backwards[arc]:  # its frames stand where the opposite begins, which is where this one ends
        return placed(pose, graph.moves[arc])
    return pose


def blended(before: np.ndarray, after: np.ndarray, share: float) -> np.ndarray:
    """Between two poses (46,)."""
    pose = (1.0 - share) * before + share * after
    a, b = before[3:7], after[3:7]
    if a @ b < 0.0:
        b = -b
    turn = (1.0 - share) * a + share * b
    pose[3:7] = turn / np.linalg.norm(turn)
    return pose
