"""The level's triangles as ground: against analytic shapes, the slow reference, and moving bodies."""

import copy
import gc
import pickle

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray

from locomotion.body.person import build_person
from locomotion.errors import LocomotionError
from locomotion.ground.ground import Ground, extruded
from tests.locomotion.ground.collider.shapes import SPHERE, floor, scene


def test_person_stands_on_a_mesh_as_on_the_plane_and_repeats_bit_for_bit():
    ground = Ground.from_arrays(*floor(5.0, 7))
    ends = []
    for g in (ground, ground, None):
        model = build_person(g)
        if g is not None:
            g.check(model)
        data = mujoco.MjData(model)
        mujoco.mj_step(model, data, 300)
        ends.append(data.qpos.copy())
    assert ends[0].tobytes() == ends[1].tobytes()
    np.testing.assert_allclose(ends[0], ends[2], atol=2e-4)


@pytest.mark.parametrize("copied", [lambda g: pickle.loads(pickle.dumps(g)), copy.copy, copy.deepcopy])
def test_copy_of_a_ground_is_one_of_its_own(copied):
    ground = Ground.from_arrays(*floor(5.0, 7), max_slope=0.7)
    ground.friction = 0.45
    other = copied(ground)
    expected = _after_a_second(ground)
    del ground
    gc.collect()
    in_its_place = Ground.from_arrays(*floor(4.0, 5))
    assert other.friction == 0.45 and other.steep
    assert _after_a_second(other).tobytes() == expected.tobytes()
    assert len(in_its_place.faces) == 50


def _after_a_second(ground: Ground) -> NDArray:
    model = build_person(ground)
    ground.check(model)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 400)
    return data.qpos.copy()


@pytest.mark.parametrize(
    ("vertices", "faces", "message"),
    [
        (np.zeros((3, 2)), [[0, 1, 2]], "vertices have the shape"),
        (np.zeros((3, 3)), np.zeros((0, 3), int), "faces have the shape"),
        (np.eye(3), [[0, 1, 3]], "outside 0 to 2"),
        (np.eye(3), [[0.0, 1.0, 2.0]], "give integers"),
        (np.diag([1.0, np.nan, 1.0]), [[0, 1, 2]], "vertex 1"),
        (np.zeros((3, 3)), [[0, 1, 2]], "degenerate"),
    ],
)
def test_bad_meshes_are_refused(vertices, faces, message):
    with pytest.raises(LocomotionError, match=message):
        Ground.from_arrays(vertices, np.asarray(faces))


def flight(front, slope):
    """A floor, and a ramp of 0.33 with a front ``front`` [m] high that rises with ``slope`` every 1.5 m."""
    run = [(1.5, 0.33 * 1.5), (front / slope, front)] * 4
    profile = np.vstack([[-3.0, 0.0], [0.0, 0.0], np.cumsum(run, axis=0)])
    vertices = np.array([[x, y, z] for y in (-2.0, 2.0) for x, z in profile])
    n = len(profile)
    faces = [[i, i + 1, i + 1 + n] for i in range(n - 1)] + [[i, i + 1 + n, i + n] for i in range(n - 1)]
    return Ground.from_arrays(vertices, faces, max_slope=np.radians(20.0), max_step=0.2)


@pytest.mark.parametrize(
    ("front", "slope", "held"),
    [(0.1, 0.8, 0.8), (0.1, 0.4, 0.0), (0.3, 0.8, 0.0), (0.1, 2.0, 0.0), (0.02, 0.8, 0.0)],
    ids=["trodden on", "no steeper than usual", "no step", "no place for a foot", "under a sole"],
)
def test_ground_holds_feet_on_fronts_of_steps(front, slope, held):
    ground = flight(front, slope)
    assert ground.friction == pytest.approx(max(0.9, 1.4 * 2.0**0.5 * held), abs=1e-6)
    assert not ground.steep  # what is stood on is not


def test_ground_that_holds_more_is_hardly_softer():
    depths = []
    for ground in (flight(0.1, 0.4), flight(0.1, 0.9)):
        model, data = scene(ground, SPHERE, [0.05, 0, 0], [-1.5, 0.1, 0.05], density=2e4)
        for _ in range(400):
            mujoco.mj_step(model, data)
        depths.append(-data.contact.dist.min())
    assert depths[0] > 1e-4
    assert depths[1] < 1.6 * depths[0]  # 3.5 times as deep with the usual impedance


def test_ground_holds_feet_on_its_floors():
    square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]]
    for slope, steep in ((20.0, False), (40.0, True)):
        ground = Ground.from_arrays(*square, max_slope=np.radians(slope))
        assert ground.steep == steep and ground.friction >= 1.9 * np.tan(np.radians(slope)) * steep
    with pytest.raises(LocomotionError, match=r"max_slope is 2\.0 rad; give 0 to less than 1\.57"):
        Ground.from_arrays(*square, max_slope=2.0)
    with pytest.raises(LocomotionError, match="max_step is nan m"):
        Ground.from_arrays(*square, max_step=float("nan"))


def test_a_scaled_ground_is_the_same_surface():
    vertices, faces = extruded([(0.0, 0.0), (2.0, 0.4), (3.0, 0.4), (3.2, 1.1), (6.0, 1.0)], 1.5)
    ground = Ground.from_arrays(vertices, faces)
    scaled, made = ground.scaled(1.25), Ground.from_arrays(1.25 * vertices, faces)
    points = np.column_stack([np.linspace(0.1, 5.9, 40), np.linspace(-1.4, 1.4, 40), np.full(40, 2.0)])
    for ours, theirs in zip(
        scaled.surface_below(1.25 * points), made.surface_below(1.25 * points), strict=True
    ):
        np.testing.assert_allclose(ours, theirs, atol=1e-12)
    np.testing.assert_allclose(scaled.surface_below(1.25 * points)[0], 1.25 * ground.surface_below(points)[0])
    assert scaled.friction == ground.friction and scaled.digest != ground.digest
    np.testing.assert_allclose(scaled.arrays.rows[:, :25], made.arrays.rows[:, :25], atol=1e-12)
