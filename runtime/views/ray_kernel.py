"""The hot loop of `runtime.views.render`: which face of a level each ray of a picture meets first."""

import numpy as np

from surefoot.kernels import allocating_kernel

__all__ = ["cast_faces"]

_NEAR = 0.01  # [m] depth at which faces are cut before their window is measured


@allocating_kernel
def cast_faces(
    eye: np.ndarray, axes: np.ndarray, scale: float, rays: np.ndarray,
    corners: np.ndarray, nearest: np.ndarray, distance: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """Face (height, width) int32 that each ray meets first, -1 for none; its distance goes to ``distance``.

    ``eye`` (3,); ``axes`` (3, 3) forward, right, up; ``scale`` [pixels] of a width equal to its depth;
    ``rays`` (height, width, 3) unit vectors; ``corners`` (f, 3, 3); ``nearest`` (f,) [m]: hits nearer
    than this do not count; ``distance`` (height, width) [m], lowered in place. Moeller and Trumbore's
    test (1997), for the rays of the window that a face covers.
    """
    height, width = distance.shape
    found = np.full((height, width), -1, np.int32)
    for f in range(len(corners)):
        left, right, top, bottom = _window(corners[f], eye, axes, scale, width, height)
        if left >= right or top >= bottom:
            continue
        a0, a1, a2 = corners[f, 0]
        u0, u1, u2 = corners[f, 1, 0] - a0, corners[f, 1, 1] - a1, corners[f, 1, 2] - a2
        v0, v1, v2 = corners[f, 2, 0] - a0, corners[f, 2, 1] - a1, corners[f, 2, 2] - a2
        o0, o1, o2 = eye[0] - a0, eye[1] - a1, eye[2] - a2
        q0, q1, q2 = o1 * u2 - o2 * u1, o2 * u0 - o0 * u2, o0 * u1 - o1 * u0
        away = v0 * q0 + v1 * q1 + v2 * q2
        for i in range(top, bottom):
            for j in range(left, right):
                r0, r1, r2 = rays[i, j]
                p0, p1, p2 = r1 * v2 - r2 * v1, r2 * v0 - r0 * v2, r0 * v1 - r1 * v0
                det = p0 * u0 + p1 * u1 + p2 * u2
                if det == 0.0:
                    continue
                u = (p0 * o0 + p1 * o1 + p2 * o2) / det
                v = (r0 * q0 + r1 * q1 + r2 * q2) / det
                t = away / det
                inside = u >= -1e-9 and v >= -1e-9 and u + v <= 1.0 + 1e-9
                if inside and t > nearest[f] and t < distance[i, j]:
                    distance[i, j] = t
                    found[i, j] = f
    return found


@allocating_kernel
def _window(
    corners: np.ndarray, eye: np.ndarray, axes: np.ndarray, scale: float, width: int, height: int
) -> tuple[int, int, int, int]:
    """First and last column and row (exclusive) that the part of a face before the eye may cover."""
    local = np.empty((3, 3))
    for c in range(3):
        for k in range(3):
            local[c, k] = (
                (corners[c, 0] - eye[0]) * axes[k, 0]
                + (corners[c, 1] - eye[1]) * axes[k, 1]
                + (corners[c, 2] - eye[2]) * axes[k, 2]
            )
    left, right, top, bottom = np.inf, -np.inf, np.inf, -np.inf
    for c in range(3):
        d = (c + 1) % 3
        for end in range(2):
            depth, across, up = local[c]
            if end == 1:  # where the edge to the next corner comes through the near plane
                if (local[c, 0] - _NEAR) * (local[d, 0] - _NEAR) >= 0.0:
                    continue
                share = (_NEAR - local[c, 0]) / (local[d, 0] - local[c, 0])
                depth = _NEAR
                across = local[c, 1] + share * (local[d, 1] - local[c, 1])
                up = local[c, 2] + share * (local[d, 2] - local[c, 2])
            elif depth < _NEAR:
                continue
            x, y = across / depth * scale + width / 2.0, height / 2.0 - up / depth * scale
            left, right, top, bottom = min(left, x), max(right, x), min(top, y), max(bottom, y)
    if left > right:
        return 0, 0, 0, 0
    first_column, last_column = max(left - 1.0, 0.0), min(right + 2.0, float(width))
    first_row, last_row = max(top - 1.0, 0.0), min(bottom + 2.0, float(height))
    return int(first_column), int(max(last_column, 0.0)), int(first_row), int(max(last_row, 0.0))
