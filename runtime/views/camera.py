"""A camera that follows a figure, and one that sees it unobstructed."""

import itertools
import math

import numpy as np
from scipy.ndimage import gaussian_filter1d

from runtime.errors import RuntimeInputError
from runtime.traces.trace import AgentTrace, Trace
from runtime.views.ray_kernel import cast_faces
from runtime.views.render import Camera, Triangles

__all__ = ["agent_named", "calm_track", "clearest", "follow", "size_of"]

_CALM = 0.6  # [s] over which the figure's motion is smoothed for the camera
_GRID = 0.05  # [s] between smoothed samples
_STANDING = 0.15  # [m/s] below this the camera keeps its side
_TURNS = np.radians([0, 30, -30, 60, -60, 90, -90, 120, -120, 150, -150, 180])
_RISES = np.radians([0, 20, 40])
_NEARER = (1.0, 0.8, 0.6)
_STEEPEST = np.radians(70)  # that it looks down
_NARROW = 0.01  # [rad] of a picture for one ray
_SHORT = 0.98  # share of the way to a point that must be clear; the point itself may lie on a face


def agent_named(trace: Trace, name: str | None) -> AgentTrace:
    """The agent called ``name``, None for the first; the `RuntimeInputError` lists valid names."""
    found = next((agent for agent in trace.agents if name in (None, agent.name)), None)
    if found is None:
        valid = ", ".join(agent.name for agent in trace.agents)
        raise RuntimeInputError(f"no agent is called {name!r}; valid: {valid}")
    return found


def size_of(agent: AgentTrace) -> float:
    """[m] largest extent of a figure in its first pose."""
    return float(np.ptp(agent.figure.posed(agent.poses[0]).place[:, :3], axis=0).max())


def calm_track(agent: AgentTrace, times: np.ndarray, moments: np.ndarray) -> np.ndarray:
    """Smoothed position of the figure's root at ``moments`` (m,) [s]: (m, 3) float64 [m]."""
    grid = _grid(times)
    root = [np.interp(grid, times, agent.poses[:, 0, axis].astype(np.float64)) for axis in range(3)]
    calm = gaussian_filter1d(np.array(root), _CALM / _GRID, axis=1, mode="nearest")
    return np.column_stack([np.interp(moments, grid, values) for values in calm])


def _grid(times: np.ndarray) -> np.ndarray:
    return np.arange(times[0], times[-1] + _GRID, _GRID)


def follow(agent: AgentTrace, times: np.ndarray, moments: np.ndarray, distance: float) -> list[Camera]:
    """Cameras for ``moments`` (m,) [s] of a trace with poses at ``times`` (t,) [s].

    They look at the figure from its right, a little behind and above, ``distance`` [m] away, and turn slowly.
    """
    grid = _grid(times)
    calm = calm_track(agent, times, grid)
    velocity = np.gradient(calm, grid, axis=0)[:, :2] if len(grid) > 1 else np.zeros((1, 2))
    moving = np.flatnonzero(np.linalg.norm(velocity, axis=1) > _STANDING)
    if len(moving):
        yaw = np.unwrap(np.arctan2(velocity[moving, 1], velocity[moving, 0]))
        yaw = gaussian_filter1d(np.interp(grid, grid[moving], yaw), 2.0 * _CALM / _GRID, mode="nearest")
    else:
        yaw = np.zeros(len(grid))
    cameras = []
    for moment in np.clip(moments, grid.min(), grid.max()):
        at = np.array([np.interp(moment, grid, calm[:, axis]) for axis in range(3)])
        turned = float(np.interp(moment, grid, yaw))
        ahead, side = np.array([np.cos(turned), np.sin(turned)]), np.array([np.sin(turned), -np.cos(turned)])
        aside = distance * (0.8 * side - 0.55 * ahead)
        eye = at + np.array([aside[0], aside[1], 0.3 * distance])
        cameras.append(Camera(eye=eye, target=at, fov=0.62))
    return cameras


def clearest(level: Triangles, camera: Camera, points: np.ndarray) -> tuple[Camera, bool]:
    """A camera that sees ``points`` (n, 3) [m], and whether it sees all: ``camera``, or one that is turned
    about its target, raised, or nearer, in this order of preference; the first from which the level hides
    the fewest points.
    """
    aside = camera.eye - camera.target
    around, away = math.hypot(aside[0], aside[1]), float(np.linalg.norm(aside))
    yaw, pitch = math.atan2(aside[1], aside[0]), math.atan2(aside[2], around)
    low, high = (
        np.minimum(points.min(axis=0), camera.target - away),
        np.maximum(points.max(axis=0), camera.target + away),
    )
    corners = level.corners
    near = np.all((level.high > low) & (level.low < high), axis=1)
    best, fewest = camera, len(points) + 1
    for nearer, rise, turn in itertools.product(_NEARER, _RISES, _TURNS):
        up, to = min(pitch + rise, _STEEPEST), yaw + turn
        arm = np.array([math.cos(up) * math.cos(to), math.cos(up) * math.sin(to), math.sin(up)])
        tried = Camera(camera.target + nearer * away * arm, camera.target, camera.fov)
        count = _hidden(corners[near], tried.eye, points, fewest)
        if count < fewest:
            best, fewest = tried, count
        if fewest == 0:
            break
    return best, fewest == 0


def _hidden(corners: np.ndarray, eye: np.ndarray, points: np.ndarray, enough: int) -> int:
    """Number of ``points`` (n, 3) that faces (f, 3, 3) hide from ``eye``, from either side; stops counting at
    ``enough``."""
    count = 0
    for point in points:
        sight = Camera(eye, point, _NARROW)
        distance = np.full((1, 1), _SHORT * np.linalg.norm(point - eye))
        scale = 0.5 / math.tan(0.5 * _NARROW)
        found = cast_faces(
            eye, np.stack(sight.axes()), scale, sight.rays(1, 1), corners, np.zeros(len(corners)), distance
        )
        count += int(found[0, 0] >= 0)
        if count >= enough:
            break
    return count
