"""The pictures of a report: the level from above, where bots have been, and their last moments."""

import base64
import io
from collections.abc import Sequence
from typing import Any

import numpy as np

from runtime.playtest.bots import Trouble
from runtime.playtest.character import Character
from runtime.playtest.goals import PATCH
from runtime.playtest.looks import POSED, figure_of, poses_along
from runtime.playtest.site import Site
from runtime.traces.recording import level_trace
from runtime.views.camera import clearest
from runtime.views.plot import draw_floors
from runtime.views.render import Camera, Triangles, render

__all__ = ["address", "film_strip", "heat_map", "level_map"]

_LONG_SIDE = 1400  # pixels of a map
_DPI = 100
_FRAME = (200, 170)  # pixels of a film strip's frame
_FRAMES = 5
_FILMED = 5.0  # [s] that a film strip shows
_FAR = 7.0  # [m] from the camera to what it shows


def level_map(site: Site) -> tuple[str, list[float]]:
    """The level from above as a PNG in a data address, and what it shows: x0, y0, x1, y1 [m]."""

    def draw(axes: Any) -> None:
        draw_floors(axes, level_trace(site.graph))

    return _map(site, draw)


def heat_map(site: Site, patches: Sequence[tuple[float, float, float, int]]) -> str:
    """Where bots have been, the more often the hotter, as a transparent PNG on the same scale as `level_map`;
    reachable floor that none has been to is blue."""
    from matplotlib.collections import PolyCollection

    table = np.array(patches, dtype=np.float64).reshape(-1, 4)
    half = 0.5 * PATCH
    corner = np.array([(-half, -half), (half, -half), (half, half), (-half, half)])
    most = max(float(table[:, 3].max(initial=1.0)), 2.0)

    def draw(axes: Any) -> None:
        been = table[:, 3] > 0
        looks: tuple[tuple[np.ndarray, dict[str, Any]], ...] = (
            (
                been,
                {
                    "array": np.log(table[been, 3]),
                    "cmap": "inferno",
                    "clim": (-0.3 * np.log(most), np.log(most)),
                },
            ),
            (~been, {"facecolors": "#3b82f6"}),
        )
        for chosen, options in looks:
            squares = table[chosen][:, None, :2] + corner
            axes.add_collection(PolyCollection(list(squares), alpha=0.75, linewidths=0, **options))

    return _map(site, draw)[0]


def film_strip(character: Character, triangles: Triangles, trouble: Trouble) -> str:
    """A bot's last moments before ``trouble``, side by side, as a PNG in a data address."""
    figure = figure_of(character)
    poses = poses_along(trouble.track) if trouble.poses is None else trouble.poses
    poses = poses[-round(_FILMED / POSED) :]
    picks = np.linspace(0, len(poses) - 1, _FRAMES).round().astype(int)
    feet = np.column_stack([poses[:, 0, :2], poses[:, :, 2].min(axis=1)]).astype(np.float64)
    ahead = feet[-1, :2] - feet[0, :2]
    length = float(np.linalg.norm(ahead))
    ahead = ahead / length if length > 0.3 else np.array([1.0, 0.0])
    away = 1.1 * _FAR * np.array([0.75 * ahead[1] - 0.5 * ahead[0], -0.75 * ahead[0] - 0.5 * ahead[1], 0.6])
    frames = []
    for pick in picks:
        shapes = figure.posed(poses[pick])
        camera = Camera(eye=feet[pick] + away, target=feet[pick] + np.array([0.0, 0.0, 0.7]), fov=0.5)
        camera, clear = clearest(triangles, camera, shapes.place[:, :3])
        cutaway = 0.0 if clear else 0.6 * _FAR
        frames.append(render(triangles, [shapes], camera, _FRAME, reach=25.0, cutaway=cutaway))
    gap = np.full((_FRAME[1], 4, 3), 255, np.uint8)
    return address(np.hstack([part for frame in frames for part in (frame, gap)][:-1]))


def _map(site: Site, draw: Any) -> tuple[str, list[float]]:
    from matplotlib.figure import Figure as Sheet

    low, high = site.graph.terrain.bounds[:, :2] + np.array([[-1.0], [1.0]])
    width, height = _LONG_SIDE * (high - low) / max(high - low) / _DPI
    sheet = Sheet(figsize=(max(width, 0.5), max(height, 0.5)), dpi=_DPI)
    axes = sheet.add_axes((0.0, 0.0, 1.0, 1.0))
    draw(axes)
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_axis_off()
    content = io.BytesIO()
    sheet.savefig(content, format="png", transparent=True)
    return _data_address(content), [*low.tolist(), *high.tolist()]


def address(pixels: np.ndarray) -> str:
    """``pixels`` (height, width, 3) uint8 as a PNG in a data address."""
    from matplotlib.image import imsave

    content = io.BytesIO()
    imsave(content, pixels, format="png")
    return _data_address(content)


def _data_address(content: io.BytesIO) -> str:
    return "data:image/png;base64," + base64.b64encode(content.getvalue()).decode()
