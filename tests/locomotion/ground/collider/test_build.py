"""Triangles as the collision kernel reads them."""

import numpy as np
import pytest

from locomotion.ground.collider.build import DEPTH_CAP, build_triangle_arrays
from locomotion.ground.collider.layout import (
    CORNER,
    DEPTH_LIMIT,
    EXPOSED,
    NX,
    OFFSET,
    PER_METRE,
    SIDE,
    SIDE_ROW,
    SOUTH,
    VERTEX,
    WEST,
)
from tests.locomotion.ground.collider.shapes import box, floor, joined

CUBE = box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5), split=2)


def exposed(arrays):
    """How many edges and corners stick out."""
    bits = arrays.flags[:, EXPOSED]
    return sum(int((bits >> k & 1).sum()) for k in range(3)), sum(
        int((bits >> k & 1).sum()) for k in range(3, 6)
    )


def test_planes_and_sides_are_those_of_the_triangles():
    arrays = build_triangle_arrays(*CUBE)
    corners = arrays.rows[:, CORNER : CORNER + 9].reshape(-1, 3, 3)
    normals, offsets = arrays.rows[:, NX:OFFSET], arrays.rows[:, OFFSET]
    assert np.einsum("ij,ikj->ik", normals, corners) == pytest.approx(np.repeat(offsets[:, None], 3, 1))
    assert offsets == pytest.approx(0.5) and (np.abs(normals).max(axis=1) == 1.0).all()
    middle = corners.mean(axis=1)
    for k in range(3):
        side = arrays.rows[:, SIDE + SIDE_ROW * k : SIDE + SIDE_ROW * (k + 1)]
        for end in (k, (k + 1) % 3):
            assert np.einsum("ij,ij->i", side[:, :3], corners[:, end]) == pytest.approx(side[:, 3])
        assert (np.einsum("ij,ij->i", side[:, :3], middle) < side[:, 3]).all()  # they point outwards


def test_edges_and_corners_of_a_cube_stick_out_and_the_seams_of_its_faces_do_not():
    assert exposed(build_triangle_arrays(*CUBE)) == (12 * 2, 8)  # each edge is cut in two


def test_of_a_floor_only_the_border_sticks_out_and_of_a_valley_not_even_the_fold():
    assert exposed(build_triangle_arrays(*floor(half=1.0, split=4)))[0] == 4 * 4
    fold = np.array([[0, 0, 0], [1, 0, 0.5], [1, 1, 0.5], [0, 1, 0], [-1, 0, 0.5], [-1, 1, 0.5]])
    faces = np.array([[0, 1, 2], [0, 2, 3], [4, 0, 3], [4, 3, 5]])
    assert exposed(build_triangle_arrays(fold, faces))[0] == 6
    assert exposed(build_triangle_arrays(fold * [1, 1, -1], faces))[0] == 7  # a ridge


def test_corners_in_one_place_are_one_and_triangles_without_an_area_are_left_out():
    vertices, faces = joined(*(([[x, 0, 0], [x + 1, 0, 0], [x, 1, 0]], [[0, 1, 2]]) for x in (0.0, 1.0)))
    sliver = np.array([[3, 0, 0], [4, 0, 0], [5, 0, 0.0]])
    vertices, faces = np.vstack([vertices, sliver]), np.vstack([faces, [[6, 7, 8], [6, 6, 7]]])
    arrays = build_triangle_arrays(vertices, faces)
    assert len(arrays.rows) == 2
    assert len(set(arrays.flags[:, VERTEX : VERTEX + 3].ravel())) == 5  # (1, 0, 0) is shared


def test_the_grid_lists_every_triangle_in_the_cells_that_it_covers():
    arrays = build_triangle_arrays(*floor(half=3.0, split=5, height=lambda x, y: 0.3 * x - 0.2 * y))
    west, south, per_metre = arrays.grid[[WEST, SOUTH, PER_METRE]]
    nx, ny = arrays.shape
    rng = np.random.default_rng(0)
    for t, triangle in enumerate(arrays.rows[:, CORNER : CORNER + 9].reshape(-1, 3, 3)):
        for weights in rng.dirichlet(np.ones(3), 20):
            x, y, z = weights @ triangle
            i, j = int((x - west) * per_metre), int((y - south) * per_metre)
            assert 0 <= i < nx and 0 <= j < ny
            cell = i * ny + j
            listed = arrays.cell_triangles[arrays.cell_start[cell] : arrays.cell_start[cell + 1]]
            assert t in listed
            low, high = arrays.cell_range[cell]
            assert low <= z <= high


@pytest.mark.parametrize(("thick", "deep"), [(1.0, DEPTH_CAP), (0.08, 0.04)])
def test_bodies_are_pushed_out_to_the_nearer_side_of_a_wall(thick, deep):
    arrays = build_triangle_arrays(*box((-2.0, -0.5 * thick, -1.0), (2.0, 0.5 * thick, 1.0), split=4))
    across = np.abs(arrays.rows[:, NX + 1]) == 1.0
    assert arrays.rows[across, DEPTH_LIMIT].max() == pytest.approx(deep)
