"""Strips of triangles as triangles."""

import numpy as np
import pytest

from navmesh.meshfiles.strips import strip_faces


@pytest.mark.parametrize(
    ("corners", "lengths", "faces"),
    [
        ([0, 1, 2], [3], [(0, 1, 2)]),
        ([0, 1, 2, 3], [4], [(0, 1, 2), (1, 3, 2)]),
        ([0, 1, 2, 3, 4], [5], [(0, 1, 2), (1, 3, 2), (2, 3, 4)]),
        ([0, 1, 2, 3, -1, 5, 6, 7], [8], [(0, 1, 2), (1, 3, 2), (5, 6, 7)]),
        ([0, 1, 2, 5, 6, 7], [3, 3], [(0, 1, 2), (5, 6, 7)]),
        ([0, 1, -1, 4, 5, 6], [6], [(4, 5, 6)]),
        ([0, 1], [2], []),
        ([], [], []),
    ],
)
def test_triangles_of_strips(corners, lengths, faces):
    found = strip_faces(np.array(corners, np.int64), np.array(lengths, np.int64))
    assert found.shape == (len(faces), 3) and found.tolist() == [list(face) for face in faces]


def test_all_of_a_flat_strip_face_the_same_way():
    points = np.array([(k // 2, k % 2) for k in range(9)], float)
    faces = strip_faces(np.arange(9), np.array([9]))
    a, b, c = np.moveaxis(points[faces], 1, 0)
    turned = np.sign((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    assert len(faces) == 7 and (turned == turned[0]).all()
