"""Like samples on one straight edge are one segment; what bends or changes is another."""

import numpy as np
import pytest

from navmesh.obstacles.edge_segments import Samples, join_samples

SPACE = 0.2


def samples(points, height=0.5, depth=0.0):
    """Samples in a row, each for ``SPACE`` [m] of the rim, which goes from point to point."""
    points = np.array(points, float)
    along = np.gradient(points, axis=0)
    along /= np.linalg.norm(along, axis=1)[:, None]
    count = len(points)
    return Samples(
        points, along, np.column_stack([along[:, 1], -along[:, 0]]), np.full(count, 0.5 * SPACE),
        np.broadcast_to(height, count).astype(float), np.broadcast_to(depth, count).astype(float),
    )  # fmt: skip


def row(count, x=0.0):
    return [(x + SPACE * (k + 0.5), 0.0, 1.0) for k in range(count)]


def test_a_straight_row_is_one_segment_from_end_to_end():
    (found,) = join_samples(samples(row(10)), 0.6)
    assert found.width == pytest.approx(2.0)
    assert found.members.tolist() == list(range(10))
    assert (found.start, found.end) == (pytest.approx([0, 0, 1]), pytest.approx([2, 0, 1]))
    assert found.middle == pytest.approx([1.0, 0, 1], abs=0.5 * SPACE)
    assert found.outward == pytest.approx([0.0, -1.0])


def test_what_is_narrower_than_the_body_is_left_out():
    assert join_samples(samples(row(2)), 0.6) == []


def test_a_hole_in_a_row_makes_two():
    assert [each.width for each in join_samples(samples(row(5) + row(4, x=1.4)), 0.6)] == pytest.approx(
        [1.0, 0.8]
    )


@pytest.mark.parametrize(("what", "jump"), [("height", 0.1), ("depth", 0.35)])
def test_a_jump_of_the_height_or_the_width_makes_two_and_a_slow_change_does_not(what, jump):
    """Widths are measured along the edge with the samples, and so may differ more."""
    stepped, slow = np.where(np.arange(10) < 5, 0.4, 0.4 + jump), np.linspace(0.4, 0.65, 10)
    assert len(join_samples(samples(row(10), **{what: stepped}), 0.6)) == 2
    assert len(join_samples(samples(row(10), **{what: slow}), 0.6)) == 1


def test_segments_have_nearly_one_height():
    found = join_samples(samples(row(40), height=np.linspace(0.2, 1.2, 40)), 0.6)
    assert len(found) > 3
    assert all(0.2 + np.ptp(each.members) / 39.0 <= 0.2 + 0.3 + 1e-9 for each in found)


def test_a_bend_ends_a_segment():
    corner = [(SPACE * (k + 0.5), 0.0, 1.0) for k in range(6)] + [
        (1.2, SPACE * (k + 0.5), 1.0) for k in range(6)
    ]
    assert len(join_samples(samples(corner), 0.6)) == 2
