"""The ray caster against shapes that can be computed, and the pictures made with it."""

import dataclasses

import matplotlib.image
import numpy as np
import pytest
import trimesh

from runtime.bodies.figure import Shapes, rotate
from runtime.views.camera import clearest
from runtime.views.filmstrip import write_filmstrip
from runtime.views.plot import plot_from_above
from runtime.views.ray_kernel import cast_faces
from runtime.views.render import Camera, Triangles, render
from runtime.views.shape_kernel import cast_shapes, in_shadow

FLOOR = Triangles(
    np.array([[-20.0, -20, 0], [20, -20, 0], [20, 20, 0], [-20, 20, 0]]), np.array([[0, 1, 2], [0, 2, 3]])
)
CAMERA = Camera(np.array([0.0, -5.0, 1.0]), np.array([0.0, 0.0, 1.0]), 0.8)
RED = np.array([[1.0, 0.0, 0.0]])


def shape(size, is_round, quaternion=(1.0, 0.0, 0.0, 0.0)):
    place = np.array([[0.0, 0.0, 1.0, *quaternion]])
    return Shapes(place, np.array([size], dtype=float), np.array([is_round]), RED)


def redness(image):
    return (image[..., 0].astype(int) - image[..., 1]) > 60


@pytest.mark.parametrize(
    ("shapes", "half_width", "half_height"),
    [
        (shape((0.5, 0.5, 0.5), True), 0.5, 0.5),
        (shape((0.8, 0.3, 0.4), True), 0.8, 0.4),
        (shape((0.2, 0.5, 0.0), False), 0.2, 0.7),
        (shape((0.2, 0.5, 0.0), False, (np.sqrt(0.5), 0.0, np.sqrt(0.5), 0.0)), 0.7, 0.2),
    ],
)
def test_outline_of_a_shape(shapes, half_width, half_height):
    image = render(FLOOR, [shapes], CAMERA, (200, 200))
    seen = redness(image)
    per_metre = 100 / np.tan(0.4) / 5.0
    assert np.ptp(np.nonzero(seen.any(axis=0))[0]) == pytest.approx(2 * half_width * per_metre, rel=0.06)
    assert np.ptp(np.nonzero(seen.any(axis=1))[0]) == pytest.approx(2 * half_height * per_metre, rel=0.06)


def test_floor_below_and_sky_above_the_horizon():
    image = render(FLOOR, [], CAMERA, (60, 60), reach=100.0).astype(int)
    assert (image[:25, :, 2] > image[:25, :, 0]).all()  # blue
    assert (image[40:, :, 0] > image[40:, :, 2]).all()  # warm grey


def test_a_figure_throws_a_shadow():
    above = Camera(np.array([0.0, -0.1, 8.0]), np.array([0.0, 0.0, 0.0]), 0.8)
    lit = render(FLOOR, [], above, (80, 80)).astype(int)
    shaded = render(FLOOR, [shape((0.5, 0.5, 0.5), True)], above, (80, 80)).astype(int)
    darker = (lit - shaded).min(axis=2) > 20
    assert darker.sum() > 20


def test_back_faces_and_cut_walls_hide_nothing():
    wall = Triangles(
        np.array([[-3.0, -2, 0], [3, -2, 0], [3, -2, 3], [-3, -2, 3]]), np.array([[0, 1, 2], [0, 2, 3]])
    )
    back = Triangles(wall.corners.reshape(-1, 3), np.arange(6).reshape(2, 3)[:, ::-1])
    ball = [shape((0.5, 0.5, 0.5), True)]
    assert not redness(render(wall, ball, CAMERA, (40, 40))).any()
    assert redness(render(wall, ball, CAMERA, (40, 40), cutaway=4.0)).any()
    assert redness(render(back, ball, CAMERA, (40, 40))).any()


def test_a_film_strip_in_a_narrow_room_is_taken_from_inside(trace, tmp_path, monkeypatch):
    inside = trace.agents[0].poses[:, :, :3].reshape(-1, 3)
    low, high = inside.min(axis=0) - (1.0, 0.5, 0.3), inside.max(axis=0) + np.array([1.0, 3.5, 1.5])
    room = trimesh.creation.box(bounds=[low, high])
    room.invert()
    level = dataclasses.replace(trace.level, vertices=np.asarray(room.vertices), faces=np.asarray(room.faces))
    eyes = []

    def spy(level, figures, camera, size, **_):
        eyes.append(camera.eye)
        return np.zeros((size[1], size[0], 3), np.uint8)

    monkeypatch.setattr("runtime.views.filmstrip.render", spy)
    write_filmstrip(dataclasses.replace(trace, level=level), tmp_path / "film.png")
    assert len(eyes) == 8 and (np.array(eyes) > low).all() and (np.array(eyes) < high).all()


def test_a_camera_goes_round_what_stands_before_it_and_stays_where_nothing_does():
    points = np.array([[0.0, 0.0, 0.4], [0.5, 0.0, 0.4], [-0.5, 0.0, 1.0]])
    camera = Camera(np.array([0.0, -4.0, 1.5]), np.array([0.0, 0.0, 0.6]))
    unmoved, clear = clearest(FLOOR, camera, points)
    assert clear and unmoved.eye == pytest.approx(camera.eye)
    for flip in (1, -1):  # whichever way the wall's faces look
        wall = np.array([[-1.5, -2, 0], [1.5, -2, 0], [1.5, -2, 5], [-1.5, -2, 5]])
        moved, clear = clearest(Triangles(wall, np.array([[0, 1, 2], [0, 2, 3]])[:, ::flip]), camera, points)
        assert clear
        for point in points:  # where the line of sight comes through y = -2
            eye = moved.eye
            share = (-2.0 - eye[1]) / (point[1] - eye[1])
            x, _, z = eye + share * (point - eye)
            assert not (0.0 < share < 1.0 and abs(x) < 1.5 and 0.0 < z < 5.0)
    shut = trimesh.creation.box(extents=[2.0, 1.0, 3.0])
    assert not clearest(Triangles(shut.vertices, shut.faces), camera, points)[1]


def test_film_strip_and_plot_are_pictures(trace, tmp_path):
    write_filmstrip(trace, tmp_path / "film.png")
    plot_from_above(trace, tmp_path / "level.png")
    for name in ("film.png", "level.png"):
        image = matplotlib.image.imread(tmp_path / name)
        assert image.shape[0] > 300 and image.shape[1] > 600
        colours = (image[..., :3] * 255.0).round().astype(int) @ [65536, 256, 1]
        assert len(np.unique(colours)) > 100
    assert sorted(each.name for each in tmp_path.iterdir()) == ["film.png", "level.png"]


def first_faces(eye, rays, corners, nearest):
    """`cast_faces` without windows: every ray against every face."""
    distance, face = np.full(rays.shape[:2], np.inf), np.full(rays.shape[:2], -1)
    for f, (a, b, c) in enumerate(corners):
        u, v = b - a, c - a
        with np.errstate(divide="ignore", invalid="ignore"):
            det = np.cross(rays, v) @ u
            first = np.cross(rays, v) @ (eye - a) / det
            second = rays @ np.cross(eye - a, u) / det
            t = v @ np.cross(eye - a, u) / det
            hit = (first >= -1e-9) & (second >= -1e-9) & (first + second <= 1.0 + 1e-9) & (t > nearest[f])
        hit &= t < distance
        distance[hit], face[hit] = t[hit], f
    return distance, face


@pytest.mark.parametrize("seed", range(6))
def test_rays_meet_the_same_faces_as_without_windows(seed):
    random = np.random.default_rng(seed)
    corners = random.normal(size=(60, 1, 3)) * 3.0 + random.normal(size=(60, 3, 3)) * random.choice(
        [0.3, 5.0]
    )
    nearest = random.choice([0.02, 2.0], 60)
    camera = Camera(random.normal(size=3), random.normal(size=3), 0.9)
    rays, axes = camera.rays(90, 60), np.stack(camera.axes())
    distance = np.full((60, 90), np.inf)
    face = cast_faces(camera.eye, axes, 30.0 / np.tan(0.45), rays, corners, nearest, distance)
    expected, expected_face = first_faces(camera.eye, rays, corners, nearest)
    assert (face >= 0).mean() > 0.01
    np.testing.assert_array_equal(face, expected_face)
    np.testing.assert_allclose(distance, expected, rtol=1e-9)


def first_hit(start, rays, shapes, k):
    """Distance along each of ``rays`` (..., 3) to shape k (inf: missed), outward normal (..., 3) there."""
    back = shapes.place[k, 3:] * np.array([1.0, -1.0, -1.0, -1.0])
    size = shapes.size[k]
    eye, direction = rotate(back, start - shapes.place[k, :3]), rotate(back, rays)
    with np.errstate(divide="ignore", invalid="ignore"):
        if shapes.round[k]:
            distance = to_sphere(eye / size, direction / size, 1.0)
            outward = (eye + distance[..., None] * direction) / size**2
        else:
            a, b = (
                np.sum(direction[..., :2] ** 2, axis=-1),
                np.sum(direction[..., :2] * eye[..., :2], axis=-1),
            )
            side = (-b - np.sqrt(b * b - a * (np.sum(eye[..., :2] ** 2, axis=-1) - size[0] ** 2))) / a
            height = eye[..., 2] + side * direction[..., 2]
            distance = np.where((side > 0.0) & (np.abs(height) < size[1]), side, np.inf)
            for end in (-size[1], size[1]):
                distance = np.minimum(distance, to_sphere(eye - [0.0, 0.0, end], direction, size[0]))
            outward = eye + distance[..., None] * direction
            outward[..., 2] -= np.clip(outward[..., 2], -size[1], size[1])
        outward /= np.linalg.norm(outward, axis=-1, keepdims=True)
        return distance, rotate(shapes.place[k, 3:], outward)


def to_sphere(eye, rays, radius):
    """First positive distance to a sphere about the origin, in units of the rays' length."""
    a, b = np.sum(rays * rays, axis=-1), np.sum(rays * eye, axis=-1)
    near = (-b - np.sqrt(b * b - a * (np.sum(eye * eye, axis=-1) - radius**2))) / a
    return np.where(near > 0.0, near, np.inf)


@pytest.mark.parametrize("seed", range(6))
def test_rays_meet_the_same_shapes_and_shadows_as_by_the_formulas(seed):
    random = np.random.default_rng(seed)
    quaternions = random.normal(size=(12, 4))
    quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
    place = np.hstack([random.normal(size=(12, 3)), quaternions])
    shapes = Shapes(place, random.uniform(0.05, 0.6, (12, 3)), random.random(12) < 0.5, np.ones((12, 3)))
    camera = Camera(random.normal(size=3) * random.choice([1.0, 4.0]), random.normal(size=3) * 0.3, 0.9)
    rays = camera.rays(90, 60)
    distance, normal = np.full((60, 90), 5.0), np.zeros((60, 90, 3))
    everywhere = np.tile([0, 60, 0, 90], (12, 1))
    found = cast_shapes(
        camera.eye, rays, everywhere, shapes.place, shapes.size, shapes.round, distance, normal
    )
    hits = [first_hit(camera.eye, rays, shapes, k) for k in range(12)]
    distances = np.stack([np.full((60, 90), 5.0), *(each[0] for each in hits)])
    expected = np.argmin(distances, axis=0) - 1
    seen = expected >= 0
    assert seen.mean() > 0.01
    np.testing.assert_array_equal(found, expected)
    np.testing.assert_allclose(distance, distances.min(axis=0), rtol=1e-9)
    rows, columns = np.nonzero(seen)
    np.testing.assert_allclose(
        normal[seen], np.stack([each[1] for each in hits])[expected[seen], rows, columns], atol=1e-7
    )

    points, sun = random.normal(size=(4000, 3)) * 2.0, random.normal(size=3)
    sun /= np.linalg.norm(sun)
    towards = np.broadcast_to(sun, points.shape)
    between = np.any([np.isfinite(first_hit(points, towards, shapes, k)[0]) for k in range(12)], axis=0)
    assert 0.05 < between.mean() < 0.95
    np.testing.assert_array_equal(in_shadow(points, sun, shapes.place, shapes.size, shapes.round), between)
