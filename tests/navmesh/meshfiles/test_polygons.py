"""Polygons as triangles: what they cover is what the polygon covers."""

import numpy as np
import pytest

from navmesh.meshfiles.polygons import CrossingPolygon, triangulate


def crosses(points, faces):
    a, b, c = (points[faces[:, k]] for k in range(3))
    return np.cross(b - a, c - a)


def cut(outline, turn=0):
    """The triangles of an outline (n, 2 or 3) that begins at another corner."""
    points = np.zeros((len(outline), 3))
    points[:, : len(outline[0])] = outline
    return points, triangulate(points, np.roll(np.arange(len(points)), turn), np.array([len(points)]))


def simple_outline(rng, count):
    """A random outline that does not cross itself, counter-clockwise: crossings are undone one by one."""
    points = rng.random((count, 2))
    order = list(range(count))

    def left(p, q, r):
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    def crossing():
        for i in range(count - 1):
            for j in range(i + 2, count - (i == 0)):
                a, b, c, d = (points[order[k % count]] for k in (i, i + 1, j, j + 1))
                if left(a, b, c) * left(a, b, d) < 0 and left(c, d, a) * left(c, d, b) < 0:
                    return i + 1, j + 1
        return None

    while (found := crossing()) is not None:
        i, j = found
        order[i:j] = order[i:j][::-1]
    x, y = points[order].T
    outline = points[order]
    return outline if np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) > 0.0 else outline[::-1]


@pytest.mark.parametrize("seed", range(60))
def test_random_outlines_are_covered_once(seed):
    rng = np.random.default_rng(seed)
    outline = simple_outline(rng, int(rng.integers(4, 20)))
    turned = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    points = (np.c_[outline, np.zeros(len(outline))] @ turned.T) * 10.0 ** rng.uniform(-2, 3)
    points += rng.normal(size=3) * 100.0
    faces = triangulate(points, np.roll(np.arange(len(points)), seed), np.array([len(points)]))
    around = points - points[0]
    whole = np.cross(around, np.roll(around, -1, axis=0)).sum(axis=0)
    found = crosses(points, faces)
    np.testing.assert_allclose(found.sum(axis=0), whole, rtol=1e-6, atol=1e-9 * np.abs(whole).max())
    assert np.linalg.norm(found, axis=1).sum() == pytest.approx(np.linalg.norm(whole), rel=1e-6)


L_SHAPE = [(4, 0), (4, 1), (1, 1), (1, 4), (0, 4), (0, 0)]
U_SHAPE = [(0, 0), (6, 0), (6, 6), (5, 6), (5, 1), (1, 1), (1, 6), (0, 6)]
DART = [(0, 0), (4, 2), (0, 4), (1, 2)]
WITH_HOLE = [(0, 0), (6, 0), (6, 6), (0, 6), (0, 0), (2, 2), (2, 4), (4, 4), (4, 2), (2, 2)]


@pytest.mark.parametrize("turn", range(4))
@pytest.mark.parametrize(("outline", "area"), [(L_SHAPE, 7), (U_SHAPE, 16), (DART, 6), (WITH_HOLE, 32)])
def test_concave_outlines_from_any_corner(outline, area, turn):
    found = crosses(*cut(outline, turn))[:, 2] / 2.0
    assert found.sum() == pytest.approx(area) and (found >= 0.0).all()


def test_order_and_sense_of_rotation_are_kept():
    points = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (4, 2, 0), (0, 4, 0)], dtype=float)
    corners = np.array([3, 2, 1, 0, 0, 1, 2, 1, 0, 5, 0, 1])
    faces = triangulate(points, corners, np.array([4, 3, 2, 3]))
    assert faces.tolist() == [[3, 2, 1], [3, 1, 0], [0, 1, 2], [5, 0, 1]]


@pytest.mark.parametrize(
    "outline",
    [
        [(0, 0), (1, 0), (2, 0), (3, 0)],
        [(0, 0), (4, 0), (4, 4), (4, 0)],
        [(0, 0), (4, 0), (4, 4), (4, 0), (2, 7), (4, 0)],
        [(1, 1)] * 5,
    ],
)
def test_outlines_that_enclose_nothing_have_no_triangles(outline):
    assert len(cut(outline)[1]) == 0


@pytest.mark.parametrize(
    "outline",
    [
        [(0, 0), (4, 4), (4, 0), (0, 4)],
        [(0, 0), (4, 4), (4, 0), (0, 3)],
        [(np.cos(0.8 * np.pi * k), np.sin(0.8 * np.pi * k)) for k in range(5)],
    ],
)
def test_planar_outlines_that_cross_themselves_are_refused(outline):
    with pytest.raises(CrossingPolygon) as caught:
        cut(outline)
    assert caught.value.index == 0


def test_a_bent_quad_is_one_of_the_surfaces_that_it_spans():
    points, faces = cut([(0, 0, 0), (4, 4, 0), (4, 0, 2), (0, 4, 2)])
    assert len(faces) == 2 and set(faces.ravel().tolist()) == {0, 1, 2, 3}
    assert np.linalg.norm(crosses(points, faces), axis=1).min() > 0.0


def test_an_outline_of_ten_thousand_corners():
    count = 10_000
    x = np.arange(count)
    comb = np.c_[x, np.where(x % 2, 5.0, 1.0) + np.random.default_rng(3).random(count)]
    outline = np.r_[comb, [[count, 0.0], [-1.0, 0.0]]][::-1]
    x, y = outline.T
    area = np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2.0
    assert crosses(*cut(outline))[:, 2].sum() / 2.0 == pytest.approx(area)
