"""Where a figure stands on the ground: x, y [m] and turn [rad] about the vertical, (3,) float64."""

import numpy as np

__all__ = ["beyond", "inverse", "place_of", "placed"]


def place_of(pose: np.ndarray) -> np.ndarray:
    """The place of a pose (46,): its root, and the twist of its rotation about the vertical."""
    return np.array([pose[0], pose[1], 2.0 * np.arctan2(pose[6], pose[3])])


def beyond(place: np.ndarray, move: np.ndarray) -> np.ndarray:
    """Where a ``move``, which is told from ``place``, leads."""
    x, y, turn = place
    dx, dy, more = move
    c, s = np.cos(turn), np.sin(turn)
    return np.array([x + c * dx - s * dy, y + s * dx + c * dy, turn + more])


def inverse(move: np.ndarray) -> np.ndarray:
    """The move that leads back."""
    x, y, turn = move
    c, s = np.cos(turn), np.sin(turn)
    return np.array([-(c * x + s * y), -(c * y - s * x), -turn])


def placed(pose: np.ndarray, place: np.ndarray) -> np.ndarray:
    """``pose`` (46,) carried to ``place``."""
    turn = place[2]
    moved = pose.copy()
    moved[:2] = beyond(place, np.array([pose[0], pose[1], 0.0]))[:2]
    cw, sw = np.cos(0.5 * turn), np.sin(0.5 * turn)
    w, i, j, k = pose[3:7]
    moved[3:7] = cw * w - sw * k, cw * i - sw * j, cw * j + sw * i, cw * k + sw * w
    return moved
