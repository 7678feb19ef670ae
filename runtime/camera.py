"""A camera that goes with a figure."""

import numpy as np
from scipy.ndimage import gaussian_filter1d

from runtime.errors import RuntimeInputError
from runtime.render import Camera
from runtime.trace import AgentTrace, Trace

__all__ = ["agent_named", "calm_track", "follow", "size_of"]

_CALM = 0.6  # [s] over which the camera evens out what the figure does
_GRID = 0.05  # [s] between the moments at which it is evened out
_STANDING = 0.15  # [m/s] below this the camera keeps its side


def agent_named(trace: Trace, name: str | None) -> AgentTrace:
    """The agent called ``name``, the first for None; `RuntimeInputError` names the valid ones."""
    found = next((agent for agent in trace.agents if name in (None, agent.name)), None)
    if found is None:
        valid = ", ".join(agent.name for agent in trace.agents)
        raise RuntimeInputError(f"no agent is called {name!r}; valid: {valid}")
    return found


def size_of(agent: AgentTrace) -> float:
    """[m] the longest extent of a figure in its first pose."""
    return float(np.ptp(agent.figure.posed(agent.poses[0]).place[:, :3], axis=0).max())


def calm_track(agent: AgentTrace, times: np.ndarray, moments: np.ndarray) -> np.ndarray:
    """Where the figure's root is at ``moments`` (m,) [s], evened out: (m, 3) float64 [m]."""
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
    for moment in np.clip(moments, grid[0], grid[-1]):
        at = np.array([np.interp(moment, grid, calm[:, axis]) for axis in range(3)])
        turned = float(np.interp(moment, grid, yaw))
        ahead, side = np.array([np.cos(turned), np.sin(turned)]), np.array([np.sin(turned), -np.cos(turned)])
        aside = distance * (0.8 * side - 0.55 * ahead)
        eye = at + np.array([aside[0], aside[1], 0.3 * distance])
        cameras.append(Camera(eye=eye, target=at, fov=0.62))
    return cameras
