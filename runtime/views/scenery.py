"""A run's level, graph, obstacles and paths as a viser scene, for all live views."""

import contextlib
import io
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from runtime.traces.trace import LevelTrace, PathTrace
from runtime.views.obstacle_colours import obstacle_colour, parts_of_colour

__all__ = ["ALL", "draw_level", "draw_paths", "silent"]

ALL = "/run"
"""Parent frame of everything."""
_LEVEL = f"{ALL}/level"
_RAW, _PULLED, _SMOOTH = (120, 120, 120), (31, 119, 180), (214, 39, 40)


@contextlib.contextmanager
def silent() -> Iterator[None]:
    """Suppress viser's messages at start and stop within this block."""
    with contextlib.redirect_stdout(io.StringIO()):
        yield


def draw_level(scene: Any, level: LevelTrace) -> Any:
    """Add the level's surface, its graph and its obstacles with their affordances; returns their parent
    frame."""
    frame = scene.add_frame(_LEVEL, show_axes=False)
    scene.add_mesh_simple(
        f"{_LEVEL}/surface", level.vertices.astype(np.float32), level.faces.astype(np.uint32),
        color=(205, 203, 196), flat_shading=True, side="front",
    )  # fmt: skip
    wide = level.radii > 0.3
    lift = np.array([0.0, 0.0, 0.04])
    scene.add_line_segments(
        f"{_LEVEL}/graph/discs", _circles(level.positions[wide] + lift, level.radii[wide]),
        colors=(42, 157, 143), thickness=1.0, thickness_units="screen",
    )  # fmt: skip
    joined = wide[level.edges].all(axis=1)
    if joined.any():
        scene.add_line_segments(
            f"{_LEVEL}/graph/edges", (level.positions[level.edges[joined]] + lift).astype(np.float32),
            colors=(20, 110, 100), thickness=1.5, thickness_units="screen",
        )  # fmt: skip
    for k, affordance in enumerate(level.affordances):
        name = f"{_LEVEL}/obstacles/{affordance} {k}"
        rim = (level.rim[k] + lift).astype(np.float32)[None]
        scene.add_line_segments(
            name, rim, colors=parts_of_colour(obstacle_colour(affordance)), thickness=5.0,
            thickness_units="screen",
        )  # fmt: skip
        if np.linalg.norm(rim[0, 1] - rim[0, 0]) > 2.0:
            text = f"{affordance} {abs(level.height[k]):.2f} m"
            scene.add_label(f"{name}/label", text, position=rim[0].mean(axis=0) + np.array([0.0, 0.0, 0.3]))
    return frame


def _circles(centers: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """Line segments (n * 20, 2, 3) float32 around horizontal circles."""
    angle = np.linspace(0.0, 2.0 * np.pi, 21)
    round_ = np.stack([np.cos(angle), np.sin(angle), np.zeros(21)], axis=1)
    points = centers[:, None] + radii[:, None, None] * round_
    return np.stack([points[:, :-1], points[:, 1:]], axis=2).reshape(-1, 2, 3).astype(np.float32)


def draw_paths(scene: Any, name: str, planned: Sequence[PathTrace]) -> None:
    """Add the raw, pulled and smoothed lines of plans, as three objects under ``name``."""
    for label, colour, height in (("raw", _RAW, 0.06), ("pulled", _PULLED, 0.08), ("smooth", _SMOOTH, 0.10)):
        lines = [
            np.stack([points[:-1], points[1:]], axis=1) for points in (getattr(p, label) for p in planned)
        ]
        joined = np.concatenate([np.empty((0, 2, 3)), *lines]) + np.array([0.0, 0.0, height])
        if len(joined):
            scene.add_line_segments(
                f"{name}/{label}", joined.astype(np.float32), colors=colour,
                thickness=3.0, thickness_units="screen",
            )  # fmt: skip
        else:
            scene.add_frame(f"{name}/{label}", show_axes=False)
