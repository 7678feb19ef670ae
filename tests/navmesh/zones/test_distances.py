"""Distances to outlines."""

import numpy as np

from navmesh.zones.distances import is_inside, segments_to_outline

OUTLINE = np.array([(0.0, 0.0), (3.0, 0.5), (2.5, 3.0), (1.0, 1.5), (-0.5, 2.0)])  # not convex


def spread(a: np.ndarray, b: np.ndarray, count: int) -> np.ndarray:
    return a + np.linspace(0.0, 1.0, count)[:, None] * (b - a)


def test_lines_are_as_far_as_their_nearest_places():
    """Slow: the distances of many places on the line to many on the outline."""
    rng = np.random.default_rng(0)
    segments = rng.uniform(-3.0, 6.0, (200, 4))
    sides = zip(OUTLINE, np.roll(OUTLINE, -1, axis=0), strict=True)
    rim = np.concatenate([spread(a, b, 300) for a, b in sides])
    found = segments_to_outline(OUTLINE, segments)
    for segment, far in zip(segments, found, strict=True):
        places = spread(segment[:2], segment[2:], 300)
        slow = np.linalg.norm(places[:, None] - rim[None], axis=2).min()
        if any(is_inside(OUTLINE, x, y) for x, y in places):
            assert far == 0.0
        else:
            assert abs(far - slow) < 0.02
    assert 20 < (found == 0.0).sum() < 180


def test_a_line_is_an_outline_that_nothing_is_in():
    line = np.array([(0.0, 0.0), (2.0, 0.0)])
    segments = np.array([(1.0, -1.0, 1.0, 1.0), (1.0, 0.5, 1.5, 0.5), (3.0, 0.0, 4.0, 1.0)])
    np.testing.assert_allclose(segments_to_outline(line, segments), [0.0, 0.5, 1.0])
