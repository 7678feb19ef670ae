"""Levels on the earth: there and back, against pymap3d, and at places where angles are not unique."""

import numpy as np
import pytest

pymap3d = pytest.importorskip("pymap3d")

from runtime.dis.geodesy import (  # noqa: E402
    FLIP,
    LevelFrame,
    angles_of,
    geodetic,
    rotations_of,
    yaw_rotations,
)
from runtime.errors import RuntimeInputError  # noqa: E402

ORIGINS = [(0.0, 0.0, 0.0), (90.0, 0.0, 10.0), (-90.0, 77.0, 0.0), (48.2, 180.0, 300.0), (-33.9, -180.0, 0.0),
           (52.5, 13.4, 34.0)]  # fmt: skip


def turned_by(first, second):
    """[rad] between rotations (n, 3, 3), exact for small ones."""
    between = np.swapaxes(first, 1, 2) @ second
    skew = np.stack([between[:, 2, 1] - between[:, 1, 2], between[:, 0, 2] - between[:, 2, 0],
                     between[:, 1, 0] - between[:, 0, 1]], axis=1)  # fmt: skip
    return np.arctan2(0.5 * np.linalg.norm(skew, axis=1), 0.5 * (np.trace(between, axis1=1, axis2=2) - 1.0))


def test_known_places():
    """Equator and pole of WGS 84, and a place computed by hand."""
    assert LevelFrame((0.0, 0.0, 0.0)).centre == pytest.approx([6378137.0, 0.0, 0.0], abs=1e-6)
    assert LevelFrame((90.0, 0.0, 0.0)).centre == pytest.approx([0.0, 0.0, 6356752.314245], abs=1e-6)
    north, up = LevelFrame((0.0, 90.0, 0.0)).axes[1:]
    assert north == pytest.approx([0.0, 0.0, 1.0]) and up == pytest.approx([0.0, 1.0, 0.0])


@pytest.mark.parametrize("origin", ORIGINS)
def test_places_agree_with_pymap3d_and_come_back(origin):
    points = np.random.default_rng(2).normal(0.0, 2000.0, (200, 3))
    frame = LevelFrame(origin)
    there = frame.to_geocentric(points)
    theirs = np.stack(pymap3d.enu2ecef(*points.T, *origin), axis=1)
    assert np.abs(there - theirs).max() < 1e-6
    assert np.abs(frame.to_level(there) - points).max() < 1e-6
    directions = frame.vectors_to_level(frame.vectors_to_geocentric(points))
    assert np.abs(directions - points).max() < 1e-9
    latitude, _, height = geodetic(frame.centre[None])[0]
    assert (latitude, height) == pytest.approx((origin[0], origin[2]), abs=1e-6)


@pytest.mark.parametrize("origin", ORIGINS)
def test_orientations_come_back(origin):
    chance = np.random.default_rng(3)
    angles = chance.uniform(-np.pi, np.pi, (300, 3))
    angles[:100, 1] = np.sign(angles[:100, 1]) * (np.pi / 2 - 10.0 ** chance.uniform(-16, -3, 100))
    rotations, frame = rotations_of(angles), LevelFrame(origin)
    assert turned_by(rotations_of(angles_of(rotations)), rotations).max() < 1e-9
    assert turned_by(frame.rotations(frame.orientations(rotations)), rotations).max() < 1e-9


def test_body_axes_are_those_of_the_standard():
    """Who faces north at the equator of the prime meridian: x to the pole, y east, z into the earth."""
    frame = LevelFrame((0.0, 0.0, 0.0))
    body = frame.axes.T @ yaw_rotations(np.array([np.pi / 2]))
    assert body[0].T == pytest.approx(np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]]), abs=1e-12)
    assert np.array_equal(FLIP @ FLIP, np.eye(3))


@pytest.mark.parametrize(
    "origin", [(91.0, 0.0, 0.0), (0.0, 500.0, 0.0), (0.0, 0.0, float("nan")), (1.0, 2.0), "x"]
)
def test_what_is_no_place_is_refused(origin):
    with pytest.raises(RuntimeInputError, match="origin"):
        LevelFrame(origin)
