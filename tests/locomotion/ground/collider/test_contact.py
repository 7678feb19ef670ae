"""Contacts with triangles: against analytic shapes, the slow reference, and moving bodies."""

import mujoco
import numpy as np
import pytest

from locomotion.ground.collider.reference import ReferenceMesh, reference_contacts
from locomotion.ground.ground import Ground
from tests.locomotion.ground.collider.shapes import (
    CAPSULE,
    SPHERE,
    box,
    contacts,
    floor,
    joined,
    rectangle,
    scene,
)


def test_sphere_at_a_box_is_the_analytic_distance():
    vertices, faces = box([-0.5, -0.4, -0.3], [0.5, 0.4, 0.3], split=2)
    ground = Ground.from_arrays(vertices, faces)
    rng = np.random.default_rng(1)
    seen = 0
    for _ in range(3000):
        q = rng.uniform(-1, 1, 3)
        nearest = np.clip(q, [-0.5, -0.4, -0.3], [0.5, 0.4, 0.3])
        distance = np.linalg.norm(q - nearest)
        if distance == 0:
            continue
        found = contacts(ground, q, q, 0.2)
        assert len(found) == (distance < 0.2)
        if len(found):
            seen += 1
            assert found[0, 0] == pytest.approx(distance - 0.2, abs=1e-12)
            np.testing.assert_allclose(found[0, 4:7], (q - nearest) / distance, atol=1e-9)
            np.testing.assert_allclose(found[0, 1:4], 0.5 * (nearest + q - 0.2 * found[0, 4:7]), atol=1e-9)
    assert seen > 300


def test_capsule_at_a_box_has_the_least_distance():
    low, high = np.array([-0.5, -0.4, -0.3]), np.array([0.5, 0.4, 0.3])
    ground = Ground.from_arrays(*box(low, high, split=3))
    rng = np.random.default_rng(2)
    steps = np.linspace(0, 1, 2001)[:, None]
    for _ in range(400):
        start, end = rng.uniform(-1, 1, 3), rng.uniform(-1, 1, 3)
        end = start + 0.4 * (end - start) / np.linalg.norm(end - start)
        axis = start + steps * (end - start)
        distance = np.linalg.norm(axis - np.clip(axis, low, high), axis=1)
        if distance.min() == 0:
            continue
        found = contacts(ground, start, end, 0.1)
        assert (len(found) > 0) == (distance.min() < 0.1) or abs(distance.min() - 0.1) < 1e-4
        if len(found):
            assert found[:, 0].min() == pytest.approx(distance.min() - 0.1, abs=1e-4)


def wedge(angle, height=1.0, length=1.0):
    """An upright prism whose edge along z at (0, 0) is as sharp as ``angle`` [rad]; x leads into it."""
    y = length * np.tan(0.5 * angle)
    foot = np.array([[0, 0, 0], [length, -y, 0], [length, y, 0]])
    sides = [[a, b, b + 3, a + 3] for a, b in ((0, 1), (1, 2), (2, 0))]
    faces = [[0, 2, 1], [3, 4, 5], *(f for a, b, c, d in sides for f in ([a, b, c], [a, c, d]))]
    return np.concatenate([foot, foot + np.array([0, 0, height])]), np.array(faces)


def test_nothing_is_pushed_through_a_sharp_wedge():
    """A centre beside a wedge is also behind its other side, by little where it is sharp."""
    ground = Ground.from_arrays(*wedge(0.4))
    rng = np.random.default_rng(5)
    seen = 0
    for _ in range(2000):
        x, out = rng.uniform(0.02, 0.4), rng.uniform(0.001, 0.08)
        side = rng.choice([-1.0, 1.0])
        along = np.array([np.cos(0.2), side * np.sin(0.2), 0.0])
        normal = np.array([-np.sin(0.2), side * np.cos(0.2), 0.0])
        q = x * along + out * normal + [0, 0, rng.uniform(0.2, 0.8)]
        found = contacts(ground, q, q, 0.04)
        assert len(found) == (out < 0.04)
        if len(found):
            seen += 1
            assert found[0, 0] == pytest.approx(out - 0.04, abs=1e-9)
            np.testing.assert_allclose(found[0, 4:7], normal, atol=1e-9)
    assert seen > 500


@pytest.mark.parametrize("shape", ["hills", "stairs", "soup", "wedges"])
def test_kernel_equals_the_slow_reference(shape):
    rng = np.random.default_rng(3)
    if shape == "hills":
        vertices, faces = floor(2.0, 6, lambda x, y: 0.3 * np.sin(2 * x) * np.cos(1.5 * y))
    elif shape == "stairs":
        parts = [box([0.4 * i, -1, -0.5], [0.4 * i + 0.4, 1, 0.17 * i]) for i in range(4)]
        vertices, faces = joined(floor(2.0, 3, lambda x, y: 0 * x - 0.2), *parts)
    elif shape == "wedges":
        vertices, faces = joined(wedge(0.4, 0.3, 0.4), wedge(0.8, 0.2, 0.5))
    else:
        vertices = rng.uniform(-1, 1, (60, 3)) * [2, 2, 0.5]
        faces = rng.permutation(60).reshape(20, 3)
    ground = Ground.from_arrays(vertices, faces)
    local = vertices - ground.origin
    limits = ground.arrays.rows[:, 25]
    assert len(limits) == len(faces)
    mesh, touching = ReferenceMesh(local, faces, limits), 0
    for i in range(250):
        start = rng.uniform(local.min(axis=0) - 0.1, local.max(axis=0) + 0.2)
        end = start if i % 3 == 0 else start + rng.normal(0, 0.15, 3)
        radius = rng.uniform(0.02, 0.25)
        expected = reference_contacts(mesh, start, end, radius)
        found = contacts(ground, start + ground.origin, end + ground.origin, radius)
        found = found[np.argsort(found[:, 0], kind="stable")]
        assert len(found) == len(expected), (i, found, expected)
        touching += len(found) > 0
        np.testing.assert_allclose(found[:, 0], [c.distance for c in expected], atol=1e-9)
        if len(found) and len(np.unique(np.round(found[:, 0], 9))) == len(found):
            np.testing.assert_allclose(found[:, 4:7], [c.normal for c in expected], atol=1e-7)
            np.testing.assert_allclose(
                found[:, 1:4] - ground.origin, [c.position for c in expected], atol=1e-7
            )
    assert touching > 40


def test_capsule_on_a_flat_mesh_moves_as_on_the_plane():
    ground = Ground.from_arrays(*floor())
    runs = []
    for g in (ground, None):
        model, data = scene(g, CAPSULE, [0.05, 0.2, 0], [0, 0, 0.6], velocity=(1.0, 0.4, 0))
        data.qpos[3:7] = [0.8, 0.3, 0.5, 0.1]
        mujoco.mj_normalizeQuat(model, data.qpos)
        for _ in range(800):
            mujoco.mj_step(model, data)
        runs.append((data.qpos.copy(), data.ncon))
    np.testing.assert_allclose(runs[0][0], runs[1][0], atol=1e-5)
    assert runs[0][1] == runs[1][1] == 2


@pytest.mark.parametrize("kind", ["grid", "unwelded squares", "T-junctions"])
def test_nothing_catches_on_seams(kind):
    if kind == "grid":
        vertices, faces = floor(6.0, 40)
    elif kind == "unwelded squares":
        parts = [
            rectangle(x, y, 0.5, 0.5)
            for x in np.arange(-4, 5, 0.5) for y in np.arange(-2, 2, 0.5)
        ]  # fmt: skip
        vertices, faces = joined(*parts)
    else:
        parts = [
            rectangle(x, y, 0.5, 0.7)
            for i, x in enumerate(np.arange(-4, 5, 0.5)) for y in np.arange(-2, 2, 0.7) + 0.23 * (i % 3)
        ]  # fmt: skip
        vertices, faces = joined(*parts)
    ground = Ground.from_arrays(vertices, faces)
    for shape, size, quat in (
        (SPHERE, [0.05, 0, 0], [1, 0, 0, 0]),
        (CAPSULE, [0.03, 0.1, 0], [0.7071, 0, 0.7071, 0]),
    ):
        (model, data), (flat, reference) = (
            scene(g, shape, size, [-3, 0.11, size[0] - 0.0005], (4.0, 0.3, 0), friction=0.0)
            for g in (ground, None)
        )
        data.qpos[3:7] = reference.qpos[3:7] = quat
        for _ in range(500):
            mujoco.mj_step(model, data)
            mujoco.mj_step(flat, reference)
            np.testing.assert_allclose(data.qvel, reference.qvel, atol=1e-6)
        assert data.qpos[0] == pytest.approx(2.0, abs=0.01)


def test_convex_edges_hold_and_one_sided_walls_let_out():
    ground = Ground.from_arrays(*box([-1, -1, -1], [1, 1, 0]))
    # half of a capsule hangs over the edge of the box; it still rests at the height of the top
    model, data = scene(ground, CAPSULE, [0.03, 0.2, 0], [0.9, 0, 0.031])
    data.qpos[3:7] = [0.7071, 0, 0.7071, 0]
    for _ in range(400):
        mujoco.mj_step(model, data)
    assert data.qpos[2] == pytest.approx(0.03, abs=0.003)
    # a thin one-sided sheet does not touch what is under it
    sheet = Ground.from_arrays(*floor(2.0, 2))
    assert len(contacts(sheet, [0, 0, -0.2], [0, 0, -0.2], 0.15)) == 0
    assert len(contacts(sheet, [0, 0, 0.1], [0, 0, 0.1], 0.15)) == 1


def test_an_axis_that_came_through_an_edge_is_pushed_back_out_of_it():
    """A foot set down fast on the nose of a step: its middle is below the edge, its ends are outside."""
    ground = Ground.from_arrays(*box([-1, -1, -1], [1, 1, 0]))
    out = np.array([1.0, 0.0, 1.0]) / np.sqrt(2.0)
    across = np.array([1.0, 0.0, -1.0]) / np.sqrt(2.0)
    for depth in (-0.01, -0.001, 0.001, 0.01, 0.05):
        middle = np.array([1.0, 0.2, 0.0]) - depth * out
        found = contacts(ground, middle - 0.2 * across, middle + 0.2 * across, 0.02)
        assert len(found) == 1
        assert found[0, 0] == pytest.approx(-depth - 0.02, abs=1e-12)
        np.testing.assert_allclose(found[0, 4:7], out, atol=1e-12)
        np.testing.assert_allclose(found[0, 1:4], middle + 0.5 * (depth - 0.02) * out, atol=1e-12)
    # one end inside leaves through its face, though the edge is near
    found = contacts(ground, [0.97, 0.2, 0.1], [0.965, 0.2, -0.01], 0.02)
    assert len(found) == 1
    np.testing.assert_allclose(found[0, 4:7], [0, 0, 1], atol=1e-12)
    # beyond half the thickness of a sheet it leaves through the other edge
    thin = Ground.from_arrays(*box([-1, -1, -0.03], [1, 1, 0]))
    found = contacts(thin, [1.1, 0, 0.06], [0.9, 0, -0.1], 0.01)
    assert len(found) == 1 and found[0, 6] < 0.0


def test_nothing_comes_through_an_edge_at_the_speed_of_a_foot():
    ground = Ground.from_arrays(*box([-1, -1, -1], [1, 1, 0], split=3))
    for speed in (2.0, 4.0, 6.0):
        for x in (0.97, 1.0, 1.03):
            model, data = scene(ground, CAPSULE, [0.024, 0.075, 0], [x, 0.1, 0.1], (0.0, 0.0, -speed))
            data.qpos[3:7] = [0.7071, 0, 0.7071, 0]
            mujoco.mj_step(model, data, 80)
            assert data.qpos[2] > 0.0 or data.qpos[0] > 1.0 + 0.075


def test_thin_wall_has_no_phantom_contacts_from_its_other_side():
    ground = Ground.from_arrays(*box([-0.02, -1, 0], [0.02, 1, 2], split=4))
    found = contacts(ground, [0.05, 0.3, 1.1], [0.05, 0.3, 1.1], 0.06)
    assert len(found) == 1
    np.testing.assert_allclose(found[0, 4:7], [1, 0, 0], atol=1e-12)
    assert ground.arrays.rows[:, 25].min() == pytest.approx(0.02)


def test_storeys_above_each_other():
    vertices, faces = joined(
        floor(3.0, 3), floor(3.0, 5, lambda x, y: 0 * x + 3.0), box([-3, -3, 5.9], [3, 3, 6.0])
    )
    ground = Ground.from_arrays(vertices, faces)
    for height, z in ((0.5, 0.0), (3.5, 3.0), (7.0, 6.0)):
        model, data = scene(ground, SPHERE, [0.1, 0, 0], [0.4, 0.3, height])
        for _ in range(800):
            mujoco.mj_step(model, data)
        assert data.qpos[2] == pytest.approx(z + 0.1, abs=0.004)
    z, normal = ground.surface_below([[0.1, 0.1, 2.0], [0.1, 0.1, 4.0], [0.1, 0.1, 8.0], [9, 0, 1]])
    np.testing.assert_allclose(z[:3], [0, 3, 6])
    np.testing.assert_allclose(normal[:3], [[0, 0, 1]] * 3, atol=1e-12)
    assert np.isnan(z[3])


def test_far_from_the_origin_is_as_exact():
    shift = np.array([5000.0, -5000.0, 100.0])
    vertices, faces = floor(3.0, 6, lambda x, y: 0.2 * np.sin(x))
    near, far = Ground.from_arrays(vertices, faces), Ground.from_arrays(vertices + shift, faces)
    a = contacts(near, [0.3, 0.2, 0.1], [0.5, 0.2, 0.15], 0.1)
    b = contacts(far, shift + np.array([0.3, 0.2, 0.1]), shift + np.array([0.5, 0.2, 0.15]), 0.1)
    assert len(a) == len(b) > 0
    np.testing.assert_allclose(a[:, 0], b[:, 0], atol=1e-9)


def test_outside_the_level_and_not_finite_is_no_contact():
    ground = Ground.from_arrays(*floor(2.0, 2))
    for q in (
        [50, 0, 0],
        [0, -50, 0],
        [0, 0, 40],
        [1e300, 0, 0],
        [np.nan, 0, 0],
        [0, np.inf, 0],
        [0, 0, np.nan],
    ):
        assert len(contacts(ground, q, q, 0.1)) == 0
