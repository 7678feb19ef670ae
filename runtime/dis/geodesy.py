"""Between a level's frame and the geocentric one of DIS.

A level is taken to lie in the tangent plane of the WGS 84 ellipsoid at its origin: X east, Y north, Z up.
Body axes of DIS are x ahead, y right, z down; ours are X ahead, Y left, Z up.
"""

import math
from collections.abc import Sequence

import numpy as np

from runtime.errors import RuntimeInputError

__all__ = ["FLIP", "LevelFrame", "angles_of", "rotations_of", "yaw_rotations"]

FLIP = np.diag([1.0, -1.0, -1.0])
"""From our body axes to those of DIS, and back."""


class LevelFrame:
    """Where a level lies on the earth. ``origin``: latitude [°, -90 to 90], longitude [°, -180 to 360] and
    height above the ellipsoid [m] of the level's point (0, 0, 0).

    ``centre`` (3,) float64 [m]: that point, geocentric. ``axes`` (3, 3): the level's axes in geocentric
    coordinates, one a row.
    """

    def __init__(self, origin: Sequence[float]) -> None:
        latitude, longitude, height = checked_origin(origin)
        self.origin = latitude, longitude, height
        self.centre = np.array(_library().geodetic2ecef(latitude, longitude, height), dtype=np.float64)
        sin_lat, cos_lat = math.sin(math.radians(latitude)), math.cos(math.radians(latitude))
        sin_lon, cos_lon = math.sin(math.radians(longitude)), math.cos(math.radians(longitude))
        self.axes = np.array(
            [
                [-sin_lon, cos_lon, 0.0],
                [-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat],
                [cos_lat * cos_lon, cos_lat * sin_lon, sin_lat],
            ]
        )

    def to_geocentric(self, points: np.ndarray) -> np.ndarray:
        """(n, 3) [m] of the level as geocentric."""
        return self.centre + points @ self.axes

    def to_level(self, points: np.ndarray) -> np.ndarray:
        """(n, 3) [m] geocentric as of the level."""
        return (points - self.centre) @ self.axes.T

    def vectors_to_geocentric(self, vectors: np.ndarray) -> np.ndarray:
        """(n, 3) directions, velocities and accelerations."""
        return vectors @ self.axes

    def vectors_to_level(self, vectors: np.ndarray) -> np.ndarray:
        """(n, 3) directions, velocities and accelerations."""
        return vectors @ self.axes.T

    def orientations(self, rotations: np.ndarray) -> np.ndarray:
        """(n, 3) [rad] psi, theta, phi of bodies that ``rotations`` (n, 3, 3) turn from body axes of DIS to
        the level's."""
        return angles_of(self.axes.T @ rotations)

    def rotations(self, orientations: np.ndarray) -> np.ndarray:
        """(n, 3, 3): the opposite of `orientations`."""
        return self.axes @ rotations_of(orientations)


def checked_origin(origin: Sequence[float]) -> tuple[float, float, float]:
    """``origin`` as numbers. Raises `RuntimeInputError` for what is no place on the earth."""
    try:
        latitude, longitude, height = (float(each) for each in origin)
    except (TypeError, ValueError):
        raise RuntimeInputError(
            f"origin must be latitude [°], longitude [°] and height [m], not {origin!r}"
        ) from None
    if not (abs(latitude) <= 90.0 and -180.0 <= longitude <= 360.0 and abs(height) <= 1e5):
        raise RuntimeInputError(
            f"origin {(latitude, longitude, height)}: expected a latitude of -90 to 90°, a longitude of "
            "-180 to 360° and a height of -100 to 100 km"
        )
    return latitude, longitude, height


def rotations_of(angles: np.ndarray) -> np.ndarray:
    """(n, 3, 3) that turn body axes to the frame in which ``angles`` (n, 3) [rad] are psi, theta, phi: about
    z, then y, then x."""
    psi, theta, phi = np.moveaxis(np.asarray(angles, dtype=np.float64), -1, 0)
    sin_psi, cos_psi, sin_theta, cos_theta = np.sin(psi), np.cos(psi), np.sin(theta), np.cos(theta)
    sin_phi, cos_phi = np.sin(phi), np.cos(phi)
    rows = [
        cos_psi * cos_theta, cos_psi * sin_theta * sin_phi - sin_psi * cos_phi,
        cos_psi * sin_theta * cos_phi + sin_psi * sin_phi,
        sin_psi * cos_theta, sin_psi * sin_theta * sin_phi + cos_psi * cos_phi,
        sin_psi * sin_theta * cos_phi - cos_psi * sin_phi,
        -sin_theta, cos_theta * sin_phi, cos_theta * cos_phi,
    ]  # fmt: skip
    return np.stack(rows, axis=-1).reshape(*np.shape(psi), 3, 3)


def angles_of(rotations: np.ndarray) -> np.ndarray:
    """(n, 3) [rad] psi (-π to π), theta (-π/2 to π/2), phi (-π to π) of ``rotations`` (n, 3, 3), exact to the
    last digits also straight up and down: phi is taken from what is left once psi is undone."""
    r = rotations
    psi = np.arctan2(r[..., 1, 0], r[..., 0, 0])
    theta = np.arctan2(-r[..., 2, 0], np.hypot(r[..., 0, 0], r[..., 1, 0]))
    sin, cos = np.sin(psi), np.cos(psi)
    phi = np.arctan2(
        sin * r[..., 0, 2] - cos * r[..., 1, 2], cos * r[..., 1, 1] - sin * r[..., 0, 1]
    )  # fmt: skip
    return np.stack([psi, theta, phi], axis=-1)


def yaw_rotations(yaws: np.ndarray) -> np.ndarray:
    """(n, 3, 3) from body axes of DIS to the level's for upright bodies that face ``yaws`` (n,) [rad]."""
    angles = np.zeros((len(yaws), 3))
    angles[:, 0] = yaws
    return rotations_of(angles) @ FLIP


def _library():
    try:
        import pymap3d
    except ImportError as error:
        raise RuntimeInputError(f"{error}; in Surefoot's folder: pip install -e '.[dis]'") from None
    return pymap3d


def geodetic(points: np.ndarray) -> np.ndarray:
    """(n, 3): latitude [°], longitude [°] and height [m] of geocentric ``points`` (n, 3) [m]."""
    x, y, z = np.asarray(points, dtype=np.float64).T
    return np.stack(_library().ecef2geodetic(x, y, z), axis=-1)
