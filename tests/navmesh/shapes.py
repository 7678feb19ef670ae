"""Small levels for tests, as vertices (v, 3) and faces (f, 3), Z up."""

import numpy as np

from navmesh import Terrain

__all__ = ["box", "join", "plane", "quad", "terrain"]

Mesh = tuple[np.ndarray, np.ndarray]


def quad(a, b, c, d) -> Mesh:
    """Two triangles; counter-clockwise corners seen from the side that can be walked on."""
    return np.array([a, b, c, d], dtype=float), np.array([[0, 1, 2], [0, 2, 3]])


def plane(x0: float, x1: float, y0: float, y1: float, z: float = 0.0) -> Mesh:
    """A level rectangle."""
    return quad((x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z))


def box(x0: float, x1: float, y0: float, y1: float, z0: float, z1: float) -> Mesh:
    """A closed box, normals outwards."""
    corner = np.array([(x, y, z) for x in (x0, x1) for y in (y0, y1) for z in (z0, z1)], dtype=float)
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [f for a, b, c, d in sides for f in ((a, b, c), (a, c, d))]
    return corner, np.array(faces)


def join(*meshes: Mesh) -> Mesh:
    """One mesh of several, without welding."""
    offset, vertices, faces = 0, [], []
    for v, f in meshes:
        vertices.append(v)
        faces.append(f + offset)
        offset += len(v)
    return np.concatenate(vertices), np.concatenate(faces)


def terrain(*meshes: Mesh) -> Terrain:
    """A terrain of several meshes."""
    return Terrain.from_arrays(*join(*meshes))
