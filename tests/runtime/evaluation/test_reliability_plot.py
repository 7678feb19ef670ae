"""The reliability diagram has a picture for each skill."""

import matplotlib.image

from runtime.evaluation.preconditions import Bin
from runtime.evaluation.reliability_plot import plot_reliability


def test_each_skill_has_its_diagram(tmp_path):
    bins = [Bin(10, 0.1, 0.2), Bin(40, 0.5, 0.45), Bin(90, 0.93, 0.95)]
    plot_reliability({"jump": bins}, tmp_path / "one.png")
    plot_reliability({"jump": bins, "vault": bins[:1]}, tmp_path / "two.png")
    one, two = (matplotlib.image.imread(tmp_path / f"{name}.png") for name in ("one", "two"))
    assert two.shape[1] == 2 * one.shape[1] and two.std() > 0.05
