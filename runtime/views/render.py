"""A small ray caster for pictures of a level and its figures: no GPU, no display, no driver."""

from dataclasses import dataclass

import numpy as np

from runtime.bodies.figure import Shapes, rotate
from runtime.views.ray_kernel import cast_faces

__all__ = ["Camera", "Triangles", "render"]

SUN = np.array([0.35, -0.5, 0.8]) / np.linalg.norm([0.35, -0.5, 0.8])
SKY_LOW, SKY_HIGH = np.array([0.93, 0.95, 0.97]), np.array([0.66, 0.78, 0.90])
FLAT = 0.6
"""Faces whose normal has at least this z are floor, the others wall."""
FLOOR, FLOOR_DARK, WALL = (
    np.array([0.80, 0.79, 0.76]),
    np.array([0.73, 0.72, 0.69]),
    np.array([0.70, 0.67, 0.63]),
)


@dataclass(frozen=True)
class Camera:
    """Where a picture is taken from: ``eye``, ``target`` (3,) [m], ``fov`` [rad] of the picture's height."""

    eye: np.ndarray
    target: np.ndarray
    fov: float = 0.7

    def rays(self, width: int, height: int) -> np.ndarray:
        """Unit directions (height, width, 3) float64 of the pixels' rays, top row first."""
        forward, right, up = self.axes()
        half = np.tan(self.fov / 2.0)
        y = (0.5 - (np.arange(height) + 0.5) / height) * 2.0 * half
        x = ((np.arange(width) + 0.5) / width - 0.5) * 2.0 * half * width / height
        direction = forward + x[None, :, None] * right + y[:, None, None] * up
        return direction / np.linalg.norm(direction, axis=2, keepdims=True)

    def axes(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Forward, right and up of the picture, unit vectors (3,)."""
        forward = self.target - self.eye
        forward = forward / np.linalg.norm(forward)
        right = np.cross(forward, (0.0, 0.0, 1.0))
        right /= np.linalg.norm(right)
        return forward, right, np.cross(right, forward)


class Triangles:
    """A level's faces, prepared for `render`: corners (f, 3, 3) and unit normals (f, 3) float64."""

    def __init__(self, vertices: np.ndarray, faces: np.ndarray) -> None:
        corners = vertices[faces].astype(np.float64)
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        area = np.linalg.norm(normal, axis=1)
        whole = area > 1e-12
        self.corners = corners[whole]
        self.normals = normal[whole] / area[whole, None]


def render(
    triangles: Triangles,
    figures: list[Shapes],
    camera: Camera,
    size: tuple[int, int] = (480, 360),
    reach: float = 40.0,
    cutaway: float = 0.0,
) -> np.ndarray:
    """Draw the level's front faces within ``reach`` [m] and figures; returns (height, width, 3) uint8.

    Walls and ceilings nearer to the eye than ``cutaway`` [m] are left out, so that they hide nothing.
    ``figures`` are shapes in the world.
    """
    width, height = 2 * size[0], 2 * size[1]
    rays = camera.rays(width, height)
    frame = _Frame(camera, width, height, rays)
    _draw_level(frame, triangles, reach, cutaway)
    for shapes in figures:
        for k in range(len(shapes.size)):
            _draw_shape(frame, shapes, k)
    image = _shade(frame, figures, reach)
    small = image.reshape(size[1], 2, size[0], 2, 3).mean(axis=(1, 3))
    return (np.clip(small, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


class _Frame:
    """The picture while it is drawn: distance along each ray, normal and colour of what it hit."""

    def __init__(self, camera: Camera, width: int, height: int, rays: np.ndarray) -> None:
        self.camera, self.width, self.height, self.rays = camera, width, height, rays
        self.distance = np.full((height, width), np.inf)
        self.normal = np.zeros((height, width, 3))
        self.colour = np.zeros((height, width, 3))
        self.axes = np.stack(camera.axes())
        self.scale = height / (2.0 * np.tan(camera.fov / 2.0))

    def window(self, points: np.ndarray, margin: float) -> tuple[slice, slice] | None:
        """Rows and columns that ``points`` (n, 3), widened by ``margin`` [m], may cover; None when unseen."""
        local = (points - self.camera.eye) @ self.axes.T
        depth = local[:, 0]
        if np.all(depth < -margin):
            return None
        if np.any(depth < margin + 0.05):
            return slice(0, self.height), slice(0, self.width)
        spread = margin / (depth - margin) * 1.5
        across = local[:, 1] / depth * self.scale + self.width / 2.0
        down = self.height / 2.0 - local[:, 2] / depth * self.scale
        spread = spread * self.scale + 1.0
        top, bottom = int(max(np.min(down - spread), 0)), int(min(np.max(down + spread) + 1, self.height))
        left, right = int(max(np.min(across - spread), 0)), int(min(np.max(across + spread) + 1, self.width))
        return None if top >= bottom or left >= right else (slice(top, bottom), slice(left, right))

    def put(
        self, window: tuple[slice, slice], distance: np.ndarray, normal: np.ndarray, colour: np.ndarray
    ) -> None:
        """Keep the surface at ``distance`` wherever it is nearer than what is there (inf: not hit)."""
        nearer = distance < self.distance[window]
        self.distance[window][nearer] = distance[nearer]
        self.normal[window][nearer] = normal[nearer] if normal.ndim == 3 else normal
        self.colour[window][nearer] = colour


def _draw_level(frame: _Frame, triangles: Triangles, reach: float, cutaway: float) -> None:
    eye = frame.camera.eye
    towards = np.einsum("fc,fc->f", triangles.corners[:, 0] - eye, triangles.normals)
    low, high = triangles.corners.min(axis=1), triangles.corners.max(axis=1)
    gap = np.maximum(np.maximum(low - eye, eye - high), 0.0)
    seen = np.nonzero((towards < 0.0) & (np.linalg.norm(gap, axis=1) < reach))[0]
    normals = triangles.normals[seen]
    level = normals[:, 2] > FLAT
    nearest = np.where(level, 0.02, max(0.02, cutaway))
    face = cast_faces(
        eye, frame.axes, frame.scale, frame.rays, triangles.corners[seen], nearest, frame.distance
    )
    hit = face >= 0
    frame.normal[hit] = normals[face[hit]]
    frame.colour[hit] = np.where(level[face[hit], None], FLOOR, WALL)


def _draw_shape(frame: _Frame, shapes: Shapes, k: int) -> None:
    place, size = shapes.place[k], shapes.size[k]
    window = frame.window(place[None, :3], float(np.max(size) if shapes.round[k] else size[0] + size[1]))
    if window is not None:
        distance, normal = _cast_shape(frame.camera.eye, frame.rays[window], shapes, k)
        frame.put(window, distance, normal, shapes.colour[k])


def _cast_shape(start: np.ndarray, rays: np.ndarray, shapes: Shapes, k: int) -> tuple[np.ndarray, np.ndarray]:
    """Distance along each of ``rays`` (..., 3) to shape k (inf: missed), outward normal (..., 3) there."""
    back = shapes.place[k, 3:] * np.array([1.0, -1.0, -1.0, -1.0])
    size = shapes.size[k]
    eye, direction = rotate(back, start - shapes.place[k, :3]), rotate(back, rays)
    if shapes.round[k]:
        distance = _cast_sphere(eye / size, direction / size, 1.0)
        outward = (eye + np.where(np.isfinite(distance), distance, 0.0)[..., None] * direction) / size**2
    else:
        distance = _cast_tube(eye, direction, size[0], size[1])
        outward = eye + np.where(np.isfinite(distance), distance, 0.0)[..., None] * direction
        outward[..., 2] -= np.clip(outward[..., 2], -size[1], size[1])
    outward /= np.maximum(np.linalg.norm(outward, axis=-1, keepdims=True), 1e-12)
    return distance, rotate(shapes.place[k, 3:], outward)


def _cast_sphere(eye: np.ndarray, rays: np.ndarray, radius: float) -> np.ndarray:
    """First positive distance to a sphere about the origin, in units of the rays' length."""
    a = np.sum(rays * rays, axis=-1)
    b = np.sum(rays * eye, axis=-1)
    c = np.sum(eye * eye, axis=-1) - radius**2
    with np.errstate(invalid="ignore"):
        near = (-b - np.sqrt(b * b - a * c)) / a
    return np.where(near > 0.0, near, np.inf)


def _cast_tube(eye: np.ndarray, rays: np.ndarray, radius: float, half: float) -> np.ndarray:
    """First positive distance to a capsule about the z axis, from -half to half."""
    a = rays[..., 0] ** 2 + rays[..., 1] ** 2
    b = rays[..., 0] * eye[..., 0] + rays[..., 1] * eye[..., 1]
    c = eye[..., 0] ** 2 + eye[..., 1] ** 2 - radius**2
    with np.errstate(divide="ignore", invalid="ignore"):
        side = (-b - np.sqrt(b * b - a * c)) / a
        height = eye[..., 2] + side * rays[..., 2]
        best = np.where((side > 0.0) & (np.abs(height) < half), side, np.inf)
    for end in (-half, half):
        best = np.minimum(best, _cast_sphere(eye - np.array([0.0, 0.0, end]), rays, radius))
    return best


def _shade(frame: _Frame, figures: list[Shapes], reach: float) -> np.ndarray:
    hit = np.isfinite(frame.distance)
    up = np.clip(frame.rays[..., 2:3] * 2.5, 0.0, 1.0)
    sky = SKY_LOW + up * (SKY_HIGH - SKY_LOW)
    point = frame.camera.eye + np.where(hit, frame.distance, 0.0)[..., None] * frame.rays
    tile = (np.floor(point[..., 0] + 1e-4) + np.floor(point[..., 1] + 1e-4)).astype(np.int64) & 1
    floor = np.all(frame.colour == FLOOR, axis=-1)
    colour = np.where((floor & (tile == 1))[..., None], FLOOR_DARK, frame.colour)
    lit = np.clip(frame.normal @ SUN, 0.0, 1.0) * _sunlit(point, frame.normal, hit, figures)
    light = 0.42 + 0.14 * frame.normal[..., 2] + 0.55 * lit
    haze = np.clip(frame.distance / reach, 0.0, 1.0)[..., None] ** 2
    shaded = colour * light[..., None] * (1.0 - haze) + SKY_LOW * haze
    return np.where(hit[..., None], shaded, sky)


def _sunlit(point: np.ndarray, normal: np.ndarray, hit: np.ndarray, figures: list[Shapes]) -> np.ndarray:
    """1 where the sun is seen, 0 in the shadow of a figure; (height, width) float64."""
    free = np.ones(hit.shape)
    for shapes in figures:
        middle = shapes.place[:, :3].mean(axis=0)
        size = float(np.max(np.linalg.norm(shapes.place[:, :3] - middle, axis=1) + shapes.size.sum(axis=1)))
        offset = point - middle
        to_sun = offset @ SUN
        aside = np.sum(offset * offset, axis=-1) - to_sun**2
        near = hit & (aside < size**2) & (to_sun < size)
        start = point[near] + 0.01 * normal[near]
        rays = np.broadcast_to(SUN, start.shape)
        seen = np.ones(len(start))
        for k in range(len(shapes.size)):
            distance, _ = _cast_shape(start, rays, shapes, k)
            seen[np.isfinite(distance)] = 0.0
        free[near] = np.minimum(free[near], seen)
    return free
