"""The plane geometry of string pulling."""

import itertools
import math

import numpy as np
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from navmesh.routes.funnel import tangents

ANGLES = st.floats(0.0, 2.0 * math.pi)


def distance(q: np.ndarray, a: np.ndarray, b: np.ndarray) -> tuple[float, float]:
    """From q to the segment a-b, and to the whole line through it."""
    along = (b - a) / np.linalg.norm(b - a)
    t = np.clip((q - a) @ along, 0.0, np.linalg.norm(b - a))
    across = q - a
    return float(np.linalg.norm(a + t * along - q)), abs(float(across[0] * along[1] - across[1] * along[0]))


@settings(max_examples=200, deadline=None, derandomize=True)
@given(ANGLES, st.floats(-0.95, 0.95), st.floats(0.4, 20.0), st.floats(0.4, 20.0))
def test_a_line_is_led_round_a_place_along_its_tangents(angle, off, before, after) -> None:
    radius, q = 0.6, np.array([3.0, -2.0])
    along = np.array([math.cos(angle), math.sin(angle)])
    near = q + off * radius * np.array([-along[1], along[0]])
    a, b = near - before * along, near + after * along
    arc = np.empty((2, 2))
    assume(abs(off) > 1e-6)
    parts = tangents(*a, *near, *b, *q, radius, arc)
    if min(np.linalg.norm(a - q), np.linalg.norm(b - q)) <= radius:
        assert parts == 0
        return
    assume(parts > 0)  # none where it would turn right back
    line = [a, *arc[:parts], b]
    for first, second in itertools.pairwise(line):
        segment, whole = distance(q, first, second)
        assert segment > radius - 1e-9  # clear of the circle
        assert abs(whole - radius) < 1e-9  # and touching it
    middle = arc[:parts].mean(axis=0) - q
    assert middle @ (near - q) > 0.0  # on the side that the line passed on
    assert np.linalg.norm(arc[:parts] - q, axis=1).max() < 1.2 * radius
