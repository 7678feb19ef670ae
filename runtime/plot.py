"""A plot of a run from above: the level, its graph and obstacles, and the paths."""

import os
from typing import Any

import numpy as np

from runtime.files import whole_file
from runtime.trace import LevelTrace, Trace

__all__ = ["draw_floors", "plot_from_above"]

_AFFORDANCE_COLOURS = {"jump": "#d1495b", "vault": "#8e44ad", "drop": "#edae49", "gap": "#00798c"}
_LONG_SIDE = 15.0  # [in]


def plot_from_above(trace: Trace, path: str | os.PathLike[str]) -> None:
    """Write the picture (PNG) to ``path``, whole or not at all."""
    from matplotlib.figure import Figure

    level = trace.level
    low, high = level.vertices[:, :2].min(axis=0), level.vertices[:, :2].max(axis=0)
    width, height = (high - low) * _LONG_SIDE / max(high - low)
    figure = Figure(figsize=(max(width, 5.0), max(height, 3.0) + 1.0), dpi=130, layout="constrained")
    axes = figure.subplots()
    colours = draw_floors(axes, level)
    _draw_graph(axes, level)
    _draw_obstacles(axes, level)
    for agent in trace.agents:
        for planned in agent.paths:
            axes.plot(*planned.raw[:, :2].T, color="#7f7f7f", lw=1.1, ls=":", marker=".", ms=4, zorder=5)
            axes.plot(*planned.pulled[:, :2].T, color="#1f77b4", lw=1.4, ls="--", zorder=6)
            axes.plot(*planned.smooth[:, :2].T, color="#d62728", lw=2.2, zorder=7)
        root = agent.poses[:, 0, :2]
        axes.plot(*root.T, color="black", lw=0.9, zorder=8)
        axes.plot(*root[0], "o", color="white", mec="black", ms=9, zorder=9)
        axes.plot(*root[-1], "*", color="gold", mec="black", ms=16, zorder=9)
        axes.annotate(agent.name, root[0], xytext=(8, 8), textcoords="offset points", weight="bold", zorder=9)
    axes.set_aspect("equal")
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    figure.colorbar(colours, ax=axes, label="height of the floor [m]", shrink=0.7, pad=0.01)
    figure.legend(handles=_legend(set(level.affordances)), loc="outside lower center", ncols=6, frameon=False)
    with whole_file(path) as temporary:
        figure.savefig(temporary, format="png")


def draw_floors(axes: Any, level: LevelTrace) -> Any:
    """Faces that look up, coloured by height, and the outlines of what is steep."""
    from matplotlib.collections import LineCollection, PolyCollection

    corners = level.vertices[level.faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.maximum(np.linalg.norm(normal, axis=1), 1e-12)
    up = normal[:, 2] / length
    floors = corners[up > 0.5]
    floors = floors[np.argsort(floors[:, :, 2].mean(axis=1))]
    faces = PolyCollection(list(floors[:, :, :2]), array=floors[:, :, 2].mean(axis=1), cmap="Greys", zorder=1)
    faces.set_clim(float(level.vertices[:, 2].min()) - 1.0, float(level.vertices[:, 2].max()) + 1.0)
    faces.set_edgecolor("face")
    axes.add_collection(faces)
    steep = corners[np.abs(up) < 0.2][:, :, :2]
    walls = np.concatenate([steep[:, (0, 1)], steep[:, (1, 2)]])
    axes.add_collection(LineCollection(list(walls), colors="#404040", lw=0.5, zorder=2))
    return faces


def _draw_graph(axes: Any, level: LevelTrace) -> None:
    from matplotlib.collections import EllipseCollection, LineCollection

    wide = level.radii > 0.3
    size = 2.0 * level.radii[wide]
    discs = EllipseCollection(
        size, size, np.zeros(len(size)), units="xy", offsets=level.positions[wide, :2],
        offset_transform=axes.transData, facecolors="none", edgecolors="#2a9d8f", lw=0.35, alpha=0.55,
        zorder=3,
    )  # fmt: skip
    axes.add_collection(discs)
    ends = level.positions[level.edges][:, :, :2]
    shown = wide[level.edges].all(axis=1)
    axes.add_collection(LineCollection(list(ends[shown]), colors="#2a9d8f", lw=0.5, alpha=0.8, zorder=4))


def _draw_obstacles(axes: Any, level: LevelTrace) -> None:
    for affordance, rim, normal, height in zip(
        level.affordances, level.rim, level.normal, level.height, strict=True
    ):
        colour = _AFFORDANCE_COLOURS[affordance]
        axes.plot(*rim[:, :2].T, color=colour, lw=3.0, solid_capstyle="butt", zorder=5)
        if np.linalg.norm(rim[1] - rim[0]) > 2.0:
            at = rim.mean(axis=0) + 0.8 * normal
            note = {"xy": at[:2], "ha": "center", "va": "center", "fontsize": 6.5, "color": colour}
            box = {"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.7}
            axes.annotate(f"{affordance} {abs(height):.2f}", **note, bbox=box, zorder=8)


def _legend(affordances: set[str]) -> list[Any]:
    from matplotlib.lines import Line2D

    lines = [
        Line2D(
            [], [], color="#2a9d8f", lw=0.8, marker="o", mfc="none", ms=9, label="graph: discs above 0.3 m"
        ),
        Line2D([], [], color="#7f7f7f", ls=":", marker=".", label="A* path through the discs"),
        Line2D([], [], color="#1f77b4", ls="--", label="pulled path"),
        Line2D([], [], color="#d62728", lw=2.2, label="smoothed path"),
        Line2D([], [], color="black", lw=0.9, label="where the figure went"),
    ]
    shown = [name for name in _AFFORDANCE_COLOURS if name in affordances]
    return lines + [Line2D([], [], color=_AFFORDANCE_COLOURS[name], lw=3, label=name) for name in shown]
