"""Time and memory of builds against the size of the level, as `benchmarks.navmesh_scale` measured them."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import matplotlib
from matplotlib.figure import Figure

__all__ = ["draw_growth"]

ALLOWED = 1.15
"""Times the area: as much as time and memory may grow, from the smallest level on."""
_TIMES = (("build_ms", "without obstacles", "o-"), ("obstacles_ms", "with obstacles", "s-"),
          ("two_threads_ms", "two threads", "^--"), ("recast_ms", "Recast", "x-"))  # fmt: skip
_MEMORY = (
    ("peak_mb", "most while building", "o-"),
    ("held_mb", "held by the graph", "s-"),
    ("file_mb", "file", "^--"),
)


def draw_growth(report: Mapping[str, Mapping[str, Any]], path: Path) -> None:
    """Write a picture of the ``report``, figures by level, to ``path``; levels of one kind make a line."""
    kinds: dict[str, list[Mapping[str, Any]]] = {}
    for name, figures in report.items():
        kinds.setdefault(name.split()[0], []).append(figures)
    with matplotlib.rc_context({"font.size": 9}):
        figure = Figure(figsize=(9.0, 4.2), layout="constrained")
        for axes, lines, scale, label in zip(
            figure.subplots(1, 2), (_TIMES, _MEMORY), (1e-3, 1.0), ("time [s]", "memory [MB]"), strict=True
        ):
            for kind, levels in kinds.items():
                levels.sort(key=lambda each: each["km2"])
                area = [each["km2"] for each in levels]
                for key, name, style in lines:
                    if all(key in each for each in levels):
                        axes.plot(
                            area, [scale * each[key] for each in levels], style, label=f"{kind}: {name}"
                        )
                first = scale * levels[0][lines[0][0]]
                most = [first, first * ALLOWED * area[-1] / area[0]]
                axes.plot([area[0], area[-1]], most, ":", color="gray", label=f"{kind}: {ALLOWED} x area")
            axes.set(xscale="log", yscale="log", xlabel="area [km²]", ylabel=label)
            axes.grid(alpha=0.3)
            axes.legend(fontsize=7)
        figure.savefig(path, dpi=110)
