"""A small ray caster for pictures of a level and its figures: no GPU, display or driver needed."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from runtime.bodies.figure import Shapes
from runtime.views.ray_kernel import cast_faces
from runtime.views.shading_kernel import paint, points_near, shade
from runtime.views.shape_kernel import cast_shapes, in_shadow

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
_LIGHTS = np.array([SUN, SKY_LOW, SKY_HIGH, FLOOR, FLOOR_DARK])


@dataclass(frozen=True)
class Camera:
    """A camera: ``eye``, ``target`` (3,) [m], ``fov`` [rad] over the picture's height."""

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
    """Faces, prepared for `render`: corners (f, 3, 3) and unit normals (f, 3) float64. ``colours``: (f, 3),
    0 to 1; None: a level's, by slope."""

    def __init__(self, vertices: np.ndarray, faces: np.ndarray, colours: np.ndarray | None = None) -> None:
        corners = vertices[faces].astype(np.float64)
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        area = np.linalg.norm(normal, axis=1)
        whole = area > 1e-12
        self.corners = corners[whole]
        self.normals = normal[whole] / area[whole, None]
        self.colours = None if colours is None else colours[whole]
        self.low, self.high = self.corners.min(axis=1), self.corners.max(axis=1)
        """(f, 3) float64: the least and the greatest coordinates of each."""


def render(
    triangles: Triangles,
    figures: list[Shapes],
    camera: Camera,
    size: tuple[int, int] = (480, 360),
    reach: float = 40.0,
    cutaway: float = 0.0,
    skins: Sequence[Triangles] = (),
    shadows: Sequence[Shapes] = (),
) -> np.ndarray:
    """Draw the level's front faces within ``reach`` [m], figures, and ``skins`` of characters; returns
    (height, width, 3) uint8.

    Walls and ceilings nearer to the eye than ``cutaway`` [m] are left out, so that they hide nothing.
    ``figures`` are shapes in the world; ``shadows`` are more of them that are not seen, but cast a shadow.
    """
    width, height = 2 * size[0], 2 * size[1]
    rays = camera.rays(width, height)
    frame = _Frame(camera, width, height, rays)
    _draw_faces(frame, triangles, reach, cutaway)
    for shapes in figures:
        _draw_shapes(frame, shapes)
    for skin in skins:
        _draw_faces(frame, skin, reach, 0.0)
    small = shade(
        camera.eye, rays, frame.distance, frame.normal, frame.colour,
        _sunlit(frame, [*figures, *shadows]), reach, _LIGHTS,
    )  # fmt: skip
    return (np.clip(small, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


class _Frame:
    """Picture in progress: distance along each ray, and normal and colour of the surface hit."""

    def __init__(self, camera: Camera, width: int, height: int, rays: np.ndarray) -> None:
        self.camera, self.width, self.height, self.rays = camera, width, height, rays
        self.distance = np.full((height, width), np.inf)
        self.normal = np.zeros((height, width, 3))
        self.colour = np.zeros((height, width, 3))
        self.axes = np.stack(camera.axes())
        self.scale = height / (2.0 * np.tan(camera.fov / 2.0))

    def window(self, middle: np.ndarray, radius: float) -> tuple[int, int, int, int]:
        """First and last row, first and last column (last ones exclusive) that a ball may cover; all 0 if it
        is behind the camera."""
        depth, across, up = self.axes @ (middle - self.camera.eye)
        if depth < -radius:
            return 0, 0, 0, 0
        if depth < radius + 0.05:
            return 0, self.height, 0, self.width
        spread = radius / (depth - radius) * 1.5 * self.scale + 1.0
        across = across / depth * self.scale + self.width / 2.0
        down = self.height / 2.0 - up / depth * self.scale
        return (
            int(max(down - spread, 0)), int(min(down + spread + 1, self.height)),
            int(max(across - spread, 0)), int(min(across + spread + 1, self.width)),
        )  # fmt: skip


def _draw_faces(frame: _Frame, triangles: Triangles, reach: float, cutaway: float) -> None:
    eye = frame.camera.eye
    towards = np.einsum("fc,fc->f", triangles.corners[:, 0] - eye, triangles.normals)
    gap = np.maximum(np.maximum(triangles.low - eye, eye - triangles.high), 0.0)
    seen = np.nonzero((towards < 0.0) & (np.linalg.norm(gap, axis=1) < reach))[0]
    normals = triangles.normals[seen]
    level = normals[:, 2] > FLAT
    nearest = np.where(level, 0.02, max(0.02, cutaway))
    face = cast_faces(
        eye, frame.axes, frame.scale, frame.rays, triangles.corners[seen], nearest, frame.distance
    )
    by_slope = np.where(level[:, None], FLOOR, WALL)
    colours = by_slope if triangles.colours is None else triangles.colours[seen]
    paint(face, normals, colours, frame.normal, frame.colour)


def _draw_shapes(frame: _Frame, shapes: Shapes) -> None:
    reach = np.where(shapes.round, shapes.size.max(axis=1), shapes.size[:, 0] + shapes.size[:, 1])
    windows = [frame.window(at, float(r)) for at, r in zip(shapes.place[:, :3], reach, strict=True)]
    hit = cast_shapes(
        frame.camera.eye, frame.rays, np.array(windows, np.int64).reshape(-1, 4),
        shapes.place, shapes.size, shapes.round, frame.distance, frame.normal,
    )  # fmt: skip
    frame.colour[hit >= 0] = shapes.colour[hit[hit >= 0]]


def _sunlit(frame: _Frame, figures: Sequence[Shapes]) -> np.ndarray:
    """1 in sunlight, 0 in the shadow of a figure; (height, width) float64."""
    free = np.ones((frame.height, frame.width))
    for shapes in figures:
        middle = shapes.place[:, :3].mean(axis=0)
        size = float(np.max(np.linalg.norm(shapes.place[:, :3] - middle, axis=1) + shapes.size.sum(axis=1)))
        where, points = points_near(
            frame.camera.eye, frame.rays, frame.distance, frame.normal, SUN, middle, size
        )
        shaded = where[in_shadow(points, SUN, shapes.place, shapes.size, shapes.round)]
        free[shaded[:, 0], shaded[:, 1]] = 0.0
    return free
