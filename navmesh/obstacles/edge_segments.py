"""From samples along rims to usable segments: runs of like samples on one straight edge."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

__all__ = ["EdgeSegment", "Samples", "join_samples"]

_TURN = np.cos(np.radians(20.0))  # neighbouring edges that turn by more are not one obstacle
_BOW = 0.02  # [m] farthest that a sample of a segment is beside the straight line through it
_SLACK = 0.02  # [m] gap between neighbouring samples of one segment
_HEIGHT = 0.05  # [m] greatest change of height (or width of a gap) from a sample to the next
_SPREAD = 0.3  # [m] greatest difference of heights (or widths of a gap) within a segment


@dataclass(frozen=True, slots=True, eq=False)
class Samples:
    """m samples of one affordance."""

    point: np.ndarray
    """(m, 3) float64 [m], on the rim."""
    along: np.ndarray
    """(m, 3) float64: unit vector along the rim, the fall to its right."""
    outward: np.ndarray
    """(m, 2) float64: horizontal unit vector over the fall."""
    half: np.ndarray
    """(m,) float64 [m]: half of the length of the rim for which the sample stands."""
    height: np.ndarray
    """(m,) float64 [m]."""
    depth: np.ndarray
    """(m,) float64 [m]: what may not jump from sample to sample (thickness or width of a gap, else 0)."""


@dataclass(frozen=True, slots=True)
class EdgeSegment:
    """A straight usable piece of a rim."""

    members: np.ndarray
    """(j,) int64: its samples, in order along the rim."""
    start: np.ndarray
    """(3,) float64 [m]: where it begins, on the rim."""
    end: np.ndarray
    """(3,) float64 [m]: where it ends."""
    middle: np.ndarray
    """(3,) float64 [m]: the point of the rim half-way."""
    outward: np.ndarray
    """(2,) float64: of the rim at `middle`."""
    width: float
    """[m]."""


def join_samples(samples: Samples, least_width: float) -> list[EdgeSegment]:
    """The segments of at least ``least_width`` [m] that ``samples`` make up."""
    if not len(samples.half):
        return []
    label = _connected(samples)
    order = np.argsort(label, kind="stable")
    groups = np.split(order, np.flatnonzero(np.diff(label[order])) + 1)
    return [
        segment
        for group in groups
        if 2.0 * samples.half[group].sum() >= least_width - 1e-6
        for run in _straight_runs(samples, group)
        if (segment := _segment(samples, run)).width >= least_width - 1e-6
    ]


def _connected(samples: Samples) -> np.ndarray:
    """(m,) component of each sample: neighbours touch, face the same way and are alike in size."""
    count = len(samples.half)
    tree = KDTree(samples.point)
    pairs = tree.query_pairs(2.0 * float(samples.half.max()) + _SLACK, output_type="ndarray")
    a, b = pairs[:, 0], pairs[:, 1]
    apart = samples.point[b] - samples.point[a]
    joined = np.linalg.norm(apart, axis=1) <= samples.half[a] + samples.half[b] + _SLACK
    joined &= (samples.outward[a] * samples.outward[b]).sum(axis=1) >= _TURN
    joined &= np.abs((apart[:, :2] * samples.outward[a]).sum(axis=1)) <= _BOW + 0.2 * samples.half[a]
    joined &= np.abs(samples.height[a] - samples.height[b]) <= _HEIGHT
    joined &= np.abs(samples.depth[a] - samples.depth[b]) <= 2.0 * _HEIGHT + samples.half[a] + samples.half[b]
    a, b = a[joined], b[joined]
    graph = coo_matrix((np.ones(len(a), np.int8), (a, b)), shape=(count, count))
    return connected_components(graph, directed=False)[1]


def _straight_runs(samples: Samples, group: np.ndarray) -> Iterator[np.ndarray]:
    """Cut a component where it bows or where heights drift; yields members in order along the rim."""
    mean = samples.outward[group].sum(axis=0)
    mean /= np.linalg.norm(mean)
    along = samples.point[group, :2] @ np.array([-mean[1], mean[0]])
    pending = [group[np.argsort(along, kind="stable")]]
    while pending:
        run = pending.pop()
        points = samples.point[run, :2]
        chord = points[-1] - points[0]
        length = np.linalg.norm(chord)
        if len(run) > 2 and length > 0:
            beside = np.abs((points - points[0]) @ np.array([chord[1], -chord[0]])) / length
            worst = int(np.argmax(beside))
            if beside[worst] > _BOW:
                cut = min(max(worst, 1), len(run) - 1)
                pending += [run[cut:], run[:cut]]
                continue
        if max(np.ptp(samples.height[run]), np.ptp(samples.depth[run])) > _SPREAD:
            cut = len(run) // 2
            pending += [run[cut:], run[:cut]]
            continue
        yield run


def _segment(samples: Samples, run: np.ndarray) -> EdgeSegment:
    first, last = run[0], run[-1]
    # members run against `along` (the fall is to the right of along, and to the left of the mean order)
    if (samples.point[last] - samples.point[first]) @ samples.along[first] < 0:
        run = run[::-1]
        first, last = last, first
    start = samples.point[first] - samples.half[first] * samples.along[first]
    end = samples.point[last] + samples.half[last] * samples.along[last]
    middle = 0.5 * (start + end)
    nearest = run[int(np.argmin(np.linalg.norm(samples.point[run] - middle, axis=1)))]
    along = samples.along[nearest]
    shift = float((middle - samples.point[nearest]) @ along)
    shift = min(max(shift, -samples.half[nearest]), float(samples.half[nearest]))
    width = float(np.linalg.norm((end - start)[:2]))
    return EdgeSegment(
        run, start, end, samples.point[nearest] + shift * along, samples.outward[nearest], width
    )
