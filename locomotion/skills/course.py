"""Straight courses of obstacles as levels of triangles."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from locomotion.ground.ground import extruded
from locomotion.paths.smoothing import ObstacleAhead
from navmesh.obstacles.kinds import kind_of

__all__ = ["AFTER", "Course", "make_course"]

AFTER = 15.0
"""[m] from the last obstacle to the goal."""
_HALF = 5.0  # [m] of the course's width
_PIT = 3.0  # [m] of depth of a gap
_EDGE = 1e-3  # [m] of the path on both sides of an edge


@dataclass(frozen=True)
class Course:
    """A course along x. vertices (v, 3), faces (f, 3): the level. path (n, 3) [m]: along its middle, from the
    start to the goal. obstacles: what the path crosses, in order."""

    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]
    path: NDArray[np.float64]
    obstacles: tuple[ObstacleAhead, ...]


def make_course(
    obstacles: Sequence[tuple[str, float, float]], distances: Sequence[float], margin: float = 5.0
) -> Course:
    """A course of ``obstacles``, each (affordance, height (gap: width) [m], thickness [m]), ``distances`` [m]
    after the start and after each other. Thickness is that of what one gets over; elsewhere it does not
    count."""
    x = z = 0.0
    profile, path, ahead = [(-margin, 0.0)], [(0.0, 0.0)], []
    for (affordance, size, thickness), distance in zip(obstacles, distances, strict=True):
        x += distance
        path.append((x - _EDGE, z))
        crossing = kind_of(affordance).crossing
        height, depth = {"over": (size, thickness), "across": (0.0, size)}.get(crossing, (size, 0.0))
        top = z + height if crossing != "off" else z
        edge = np.array([x, 0.0, top])
        ahead.append(ObstacleAhead(x, affordance, height, edge, np.array([-1.0, 0.0, 0.0]), depth))
        profile.append((x, z))
        if crossing == "over":
            profile += [(x, top), (x + depth, top), (x + depth, z)]
        elif crossing == "across":
            profile += [(x, z - _PIT), (x + depth, z - _PIT), (x + depth, z)]
        else:
            z += height if crossing == "onto" else -height
            profile.append((x, z))
        path.append((x + _EDGE, z))
    path.append((x + AFTER, z))
    profile.append((x + AFTER + margin, z))
    vertices, faces = extruded(profile, _HALF)
    points = np.array([[x, 0.0, z] for x, z in path])
    return Course(vertices, faces, points, tuple(ahead))
