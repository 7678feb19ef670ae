"""A picture of how reliable odds are: what was said against what came of it."""

import os
from collections.abc import Mapping, Sequence

from runtime.evaluation.preconditions import Bin
from surefoot.files.atomic_write import whole_file

__all__ = ["plot_reliability"]

_SIZE = (3.6, 3.8)  # [in] of the picture of a skill


def plot_reliability(skills: Mapping[str, Sequence[Bin]], path: str | os.PathLike[str]) -> None:
    """Write the picture (PNG) to ``path``, whole or not at all: a diagram for each skill. There has to be
    one."""
    from matplotlib.figure import Figure

    width, height = _SIZE
    figure = Figure(figsize=(width * len(skills), height), dpi=100, layout="constrained")
    for axes, (skill, bins) in zip(
        figure.subplots(1, len(skills), squeeze=False)[0], skills.items(), strict=True
    ):
        most = max(each.count for each in bins)
        axes.plot([0, 1], [0, 1], color="#999999", linewidth=1)
        axes.plot([each.odds for each in bins], [each.held for each in bins], color="#2a9d8f", linewidth=1)
        sizes = [12.0 + 120.0 * each.count / most for each in bins]
        axes.scatter(
            [each.odds for each in bins], [each.held for each in bins], s=sizes, color="#2a9d8f", zorder=3
        )
        axes.set(xlim=(0, 1), ylim=(0, 1), xlabel="odds", ylabel="share that holds", title=skill)
        axes.set_aspect("equal")
    with whole_file(path) as temporary:
        figure.savefig(temporary, format="png")
