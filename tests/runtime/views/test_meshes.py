"""Shapes as triangle meshes, and libraries that may be missing."""

import math

import numpy as np
import pytest
import trimesh

from runtime.bodies.figure import Shapes
from runtime.errors import RuntimeInputError
from runtime.views.meshes import optional, shape_mesh, smooth_normals


def shape(size, round_):
    return Shapes(np.array([[9.0, 9, 9, 1, 0, 0, 0]]), np.array([size]), np.array([round_]), np.ones((1, 3)))


def test_a_capsule_is_as_long_and_wide_as_it_is_in_its_own_frame():
    mesh = shape_mesh(shape([0.1, 0.3, 0.0], False), 0)
    assert mesh.bounds == pytest.approx(np.array([[-0.1, -0.1, -0.4], [0.1, 0.1, 0.4]]), abs=1e-9)
    volume = math.pi * 0.1**2 * (0.6 + 4.0 / 3.0 * 0.1)
    assert mesh.is_watertight and 0.9 * volume < mesh.volume < volume


def test_an_ellipsoid_has_its_three_half_axes():
    mesh = shape_mesh(shape([0.1, 0.2, 0.3], True), 0)
    assert mesh.bounds == pytest.approx(np.array([[-0.1, -0.2, -0.3], [0.1, 0.2, 0.3]]), abs=0.01)
    volume = 4.0 / 3.0 * math.pi * 0.1 * 0.2 * 0.3
    assert mesh.is_watertight and 0.93 * volume < mesh.volume < volume


def test_a_missing_library_is_named_with_how_to_install_it():
    assert optional("math", "meshes", "this") is math
    with pytest.raises(
        RuntimeInputError, match=r"^a film needs no_such_library: .* pip install -e '\.\[video\]'$"
    ):
        optional("no_such_library", "video", "a film")


def test_normals_are_smooth_over_a_seam():
    ball = trimesh.creation.icosphere(subdivisions=2)
    points, faces = ball.vertices[ball.faces].reshape(-1, 3), np.arange(3 * len(ball.faces)).reshape(-1, 3)
    np.testing.assert_allclose(smooth_normals(points, faces), points, atol=0.05)
    np.testing.assert_allclose(smooth_normals(np.zeros((3, 3)), np.array([[0, 1, 2]]))[0], [0.0, 0.0, 1.0])
