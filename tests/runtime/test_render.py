"""The ray caster against shapes that can be computed, and the pictures made with it."""

import matplotlib.image
import numpy as np
import pytest

from runtime.figure import Shapes, rotate, turn
from runtime.filmstrip import write_filmstrip
from runtime.plot import plot_from_above
from runtime.render import Camera, Triangles, render

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


def test_quaternions_compose():
    rng = np.random.default_rng(0)
    p, q = (v / np.linalg.norm(v) for v in rng.normal(size=(2, 4)))
    vector = rng.normal(size=3)
    assert rotate(turn(p, q), vector) == pytest.approx(rotate(p, rotate(q, vector)))


def test_film_strip_and_plot_are_pictures(trace, tmp_path):
    write_filmstrip(trace, tmp_path / "film.png")
    plot_from_above(trace, tmp_path / "level.png")
    for name in ("film.png", "level.png"):
        image = matplotlib.image.imread(tmp_path / name)
        assert image.shape[0] > 300 and image.shape[1] > 600
        assert np.unique(image.reshape(-1, image.shape[2]), axis=0).shape[0] > 100
    assert sorted(each.name for each in tmp_path.iterdir()) == ["film.png", "level.png"]
