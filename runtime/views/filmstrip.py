"""A film strip: moments of a run side by side, drawn by `runtime.views.render` from a trace."""

import os
from typing import TYPE_CHECKING

import numpy as np

from runtime.traces.trace import AgentTrace, Trace
from runtime.views.camera import clearest, size_of
from runtime.views.render import Camera, Triangles, render
from surefoot.files.atomic_write import whole_file
from surefoot.progress import Progress

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["show_frame", "write_filmstrip"]

_FRAMES, _COLUMNS = 8, 4
_SIZE = (400, 330)
_BEFORE, _AFTER = 0.25, 0.15  # [s] shown before a skill starts and after it has finished
_DISTANCE = 2.4  # [sizes of the figure] from the camera to it


def write_filmstrip(trace: Trace, path: str | os.PathLike[str], progress: Progress | None = None) -> None:
    """Write eight moments (PNG) of the run's first skill, or of the whole run if it has none, to ``path``.

    The file appears whole or not at all.
    """
    from matplotlib.figure import Figure

    agent, begin, end, title = _scene(trace)
    level = Triangles(trace.level.vertices, trace.level.faces)
    picks = np.searchsorted(trace.times, np.linspace(begin, end, _FRAMES)).clip(0, len(trace.times) - 1)
    rows = -(-_FRAMES // _COLUMNS)
    figure = Figure(figsize=(_COLUMNS * 3.2, rows * 2.64 + 0.4), dpi=125, layout="constrained")
    figure.suptitle(title, fontsize=11)
    with (progress or Progress(shown=False)).stage("drawing the film strip") as stage:
        for k, (axes, pick) in enumerate(zip(figure.subplots(rows, _COLUMNS).flat, picks, strict=True)):
            stage.update(k / _FRAMES)
            figures = [each.posed(int(pick), each.poses[pick]) for each in trace.agents]
            shown = agent.figure.posed(agent.poses[pick]).place[:, :3]
            camera, clear = clearest(level, _camera(agent, trace, int(pick)), shown)
            away = float(np.linalg.norm(camera.eye - camera.target))
            picture = render(level, figures, camera, _SIZE, cutaway=0.0 if clear else 0.75 * away)
            show_frame(axes, picture, f"{trace.times[pick]:.2f} s")
    with whole_file(path) as temporary:
        figure.savefig(temporary, format="png")


def show_frame(axes: "Axes", picture: np.ndarray, label: str) -> None:
    """Show one ``picture`` of a strip, with a label in its corner."""
    axes.imshow(picture)
    axes.set_axis_off()
    axes.text(0.03, 0.94, label, transform=axes.transAxes, va="top", fontsize=9)


def _scene(trace: Trace) -> tuple[AgentTrace, float, float, str]:
    """The agent to show, from when to when [s], and a caption."""
    started = next((event for event in trace.events if event["kind"] == "SkillStarted"), None)
    if started is None:
        agent = trace.agents[0]
        return agent, float(trace.times[0]), float(trace.times[-1]), f"{agent.name}: the whole run"
    agent = next(each for each in trace.agents if each.name == started["agent"])
    later = [
        event for event in trace.events if event["agent"] == agent.name and event["time"] > started["time"]
    ]
    ended = next(
        (event["time"] for event in later if event["kind"] in ("SkillFinished", "Fell")), trace.times[-1]
    )
    what = f"{agent.name}: {started['skill']}, {started['height']:.2f} m"
    return agent, started["time"] - _BEFORE, ended + _AFTER, what


def _camera(agent: AgentTrace, trace: Trace, pick: int) -> Camera:
    """From the right of the figure's path, a little behind and above."""
    distance = _DISTANCE * size_of(agent)
    root = agent.poses[:, 0, :3].astype(np.float64)
    before, after = max(pick - 20, 0), min(pick + 20, len(root) - 1)
    heading = root[after, :2] - root[before, :2]
    length = float(np.linalg.norm(heading))
    ahead = heading / length if length > 0.1 else np.array([1.0, 0.0])
    side = np.array([ahead[1], -ahead[0]])
    target = root[pick] + np.array([0.25 * ahead[0], 0.25 * ahead[1], -0.1])
    aside = distance * (0.9 * side - 0.45 * ahead)
    return Camera(eye=target + np.array([aside[0], aside[1], 0.18 * distance]), target=target, fov=0.62)
