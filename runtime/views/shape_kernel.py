"""The hot loops of `runtime.views.render` for figures: which ellipsoid or capsule a ray meets first, and what
is in their shadow."""

import numpy as np

from surefoot.kernels import allocating_kernel, kernel

__all__ = ["cast_shapes", "in_shadow"]


@allocating_kernel(error_model="numpy")
def cast_shapes(
    eye: np.ndarray, rays: np.ndarray, windows: np.ndarray,
    place: np.ndarray, size: np.ndarray, is_round: np.ndarray,
    distance: np.ndarray, normal: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """Shape (height, width) int32 that each ray meets before ``distance``, -1 for none.

    ``eye`` (3,); ``rays`` (height, width, 3) unit vectors; ``windows`` (m, 4) int64: first and last row,
    first and last column that each shape may cover, the last ones exclusive; ``place``, ``size``,
    ``is_round`` as in `runtime.bodies.figure.Shapes`. ``distance`` (height, width) [m] and the outward
    ``normal`` (height, width, 3) are overwritten where a shape is hit.
    """
    height, width = distance.shape
    found = np.full((height, width), -1, np.int32)
    turned = np.empty((3, 3))
    for k in range(len(size)):
        _axes(place[k, 3:], turned)
        o = _into(turned, eye[0] - place[k, 0], eye[1] - place[k, 1], eye[2] - place[k, 2])
        for i in range(windows[k, 0], windows[k, 1]):
            for j in range(windows[k, 2], windows[k, 3]):
                d = _into(turned, rays[i, j, 0], rays[i, j, 1], rays[i, j, 2])
                t = _first_hit(o, d, size[k], is_round[k])
                if t >= distance[i, j]:
                    continue
                distance[i, j] = t
                found[i, j] = k
                x, y, z = o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]
                if is_round[k]:
                    x, y, z = x / size[k, 0] ** 2, y / size[k, 1] ** 2, z / size[k, 2] ** 2
                else:
                    z -= min(max(z, -size[k, 1]), size[k, 1])
                length = max(np.sqrt(x * x + y * y + z * z), 1e-12)
                for c in range(3):
                    normal[i, j, c] = (turned[c, 0] * x + turned[c, 1] * y + turned[c, 2] * z) / length
    return found


@allocating_kernel(error_model="numpy")
def in_shadow(
    points: np.ndarray, sun: np.ndarray, place: np.ndarray, size: np.ndarray, is_round: np.ndarray
) -> np.ndarray:
    """Whether a shape is between each of ``points`` (n, 3) [m] and the sun in direction ``sun`` (3,).

    Returns (n,) bool. ``place``, ``size``, ``is_round`` as in `runtime.bodies.figure.Shapes`."""
    shaded = np.zeros(len(points), np.bool_)
    turned = np.empty((3, 3))
    for k in range(len(size)):
        _axes(place[k, 3:], turned)
        d = _into(turned, sun[0], sun[1], sun[2])
        around = 1.01 * (max(size[k, 0], size[k, 1], size[k, 2]) if is_round[k] else size[k, 0] + size[k, 1])
        for i in range(len(points)):
            if shaded[i]:
                continue
            x, y, z = points[i, 0] - place[k, 0], points[i, 1] - place[k, 1], points[i, 2] - place[k, 2]
            along = x * sun[0] + y * sun[1] + z * sun[2]
            if x * x + y * y + z * z - along * along < around**2:  # most rays pass far from most shapes
                shaded[i] = _first_hit(_into(turned, x, y, z), d, size[k], is_round[k]) < np.inf
    return shaded


@kernel
def _axes(q: np.ndarray, out: np.ndarray) -> None:
    """The rotation matrix of a unit quaternion, w first."""
    w, x, y, z = q[0], q[1], q[2], q[3]
    out[0, 0], out[0, 1], out[0, 2] = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
    out[1, 0], out[1, 1], out[1, 2] = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)
    out[2, 0], out[2, 1], out[2, 2] = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)


@kernel
def _into(axes: np.ndarray, x: float, y: float, z: float) -> tuple[float, float, float]:
    """A vector of the world in the frame of a shape."""
    return (
        axes[0, 0] * x + axes[1, 0] * y + axes[2, 0] * z,
        axes[0, 1] * x + axes[1, 1] * y + axes[2, 1] * z,
        axes[0, 2] * x + axes[1, 2] * y + axes[2, 2] * z,
    )


@kernel(error_model="numpy")
def _first_hit(
    o: tuple[float, float, float], d: tuple[float, float, float], size: np.ndarray, is_round: bool
) -> float:
    """Distance at which a ray from ``o`` along ``d``, in the frame of a shape, comes into it; infinite where
    it never does, or begins inside."""
    if is_round:
        a, b, c = size
        return _sphere(o[0] / a, o[1] / b, o[2] / c, d[0] / a, d[1] / b, d[2] / c, 1.0)
    radius, half = size[0], size[1]
    a, b = d[0] * d[0] + d[1] * d[1], d[0] * o[0] + d[1] * o[1]
    t = (-b - np.sqrt(b * b - a * (o[0] * o[0] + o[1] * o[1] - radius**2))) / a
    best = t if t > 0.0 and abs(o[2] + t * d[2]) < half else np.inf
    for end in (-half, half):
        best = min(best, _sphere(o[0], o[1], o[2] - end, d[0], d[1], d[2], radius))
    return best


@kernel(error_model="numpy")
def _sphere(ox: float, oy: float, oz: float, dx: float, dy: float, dz: float, radius: float) -> float:
    """First positive distance from o along d to a sphere about the origin, in units of d's length."""
    a, b = dx * dx + dy * dy + dz * dz, dx * ox + dy * oy + dz * oz
    t = (-b - np.sqrt(b * b - a * (ox * ox + oy * oy + oz * oz - radius**2))) / a
    return t if t > 0.0 else np.inf
