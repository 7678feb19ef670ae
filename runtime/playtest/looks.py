"""What bots look like: the figure of a body of a world, or a capsule that its track moves."""

import numpy as np

from runtime.bodies.figure import Figure, Shapes
from runtime.playtest.character import Character

__all__ = ["POSED", "capsule", "figure_of", "poses_along"]

POSED = 0.05
"""[s] between the poses of a film or a replay."""
_ORANGE, _DARK = (0.93, 0.55, 0.16), (0.25, 0.25, 0.28)


def figure_of(character: Character) -> Figure:
    """The figure of ``character``."""
    return capsule(character) if character.slides else character.figure()


def capsule(character: Character) -> Figure:
    """A capsule with a nose, as large as ``character``, its only body at its feet."""
    radius, height = character.radius, 0.9 * character.rules.headroom
    half = max(0.5 * height - radius, 1e-3)
    nose = 0.4 * radius
    place = np.array(
        [
            (0.0, 0.0, radius + half, 1.0, 0.0, 0.0, 0.0),
            (radius, 0.0, 1.6 * half + radius, 1.0, 0.0, 0.0, 0.0),
        ]
    )
    shapes = Shapes(
        place=place, size=np.array([(radius, half, 0.0), (nose, nose, nose)]), round=np.array([False, True]),
        colour=np.array([_ORANGE, _DARK]),
    )  # fmt: skip
    return Figure(("body",), np.array([-1], np.int32), np.zeros(2, np.int32), shapes)


def poses_along(track: np.ndarray) -> np.ndarray:
    """(k, 1, 7) float32: a capsule on ``track`` (n, 4) [s, m], every `POSED` s, facing where it goes."""
    times = np.arange(track[0, 0], track[-1, 0] + 1e-9, POSED)
    place = np.column_stack([np.interp(times, track[:, 0], track[:, k]) for k in (1, 2, 3)])
    ahead = np.gradient(place[:, :2], axis=0) if len(place) > 1 else np.zeros((len(place), 2))
    yaw = np.unwrap(np.arctan2(ahead[:, 1], ahead[:, 0]))
    poses = np.zeros((len(times), 1, 7), np.float32)
    poses[:, 0, :3] = place
    poses[:, 0, 3], poses[:, 0, 6] = np.cos(0.5 * yaw), np.sin(0.5 * yaw)
    return poses
