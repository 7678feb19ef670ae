"""The paths on which people learn to run are run."""

from collections import Counter

import numpy as np

from locomotion.training.gaits.path_trial import draw_path
from locomotion.training.gaits.run_curriculum import WAYS
from tests.locomotion.training.tiny import ticks_by_gait


def test_paths_on_which_people_learn_to_run_are_run() -> None:
    ways = [kind for kind in WAYS if "length" in kind]
    gaits = sum((ticks_by_gait(draw_path(np.random.default_rng(3), **kind)) for kind in ways), Counter())
    assert set(gaits) == {"walking", "running"}
    assert gaits["running"] > 0.6 * gaits.total()  # the first steps are walked
