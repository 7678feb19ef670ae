"""Posture graphs in small numbers."""

from pathlib import Path

import numpy as np

from benchmarks.posture_graphs import fatal_figures, request_figures, unequal
from locomotion.data import POSTURES
from locomotion.postures.posture_file import load_postures


def test_nothing_jumps_and_the_quickest_way_is_taken():
    rng, graph = np.random.default_rng(9), load_postures(Path(POSTURES) / "person.yaml")
    assert unequal(20, rng) == 0
    joint, root = request_figures(graph, 15, rng)
    assert 0.5 < joint < 5.0 and root < 0.05
    missed, worst = fatal_figures(graph, 15, rng)
    assert missed == 0 and worst < 5.0
