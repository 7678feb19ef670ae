"""The level's triangles as ground: against analytic shapes, the slow reference, and moving bodies."""

import gc

import mujoco
import numpy as np
import pytest

from locomotion.body.person import build_person
from locomotion.errors import LocomotionError
from locomotion.ground.collider.contact import MAX_CANDIDATES, capsule_contacts
from locomotion.ground.collider.reference import ReferenceMesh, reference_contacts
from locomotion.ground.ground import Ground

SPHERE, CAPSULE = mujoco.mjtGeom.mjGEOM_SPHERE, mujoco.mjtGeom.mjGEOM_CAPSULE


def box(low, high, split=1):
    """A closed box as triangles, each face split into split x split squares."""
    low, high = np.asarray(low, float), np.asarray(high, float)
    vertices, faces = [], []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, 1):
            for i in range(split):
                for j in range(split):
                    corners = []
                    for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                        p = np.empty(3)
                        p[axis] = high[axis] if side else low[axis]
                        p[u] = low[u] + (high[u] - low[u]) * a / split
                        p[v] = low[v] + (high[v] - low[v]) * b / split
                        corners.append(p)
                    base = len(vertices)
                    vertices += corners if side else corners[::-1]
                    faces += [[base, base + 1, base + 2], [base, base + 2, base + 3]]
    return np.array(vertices), np.array(faces)


def floor(half=10.0, split=8, height=None):
    """A square floor of split x split squares; height(x, y) gives z."""
    x = np.linspace(-half, half, split + 1)
    xx, yy = np.meshgrid(x, x, indexing="ij")
    zz = np.zeros_like(xx) if height is None else height(xx, yy)
    vertices = np.stack([xx, yy, zz], axis=-1).reshape(-1, 3)
    faces = []
    for i in range(split):
        for j in range(split):
            a, b = i * (split + 1) + j, (i + 1) * (split + 1) + j
            faces += [[a, b, b + 1], [a, b + 1, a + 1]] if (i + j) % 2 else [[a, b, a + 1], [b, b + 1, a + 1]]
    return vertices, np.array(faces)


def rectangle(x, y, length, width):
    """Two triangles in the plane z = 0 with corners of their own."""
    corners = [[x, y, 0], [x + length, y, 0], [x + length, y + width, 0], [x, y + width, 0.0]]
    return np.array(corners), np.array([[0, 1, 2], [0, 2, 3]])


def joined(*parts):
    vertices, faces, base = [], [], 0
    for v, f in parts:
        vertices.append(v)
        faces.append(np.asarray(f) + base)
        base += len(v)
    return np.concatenate(vertices), np.concatenate(faces)


def contacts(ground, start, end, radius, margin=0.0):
    """(n, 8) distance, position, normal, place on the axis: the kernel's answer in world coordinates."""
    a, out = ground.arrays, np.zeros((MAX_CANDIDATES, 10))
    s, e = np.asarray(start, float) - ground.origin, np.asarray(end, float) - ground.origin
    n = capsule_contacts(
        a.rows, a.flags, a.vertex_start, a.vertex_edges, a.cell_start, a.cell_triangles, a.cell_range,
        a.grid, a.shape, *s, *e, radius, margin, out,
    )  # fmt: skip
    out[:n, 1:4] += ground.origin
    return out[:n, :8]


def scene(ground, shape, size, position, velocity=(0, 0, 0), friction=None, **options):
    """One free body over a ground (None: the plane z = 0)."""
    spec = mujoco.MjSpec()
    spec.option.timestep = 0.0025
    if ground is None:
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1])
    else:
        ground.add_to(spec)
    if friction is not None:
        for geom in spec.geoms:
            geom.friction = [friction, 0, 0]
    body = spec.worldbody.add_body(pos=position)
    body.add_freejoint()
    kwargs = {} if friction is None else {"friction": [friction, 0, 0]}
    body.add_geom(type=shape, size=size, **kwargs, **options)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qvel[:3] = velocity
    return model, data


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


def test_several_grounds_and_planes_and_height_fields_in_one_process():
    low, high = Ground.from_arrays(*floor()), Ground.from_arrays(*floor(height=lambda x, y: 0 * x + 2.0))
    worlds = [scene(g, SPHERE, [0.1, 0, 0], [0, 0, 3.0]) for g in (low, high, None)]
    worlds.append(scene_with_height_field())
    for _ in range(1000):
        for model, data in worlds:
            mujoco.mj_step(model, data)
    np.testing.assert_allclose([d.qpos[2] for _, d in worlds], [0.1, 2.1, 0.1, 0.1], atol=0.003)
    low.check(worlds[0][0])
    with pytest.raises(LocomotionError, match="another ground"):
        low.check(worlds[1][0])
    with pytest.raises(LocomotionError, match="no geom called 'ground'"):
        low.check(worlds[2][0])


def scene_with_height_field():
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><option timestep='0.0025'/>"
        "<asset><hfield name='h' nrow='3' ncol='3' size='5 5 1 1'/></asset>"
        "<worldbody><geom type='hfield' hfield='h'/><body pos='0 0 3'><freejoint/><geom size='.1'/></body>"
        "</worldbody></mujoco>"
    )
    return model, mujoco.MjData(model)


def test_a_released_ground_touches_nothing_even_when_its_slot_is_used_again():
    ground = Ground.from_arrays(*floor())
    model, data = scene(ground, SPHERE, [0.1, 0, 0], [0, 0, 0.09])
    mujoco.mj_forward(model, data)
    assert data.ncon == 1
    del ground
    gc.collect()
    mujoco.mj_forward(model, data)
    assert data.ncon == 0
    again = Ground.from_arrays(*floor(height=lambda x, y: 0 * x + 1.0))
    mujoco.mj_forward(model, data)
    assert data.ncon == 0
    assert again.digest


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


def test_batch_of_two_threads_equals_single_runs():
    ground = Ground.from_arrays(*floor(5.0, 9, lambda x, y: 0.1 * np.sin(3 * x)))
    model, data = scene(ground, CAPSULE, [0.05, 0.15, 0], [0, 0, 0.4])
    starts = []
    for i in range(6):
        mujoco.mj_resetData(model, data)
        data.qvel[:] = np.sin(np.arange(6) + i)
        state = np.zeros(mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_INTEGRATION))
        mujoco.mj_getState(model, data, state, mujoco.mjtState.mjSTATE_INTEGRATION)
        starts.append(state)
    single = []
    for state in starts:
        mujoco.mj_setState(model, data, state, mujoco.mjtState.mjSTATE_INTEGRATION)
        mujoco.mj_step(model, data, 300)
        single.append(data.qpos.copy())
    from mujoco import rollout

    pair = [mujoco.MjData(model), mujoco.MjData(model)]
    full = np.zeros((6, mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS)))
    for i, state in enumerate(starts):
        mujoco.mj_setState(model, data, state, mujoco.mjtState.mjSTATE_INTEGRATION)
        mujoco.mj_getState(model, data, full[i], mujoco.mjtState.mjSTATE_FULLPHYSICS)
    states, _ = rollout.rollout(model, pair, full, nstep=300)
    np.testing.assert_array_equal(states[:, -1, 1:8], np.array(single))


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
