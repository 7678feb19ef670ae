"""A camera that goes with a figure."""

import numpy as np
from scipy.ndimage import gaussian_filter1d

from runtime.render import Camera
from runtime.trace import AgentTrace

__all__ = ["follow", "size_of"]

_CALM = 0.6  # [s] over which the camera evens out what the figure does
_STANDING = 0.15  # [m/s] below this the camera keeps its side


def size_of(agent: AgentTrace) -> float:
    """[m] the longest extent of a figure in its first pose."""
    return float(np.ptp(agent.figure.posed(agent.poses[0]).place[:, :3], axis=0).max())


def follow(agent: AgentTrace, times: np.ndarray, moments: np.ndarray, distance: float) -> list[Camera]:
    """Cameras for ``moments`` (m,) [s] of a trace with poses at ``times`` (t,) [s].

    They look at the figure from its right, a little behind and above, ``distance`` [m] away, and turn slowly.
    """
    grid = np.arange(times[0], times[-1] + 0.05, 0.05)
    root = np.column_stack(
        [np.interp(grid, times, agent.poses[:, 0, axis].astype(float)) for axis in range(3)]
    )
    calm = gaussian_filter1d(root, _CALM / 0.05, axis=0, mode="nearest")
    velocity = np.gradient(calm, grid, axis=0)[:, :2] if len(grid) > 1 else np.zeros((1, 2))
    moving = np.flatnonzero(np.linalg.norm(velocity, axis=1) > _STANDING)
    if len(moving):
        yaw = np.unwrap(np.arctan2(velocity[moving, 1], velocity[moving, 0]))
        yaw = gaussian_filter1d(np.interp(grid, grid[moving], yaw), 2.0 * _CALM / 0.05, mode="nearest")
    else:
        yaw = np.zeros(len(grid))
    cameras = []
    for moment in np.clip(moments, grid[0], grid[-1]):
        at = np.array([np.interp(moment, grid, calm[:, axis]) for axis in range(3)])
        turned = float(np.interp(moment, grid, yaw))
        ahead, side = np.array([np.cos(turned), np.sin(turned)]), np.array([np.sin(turned), -np.cos(turned)])
        aside = distance * (0.8 * side - 0.55 * ahead)
        eye = at + np.array([aside[0], aside[1], 0.3 * distance])
        cameras.append(Camera(eye=eye, target=at, fov=0.62))
    return cameras
