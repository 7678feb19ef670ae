"""Learning to walk: its paths, its cost, its tables."""

import numpy as np
import pytest

from locomotion.gaits.walk.layout import GAINS, gain_limits
from locomotion.gaits.walk.skill import TABLES, load_walk_skill
from locomotion.training.gaits.walk import KINDS as WALKS
from locomotion.training.gaits.walk import WalkProblem, draw_walk, walk_curriculum, walk_tables
from locomotion.training.training import Training
from tests.locomotion.training.tiny import ticks_by_gait


@pytest.mark.parametrize("kind", WALKS)
def test_paths_on_which_people_learn_to_walk_are_walked(kind: str) -> None:
    path = draw_walk(np.random.default_rng(3), WALKS[kind])
    assert set(ticks_by_gait(path)) - {"arrived"} == {"walking"}


def test_learning_prefers_gains_that_stay_up():
    stage = walk_curriculum(Training(effort=0.1))[0]
    rest = np.zeros((TABLES - 1) * len(GAINS))
    good = np.concatenate([load_walk_skill().tables[0], rest])
    bad = np.concatenate([gain_limits()[0], rest])
    problem = WalkProblem((stage,), good)
    drawn = problem.scenarios(stage, 0, np.random.default_rng(0))[:1]
    cost, covered = problem.evaluate(stage, good, drawn)
    more, less = problem.evaluate(stage, bad, drawn)
    assert cost < more and covered > less


def test_gains_for_steep_ground_are_changes_cut_at_the_limits():
    low, high = gain_limits()
    wide, level = high - low, low + 0.25 * (high - low)
    tables, outside = walk_tables(np.concatenate([level, wide, -wide, 0.25 * wide, 0.5 * wide]))
    assert np.allclose(tables, [level, high, level, low + 0.5 * wide, low + 0.75 * wide])
    assert outside == pytest.approx(0.25 * len(GAINS))
