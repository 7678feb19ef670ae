"""The picture of a finding: what was measured is drawn into the level, with a body beside it for scale, and
seen from where nothing hides it."""

import math

import numpy as np

from runtime.bodies.figure import Shapes
from runtime.playtest.fault import Fault
from runtime.playtest.looks import capsule
from runtime.playtest.site import Site
from runtime.views.camera import clearest
from runtime.views.render import Camera, Triangles, render

__all__ = ["close_up"]

_SIZE = (400, 300)  # pixels
_RED, _WHITE = (0.83, 0.18, 0.20), (0.97, 0.97, 0.95)
_BAR = 0.035  # [m] radius of the bar along what was measured
_PIN = 0.9  # [m] height of the pin where nothing was
_FOV = 0.75
_DOWN = (0.62, 0.4, 0.2)  # [rad] that the camera looks down: the lower, the lower the ceiling
_ASIDE = 0.6  # [rad] that it looks from the side
_NEAR = 2.0  # [m] from what was measured to the body beside it


def close_up(site: Site, triangles: Triangles, fault: Fault) -> np.ndarray:
    """The picture of ``fault``: (height, width, 3) uint8. ``triangles`` are the site's."""
    at = np.array(fault.position)
    ends = np.array(fault.span) if fault.span else np.array([at, [*at[:2], at[2] + _PIN]])
    long = float(np.linalg.norm(ends[1] - ends[0]))
    around = _floor_around(site, at, long)
    target = ends.mean(axis=0) + np.array([0.0, 0.0, 0.4])
    away = (0.5 * long + 1.6) / math.tan(0.5 * _FOV)
    # a bar may lie on the floor, and end at walls and ceilings
    middle = ends.mean(axis=0)
    points = np.vstack([middle + 0.85 * (ends - middle), middle]) + np.array([0.0, 0.0, 0.04])
    for down in _DOWN:
        camera = Camera(target + away * _from(ends, around, down), target, _FOV)
        camera, clear = clearest(triangles, camera, points)
        if clear:
            break
    shapes = [_bar(ends)]
    body = _beside(around, ends, camera.eye, site.character.radius)
    if body is not None:
        aside = (ends.mean(axis=0) - body)[:2]
        shapes.append(capsule(site.character).posed(_standing(body, math.atan2(aside[1], aside[0]))))
    near = max(float(np.linalg.norm(camera.eye - target)) - 0.5 * long - 0.5, 0.0)
    return render(triangles, shapes, camera, _SIZE, reach=away + 20.0, cutaway=0.0 if clear else near)


def _floor_around(site: Site, at: np.ndarray, long: float) -> np.ndarray:
    """(k, 3) [m]: places near ``at`` (3,) where the body fits."""
    return site.everywhere.within(at - (_NEAR + long), at + (_NEAR + long))


def _from(ends: np.ndarray, around: np.ndarray, down: float) -> np.ndarray:
    """Unit vector (3,) to a camera that looks ``down`` [rad]: at an angle to what was measured, on the side
    with the nearest floor."""
    along, middle = (ends[1] - ends[0])[:2], ends.mean(axis=0)
    toward = np.array([-0.56, -0.83])
    if len(around):
        toward = (around[np.argmin(np.linalg.norm(around - ends[0], axis=1))] - middle)[:2]
    if np.linalg.norm(along) > 0.05 and abs(ends[1, 2] - ends[0, 2]) < 0.1:
        aside = np.array([-along[1], along[0]])
        toward = aside if aside @ toward >= 0.0 else -aside
    yaw = math.atan2(toward[1], toward[0]) + _ASIDE
    level = math.cos(down)
    return np.array([level * math.cos(yaw), level * math.sin(yaw), math.sin(down)])


def _beside(around: np.ndarray, ends: np.ndarray, eye: np.ndarray, radius: float) -> np.ndarray | None:
    """(3,) [m]: of ``around`` (k, 3) the place nearest to what was measured where a body hides nothing of it;
    None where there is none."""
    points = np.vstack([ends, ends.mean(axis=0)])
    away = np.linalg.norm(around[:, None] - points, axis=2).min(axis=1)
    line = (points - eye)[:, :2]
    part = np.einsum("kc,pc->kp", (around - eye)[:, :2], line) / np.maximum((line**2).sum(axis=1), 1e-9)
    foot = eye[:2] + np.clip(part, 0.0, 1.0)[..., None] * line
    past = np.linalg.norm(around[:, None, :2] - foot, axis=2).min(axis=1)
    free = (past >= radius + 0.2) & (away >= radius + 0.3)
    before = (around - points[2])[:, :2] @ (eye - points[2])[:2] > 0.0  # and not behind a wall
    free &= before if (free & before).any() else True
    return around[free][np.argmin(away[free])] if free.any() else None


def _standing(place: np.ndarray, yaw: float) -> np.ndarray:
    """(1, 7): the pose of a capsule at ``place`` (3,) that faces ``yaw`` [rad]."""
    return np.array([[*place, math.cos(0.5 * yaw), 0.0, 0.0, math.sin(0.5 * yaw)]])


def _bar(ends: np.ndarray) -> Shapes:
    """A red bar between ``ends`` (2, 3) [m], with a white ball at each."""
    along = ends[1] - ends[0]
    long = float(np.linalg.norm(along))
    place = np.zeros((3, 7))
    place[0, :3], place[1:, :3] = ends.mean(axis=0), ends
    place[:, 3] = 1.0
    if long > 1e-6:
        place[0, 3:] = _upright_to(along / long)
    ball = 2.2 * _BAR
    size = np.array([(_BAR, 0.5 * long, 0.0), (ball, ball, ball), (ball, ball, ball)])
    return Shapes(place, size, np.array([False, True, True]), np.array([_RED, _WHITE, _WHITE]))


def _upright_to(way: np.ndarray) -> np.ndarray:
    """(4,): the shortest turn, wxyz, from straight up to the unit vector ``way`` (3,)."""
    half = np.array([1.0 + way[2], -way[1], way[0], 0.0])
    length = float(np.linalg.norm(half))
    return half / length if length > 1e-6 else np.array([0.0, 1.0, 0.0, 0.0])
