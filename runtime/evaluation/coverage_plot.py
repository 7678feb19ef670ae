"""A picture of what a skill covers: every trial at its place in the plane of what was tried."""

import os
from collections.abc import Sequence

from runtime.evaluation.evaluation import Attempt
from surefoot.files.atomic_write import whole_file

__all__ = ["plot_coverage"]

_SIZE = (6.0, 4.5)  # [in] of the picture of a test


def plot_coverage(skill: str, attempts: Sequence[Attempt], path: str | os.PathLike[str]) -> None:
    """Write the picture (PNG) to ``path``, whole or not at all: one plane for each test of two coordinates.
    There has to be one."""
    from matplotlib.figure import Figure

    tests = {
        test: [each for each in attempts if each.test == test]
        for test in dict.fromkeys(each.test for each in attempts if len(each.at) == 2)
    }
    width, height = _SIZE
    figure = Figure(figsize=(width * len(tests), height), dpi=100, layout="constrained")
    for axes, (test, tried) in zip(
        figure.subplots(1, len(tests), squeeze=False)[0], tests.items(), strict=True
    ):
        across, up = tried[0].at
        for held, colour, marker in ((True, "#2a9d8f", "o"), (False, "#d1495b", "x")):
            those = [each for each in tried if each.held is held]
            label = f"{'holds' if held else 'does not'}: {len(those)}"
            axes.scatter(
                [each.at[across] for each in those], [each.at[up] for each in those],
                c=colour, marker=marker, s=22, label=label,
            )  # fmt: skip
        axes.set(xlabel=across, ylabel=up, title=f"{skill}: {test}")
        axes.legend(loc="upper left", fontsize=8)
    with whole_file(path) as temporary:
        figure.savefig(temporary, format="png")
