"""Segments against shapely."""

import numpy as np
from shapely import LineString, box, unary_union

from navmesh.surface.segments import part_in_square, put, sort_and_thin


def _rows(segments: np.ndarray) -> tuple[np.ndarray, int]:
    rows = np.empty((len(segments), 4))
    count = 0
    for segment in segments:
        count = put(rows, count, *segment)
    return rows, count


def test_the_part_in_a_square() -> None:
    rng = np.random.default_rng(31)
    met = 0
    for ax, ay, bx, by, x, y in rng.uniform(-1.0, 1.0, (400, 6)):
        first, last = part_in_square(ax, ay, bx, by, x, y, 0.3)
        line = LineString([(ax, ay), (bx, by)])
        inside = line.intersection(box(x - 0.3, y - 0.3, x + 0.3, y + 0.3)).length
        assert abs(max(last - first, 0.0) * line.length - inside) < 1e-9
        met += inside > 0.0
    assert met > 50


def test_thinned_lists_cover_the_same_whatever_the_order() -> None:
    rng = np.random.default_rng(32)
    for _ in range(100):
        # segments on a few common lines, so that many lie on each other
        through, way = rng.uniform(-1.0, 1.0, (3, 2)), rng.normal(size=(3, 2))
        line = rng.integers(3, size=12)
        begin, end = np.round(rng.uniform(-1.0, 1.0, (2, 12, 1)), 1)
        segments = np.hstack([through[line] + begin * way[line], through[line] + end * way[line]])
        rows, count = _rows(segments)
        kept = sort_and_thin(rows, count)
        turned, _ = _rows(segments[rng.permutation(12)])
        assert sort_and_thin(turned, count) == kept
        np.testing.assert_array_equal(turned[:kept], rows[:kept])
        whole = unary_union([LineString([s[:2], s[2:]]) for s in segments])
        left = [LineString([s[:2], s[2:]]) for s in rows[:kept]]
        assert whole.difference(unary_union(left).buffer(1e-6)).length < 1e-6
        for i, one in enumerate(left):  # none lies on another
            assert not any(other.buffer(1e-8).covers(one) for k, other in enumerate(left) if k != i)
