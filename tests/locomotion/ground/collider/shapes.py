"""Meshes and scenes for the tests of grounds."""

import mujoco
import numpy as np

from locomotion.ground.collider.contact import MAX_CANDIDATES, capsule_contacts

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
