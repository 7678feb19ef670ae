"""The hot loops of `runtime.views.render` for light: the colour of what rays have met, and which points may
lie in a figure's shadow."""

import numpy as np

from surefoot.kernels import allocating_kernel, kernel

__all__ = ["paint", "points_near", "shade"]


@kernel
def paint(
    face: np.ndarray, normals: np.ndarray, colours: np.ndarray, normal: np.ndarray, colour: np.ndarray
) -> None:
    """Give each ray the normal and the colour of the ``face`` (height, width) that it meets, of ``normals``
    and ``colours`` (f, 3); -1 for none."""
    for i in range(face.shape[0]):
        for j in range(face.shape[1]):
            if face[i, j] >= 0:
                for k in range(3):
                    normal[i, j, k] = normals[face[i, j], k]
                    colour[i, j, k] = colours[face[i, j], k]


@allocating_kernel
def points_near(
    eye: np.ndarray, rays: np.ndarray, distance: np.ndarray, normal: np.ndarray,
    sun: np.ndarray, middle: np.ndarray, size: float,
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """The rays that meet something which may lie in the shadow of a ball of radius ``size`` [m] at ``middle``
    (3,): row and column (n, 2) int64, and the points (n, 3) [m], 1 cm off the surface. ``sun`` (3,): the
    direction to it."""
    height, width = distance.shape
    where, points = np.empty((height * width, 2), np.int64), np.empty((height * width, 3))
    count = 0
    for i in range(height):
        for j in range(width):
            if not np.isfinite(distance[i, j]):
                continue
            x = eye[0] + distance[i, j] * rays[i, j, 0] - middle[0]
            y = eye[1] + distance[i, j] * rays[i, j, 1] - middle[1]
            z = eye[2] + distance[i, j] * rays[i, j, 2] - middle[2]
            to_sun = x * sun[0] + y * sun[1] + z * sun[2]
            if x * x + y * y + z * z - to_sun**2 < size**2 and to_sun < size:
                where[count, 0], where[count, 1] = i, j
                for k in range(3):
                    at = eye[k] + distance[i, j] * rays[i, j, k]
                    points[count, k] = at + 0.01 * normal[i, j, k]
                count += 1
    return where[:count].copy(), points[:count].copy()


@allocating_kernel
def shade(
    eye: np.ndarray, rays: np.ndarray, distance: np.ndarray, normal: np.ndarray, colour: np.ndarray,
    free: np.ndarray, reach: float, lights: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """The picture (height / 2, width / 2, 3) of a scene, 0 to 1: each of its points is the mean of four rays.

    ``free`` (height, width): 1 where the sun shines, 0 in shadow. ``lights`` (5, 3): direction to the sun,
    colours of the sky, low and high, of floor, and of every second square metre of floor.
    """
    height, width = distance.shape
    sun, low, high, floor, dark = lights[0], lights[1], lights[2], lights[3], lights[4]
    image = np.zeros((height // 2, width // 2, 3))
    for i in range(height):
        for j in range(width):
            pixel = image[i // 2, j // 2]
            far = distance[i, j]
            if not np.isfinite(far):
                up = min(max(rays[i, j, 2] * 2.5, 0.0), 1.0)
                for k in range(3):
                    pixel[k] += 0.25 * (low[k] + up * (high[k] - low[k]))
                continue
            x, y = eye[0] + far * rays[i, j, 0], eye[1] + far * rays[i, j, 1]
            odd = (int(np.floor(x + 1e-4)) + int(np.floor(y + 1e-4))) & 1 == 1
            for k in range(3):
                odd = odd and colour[i, j, k] == floor[k]
            facing = normal[i, j, 0] * sun[0] + normal[i, j, 1] * sun[1] + normal[i, j, 2] * sun[2]
            lit = min(max(facing, 0.0), 1.0) * free[i, j]
            light = 0.42 + 0.14 * normal[i, j, 2] + 0.55 * lit
            haze = min(far / reach, 1.0) ** 2
            for k in range(3):
                own = dark[k] if odd else colour[i, j, k]
                pixel[k] += 0.25 * (own * light * (1.0 - haze) + low[k] * haze)
    return image
