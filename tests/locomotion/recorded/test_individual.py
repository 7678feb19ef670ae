"""Figures that differ, from one shared set of motions."""

import numpy as np
import pytest

from locomotion.body.traits import LEAN, PACE, by_chance, by_hand
from locomotion.recorded.footfalls import FEET, sole_centres
from locomotion.recorded.individual import pace_of, scaled, styled
from locomotion.recorded.motion_set import load_motions
from locomotion.recorded.posing import posed
from locomotion.recorded.sampling import sample_gait
from locomotion.recorded.skeletons import FULL, skeleton

MOTIONS = load_motions()


@pytest.mark.parametrize("seed", [1, 2, 7])
def test_feet_of_any_figure_stand_still(seed):
    """Over level ground, with nothing planted: the slide of one that has its own size and pace."""
    traits, walk, speed = by_chance(seed)[None], MOTIONS.gait("walk"), 1.2
    read, strides = pace_of(MOTIONS, [walk], [speed], traits)
    shares = np.linspace(0.1, 0.4, 30)
    rows = np.repeat(traits, 30, axis=0)
    sample = sample_gait(MOTIONS, FULL, np.full(30, walk), np.full(30, read[0]), shares)
    full = skeleton("full")
    places = scaled(posed(full, *styled(full, sample, rows)), rows)
    feet = places[:, full.bodies.index(FEET[0])]
    feet[:, 0] += strides[0] * shares
    assert np.ptp(sole_centres(feet)[0][:, 0]) < 0.02


def test_who_has_more_pace_takes_longer_and_fewer_strides():
    walk = MOTIONS.gait("walk")
    traits = np.array([by_hand(pace=0.85), by_hand(pace=1.2)])
    _, strides = pace_of(MOTIONS, [walk, walk], [1.2, 1.2], traits)
    assert strides[1] > 1.05 * strides[0]


def test_usual_traits_change_nothing():
    traits, full = np.array([by_hand(lean=0.0)]), skeleton("full")
    sample = sample_gait(MOTIONS, FULL, [MOTIONS.gait("walk")], [1.2], [0.2])
    assert np.allclose(styled(full, sample, traits)[0], sample[0])
    assert traits[0, PACE] == 1.0 and traits[0, LEAN] == 0.0
