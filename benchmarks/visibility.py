"""An exact planner around boxes on a plane, independent of the graph: the shortest path of a round body.

The body may not come nearer to a box than its radius, so its shortest path follows straight lines and arcs
about the boxes' corners. Polygons around the arcs replace them (`_PARTS` sides for a whole circle, at most
0.2 % longer), their corners are joined wherever they see each other, and Dijkstra's algorithm does the rest.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import dijkstra

from navmesh import Terrain

__all__ = ["Boxes", "boxes_level", "gaps_to_boxes", "random_boxes", "shortest_ways"]

_PARTS = 48
_TOUCH = 1e-9  # [m] by which a line may be too close: tangents are
_SIGNS = np.array([(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)])


@dataclass(frozen=True, slots=True, eq=False)
class Boxes:
    """Upright boxes that stand on a level floor; they may touch and overlap, and be thin."""

    floor: tuple[float, float]
    """[m]: the floor reaches from (0, 0) to here."""
    centre: np.ndarray
    """(m, 2) float64 [m]."""
    half: np.ndarray
    """(m, 2) float64 [m]: half of the length and of the width."""
    angle: np.ndarray
    """(m,) float64 [rad]: of the length, from the x axis."""

    def local(self, points: np.ndarray) -> np.ndarray:
        """``points`` (k, 2) in the frame of each box: (m, k, 2)."""
        c, s = np.cos(self.angle)[:, None], np.sin(self.angle)[:, None]
        off = points[None] - self.centre[:, None]
        return np.stack([c * off[..., 0] + s * off[..., 1], c * off[..., 1] - s * off[..., 0]], axis=-1)

    def corners(self) -> np.ndarray:
        """(m, 4, 2) float64 [m], counter-clockwise."""
        c, s = np.cos(self.angle)[:, None], np.sin(self.angle)[:, None]
        x, y = np.moveaxis(_SIGNS[None] * self.half[:, None], -1, 0)
        return np.stack([c * x - s * y, s * x + c * y], axis=-1) + self.centre[:, None]


def random_boxes(
    rng: np.random.Generator, count: int, floor: tuple[float, float] = (16.0, 12.0), thin: float = 0.3
) -> Boxes:
    """``count`` boxes of 0.3 to 5 m, at any angle; a share ``thin`` of them are walls of 2 cm."""
    centre = rng.uniform((0.0, 0.0), floor, (count, 2))
    half = rng.uniform(0.15, 2.5, (count, 2))
    half[rng.random(count) < thin, 1] = 0.01
    return Boxes(floor, centre, half, rng.uniform(0.0, np.pi, count))


def boxes_level(boxes: Boxes, height: float = 3.0) -> Terrain:
    """The mesh of ``boxes``: a floor, and closed boxes that go through it."""
    x, y = boxes.floor
    vertices = [np.array([(0, 0, 0), (x, 0, 0), (x, y, 0), (0, y, 0)], float)]
    faces = [np.array([(0, 1, 2), (0, 2, 3)])]
    sides = np.array(
        [(0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), (0, 1, 5), (0, 5, 4), (1, 2, 6), (1, 6, 5),
         (2, 3, 7), (2, 7, 6), (3, 0, 4), (3, 4, 7)]
    )  # fmt: skip
    for k, corner in enumerate(boxes.corners()):
        low, high = np.full((4, 1), -0.2), np.full((4, 1), height)
        vertices.append(np.concatenate([np.hstack([corner, low]), np.hstack([corner, high])]))
        faces.append(sides + 4 + 8 * k)
    return Terrain.from_arrays(np.concatenate(vertices), np.concatenate(faces))


def gaps_to_boxes(boxes: Boxes, points: np.ndarray) -> np.ndarray:
    """Distance (k,) [m] from ``points`` (k, 2) to where walking ends, below 0 off the floor; 0 in a box."""
    x, y = boxes.floor
    rim = np.minimum(points, np.array([x, y]) - points).min(axis=1)
    if len(boxes.angle) == 0:
        return rim
    off = np.maximum(np.abs(boxes.local(points)) - boxes.half[:, None], 0.0)
    return np.minimum(rim, np.hypot(off[..., 0], off[..., 1]).min(axis=0))


def _meets_box(a: np.ndarray, b: np.ndarray, half: np.ndarray) -> np.ndarray:
    """Whether the lines a-b (k, 2) pass through the inside of the upright box of ``half`` sides about 0."""
    low, high = np.zeros(len(a)), np.ones(len(a))
    for axis in range(2):
        d = b[:, axis] - a[:, axis]
        with np.errstate(divide="ignore", invalid="ignore"):
            one, two = (-half[axis] - a[:, axis]) / d, (half[axis] - a[:, axis]) / d
        level = np.abs(d) < 1e-15
        inside = np.abs(a[:, axis]) < half[axis]
        low = np.where(level, np.where(inside, low, 2.0), np.maximum(low, np.minimum(one, two)))
        high = np.where(level, high, np.minimum(high, np.maximum(one, two)))
    return low < high - 1e-12


def _sees(boxes: Boxes, a: np.ndarray, b: np.ndarray, radius: float) -> np.ndarray:
    """Whether a body of ``radius`` passes straight from a to b (k, 2) each."""
    free = np.ones(len(a), bool)
    tight = radius - _TOUCH
    for k in range(len(boxes.angle)):
        p, q = boxes.local(a)[k], boxes.local(b)[k]
        half = boxes.half[k]
        longer, wider = half + np.array([tight, 0.0]), half + np.array([0.0, tight])
        hit = _meets_box(p, q, longer) | _meets_box(p, q, wider)
        d = q - p
        length = np.maximum((d * d).sum(axis=1), 1e-18)
        for sign in _SIGNS:
            t = np.clip(((sign * half - p) * d).sum(axis=1) / length, 0.0, 1.0)
            hit |= np.hypot(*(p + t[:, None] * d - sign * half).T) < tight
        free &= ~hit
    return free


def shortest_ways(boxes: Boxes, starts: np.ndarray, goals: np.ndarray, radius: float) -> np.ndarray:
    """Length (q,) [m] of the shortest way of a body of ``radius`` [m] from ``starts`` to ``goals`` (q, 2)
    each; inf where there is none."""
    turns = 2.0 * np.pi * np.arange(_PARTS) / _PARTS
    ring = radius / np.cos(np.pi / _PARTS) * np.column_stack([np.cos(turns), np.sin(turns)])
    nodes = (boxes.corners().reshape(-1, 1, 2) + ring).reshape(-1, 2)
    nodes = nodes[gaps_to_boxes(boxes, nodes) >= radius - _TOUCH]
    count = len(nodes)
    every = np.concatenate([nodes, starts, goals])
    one, two = np.triu_indices(len(every), 1)
    ends = len(starts)
    # among the ends only a start and its goal are joined
    wanted = (one < count) | (two - one == ends)
    one, two = one[wanted], two[wanted]
    seen = _sees(boxes, every[one], every[two], radius)
    one, two = one[seen], two[seen]
    weights = np.zeros((len(every), len(every)))
    weights[one, two] = np.maximum(np.hypot(*(every[one] - every[two]).T), 1e-12)
    least = dijkstra(weights, directed=False, indices=np.arange(count, count + ends))
    return least[np.arange(ends), count + ends + np.arange(ends)]
