"""A plot of a run from above: the level, its graph and obstacles, and the paths; a drawing per storey."""

import os
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from runtime.traces.trace import AgentTrace, LevelTrace, Trace
from runtime.views.obstacle_colours import in_order, obstacle_colour
from runtime.views.storeys import cut_heights
from surefoot.files.atomic_write import whole_file

__all__ = ["draw_floors", "plot_from_above"]

_LONG_SIDE = 15.0  # [in]
_MOST = 6  # most storeys shown; of more, the ones with the most events
_SHOWN = 0.3  # [m]: smaller discs are not drawn
_AROUND = 2.0  # [m] margin around walkable ground
_LABELLED = 2.0  # [m]: shorter edges have no label
_LABEL = np.array([44.0, 11.0])  # [points] of room for a label


@dataclass(frozen=True)
class _Storey:
    """A range of heights [m]."""

    low: float
    high: float

    def holds(self, height: Any) -> Any:
        return (height >= self.low) & (height < self.high)

    def meets(self, heights: np.ndarray) -> np.ndarray:
        """(n,) bool: whether objects at ``heights`` (n, k) overlap the storey."""
        return (heights.max(axis=1) >= self.low) & (heights.min(axis=1) < self.high)

    @property
    def title(self) -> str:
        bounds = (("above", self.low), ("below", self.high))
        return " and ".join(f"{word} {z:.1f} m" for word, z in bounds if np.isfinite(z))


def plot_from_above(trace: Trace, path: str | os.PathLike[str]) -> None:
    """Write the picture (PNG) to ``path``, whole or not at all. Each storey has its own drawing; at most six,
    those with the most events."""
    from matplotlib.figure import Figure

    level = trace.level
    storeys = _storeys(trace)
    bounds = np.array([_bounds(level, storey, alone=len(storeys) == 1) for storey in storeys])
    low, high = bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)
    # side by side if they are tall, stacked if they are wide
    along = int(np.argmin(high - low))
    bounds[:, 0, 1 - along], bounds[:, 1, 1 - along] = low[1 - along], high[1 - along]
    lengths = (bounds[:, 1] - bounds[:, 0])[:, along]
    scale = _LONG_SIDE / max(*(high - low), lengths.sum())
    size = scale * (high - low)
    size[along] = scale * lengths.sum() + 0.6 * len(storeys)
    figure = Figure(figsize=(max(size[0], 5.0) + 1.0, max(size[1], 3.0) + 1.0), dpi=130, layout="constrained")
    if along == 0:
        grid = figure.subplots(1, len(storeys), squeeze=False, width_ratios=lengths.tolist())
    else:
        grid = figure.subplots(len(storeys), 1, squeeze=False, height_ratios=lengths.tolist())
    colours: Any = None
    for axes, storey, (least, most) in zip(grid.flat, storeys, bounds, strict=True):
        axes.set_aspect("equal")
        axes.set_xlim(least[0], most[0])
        axes.set_ylim(least[1], most[1])
        axes.set_xlabel("x [m]")
        axes.set_ylabel("y [m]")
        if len(storeys) > 1:
            axes.set_title(storey.title)
        colours = _draw_storey(axes, trace, storey)
    figure.colorbar(colours, ax=grid, label="height of the floor [m]", shrink=0.7, pad=0.01)
    figure.legend(handles=_legend(set(level.affordances)), loc="outside lower center", ncols=6, frameon=False)
    figure.draw_without_rendering()  # computes the layout, so that labels know their room
    for axes, storey in zip(grid.flat, storeys, strict=True):
        _label_obstacles(axes, level, storey)
    with whole_file(path) as temporary:
        figure.savefig(temporary, format="png", bbox_inches="tight")


def _storeys(trace: Trace) -> list[_Storey]:
    """Sorted from lowest to highest."""
    bounds = [-np.inf, *cut_heights(trace.level), np.inf]
    storeys = [_Storey(low, high) for low, high in pairwise(bounds)]
    if len(storeys) <= _MOST:
        return storeys
    feet = np.concatenate([_feet(agent)[:, 2] for agent in trace.agents])
    busiest = np.argsort([-int(storey.holds(feet).sum()) for storey in storeys], kind="stable")[:_MOST]
    return [storeys[k] for k in sorted(busiest)]


def _bounds(level: LevelTrace, storey: _Storey, alone: bool) -> np.ndarray:
    """(2, 2) [m]: least and greatest x and y to draw: the whole level if it is ``alone``, else where one can
    walk in this storey."""
    whole = np.stack([level.vertices[:, :2].min(axis=0), level.vertices[:, :2].max(axis=0)])
    here = storey.holds(level.positions[:, 2]) & (level.radii > _SHOWN)
    if alone or not here.any():
        return whole
    places, radii = level.positions[here, :2], level.radii[here, None] + _AROUND
    return np.stack([(places - radii).min(axis=0), (places + radii).max(axis=0)]).clip(whole[0], whole[1])


def _feet(agent: AgentTrace) -> np.ndarray:
    """(t, 3) [m]: position of the figure's root, at the height of its lowest part."""
    return np.column_stack([agent.poses[:, 0, :2], agent.poses[:, :, 2].min(axis=1)]).astype(np.float64)


def _draw_storey(axes: Any, trace: Trace, storey: _Storey) -> Any:
    from matplotlib.patheffects import withStroke

    level = trace.level
    colours = draw_floors(axes, level, storey.meets(level.vertices[level.faces][:, :, 2]))
    _draw_graph(axes, level, storey)
    for k, affordance in enumerate(level.affordances):
        if storey.holds(level.rim[k, :, 2].max()):
            colour = obstacle_colour(affordance)
            axes.plot(*level.rim[k, :, :2].T, color=colour, lw=3.0, solid_capstyle="butt", zorder=5)
    for agent in trace.agents:
        for planned in agent.paths:
            _draw_line(axes, planned.raw, storey, color="#7f7f7f", lw=1.1, ls=":", marker=".", ms=4, zorder=5)
            _draw_line(axes, planned.pulled, storey, color="#1f77b4", lw=1.4, ls="--", zorder=6)
            _draw_line(axes, planned.smooth, storey, color="#d62728", lw=2.2, zorder=7)
        feet = _feet(agent)
        _draw_line(axes, feet, storey, color="black", lw=0.9, zorder=8)
        if storey.holds(feet[-1, 2]):
            axes.plot(*feet[-1, :2], "*", color="gold", mec="black", ms=16, zorder=9)
        if storey.holds(feet[0, 2]):
            axes.plot(*feet[0, :2], "o", color="white", mec="black", ms=9, zorder=9)
            note = {"xytext": (8, 8), "textcoords": "offset points", "weight": "bold", "zorder": 9}
            rim = [withStroke(linewidth=3.0, foreground="white")]
            axes.annotate(agent.name, feet[0, :2], path_effects=rim, **note)
    return colours


def _draw_line(axes: Any, points: np.ndarray, storey: _Storey, **style: Any) -> None:
    """The parts of a line (n, 3) within a storey."""
    points = np.asarray(points, dtype=np.float64)
    if len(points) < 2:
        return
    shown = storey.meets(np.column_stack([points[:-1, 2], points[1:, 2]]))
    kept = np.zeros(len(points), dtype=bool)
    kept[:-1] |= shown
    kept[1:] |= shown
    axes.plot(*np.where(kept[:, None], points[:, :2], np.nan).T, **style)


def draw_floors(axes: Any, level: LevelTrace, which: np.ndarray | None = None) -> Any:
    """Draw upward faces coloured by height, and the outlines of steep ones; of the faces ``which`` (f,) bool,
    by default all."""
    from matplotlib.collections import LineCollection, PolyCollection

    corners = level.vertices[level.faces if which is None else level.faces[which]]
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


def _draw_graph(axes: Any, level: LevelTrace, storey: _Storey) -> None:
    from matplotlib.collections import EllipseCollection, LineCollection

    wide = level.radii > _SHOWN
    here = wide & storey.holds(level.positions[:, 2])
    size = 2.0 * level.radii[here]
    discs = EllipseCollection(
        size, size, np.zeros(len(size)), units="xy", offsets=level.positions[here, :2],
        offset_transform=axes.transData, facecolors="none", edgecolors="#2a9d8f", lw=0.35, alpha=0.55,
        zorder=3,
    )  # fmt: skip
    axes.add_collection(discs)
    edges = level.edges[wide[level.edges].all(axis=1)]
    edges = edges[storey.meets(level.positions[edges][:, :, 2])]
    ends = level.positions[edges][:, :, :2]
    axes.add_collection(LineCollection(list(ends), colors="#2a9d8f", lw=0.5, alpha=0.8, zorder=4))


def _label_obstacles(axes: Any, level: LevelTrace, storey: _Storey) -> None:
    """Label the obstacles, longest first, where there is room; a wall vaulted from both sides gets one
    label."""
    length = np.linalg.norm(level.rim[:, 1] - level.rim[:, 0], axis=1) if len(level.rim) else np.empty(0)
    pixels = _LABEL * axes.figure.dpi / 72.0
    taken: list[np.ndarray] = []
    for k in np.argsort(-length, kind="stable"):
        if length[k] <= _LABELLED or not storey.holds(level.rim[k, :, 2].max()):
            continue
        at = level.rim[k].mean(axis=0) + 0.8 * level.normal[k]
        shown = axes.transData.transform(at[:2])
        if any((np.abs(shown - other) < pixels).all() for other in taken):
            continue
        taken.append(shown)
        text = f"{level.affordances[k]} {abs(level.height[k]):.2f}"
        colour = obstacle_colour(level.affordances[k])
        note = {"xy": at[:2], "ha": "center", "va": "center", "fontsize": 6.5, "color": colour}
        box = {"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.7}
        axes.annotate(text, **note, bbox=box, zorder=8)


def _legend(affordances: set[str]) -> list[Any]:
    from matplotlib.lines import Line2D

    lines = [
        Line2D(
            [],
            [],
            color="#2a9d8f",
            lw=0.8,
            marker="o",
            mfc="none",
            ms=9,
            label=f"graph: discs above {_SHOWN} m",
        ),
        Line2D([], [], color="#7f7f7f", ls=":", marker=".", label="A* path through the discs"),
        Line2D([], [], color="#1f77b4", ls="--", label="pulled path"),
        Line2D([], [], color="#d62728", lw=2.2, label="smoothed path"),
        Line2D([], [], color="black", lw=0.9, label="where the figure went"),
    ]
    shown = in_order(affordances)
    return lines + [Line2D([], [], color=obstacle_colour(name), lw=3, label=name) for name in shown]
