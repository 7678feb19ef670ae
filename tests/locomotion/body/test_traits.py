"""Traits in which people differ."""

import numpy as np
import pytest

from locomotion.body.traits import PHASE, SIZE, TRAITS, by_chance, by_hand, chance_at
from locomotion.errors import LocomotionError


def test_ten_side_by_side_are_not_in_step():
    traits = np.array([by_chance(seed) for seed in range(10)])
    assert np.array_equal(by_chance(3), traits[3])
    assert len(np.unique(traits[:, PHASE].round(3))) == 10
    assert traits[0].nbytes <= 2048
    for name, column in zip(TRAITS, traits.T, strict=True):
        assert (column >= TRAITS[name][1]).all() and (column <= TRAITS[name][2]).all()


def test_traits_by_hand_are_checked():
    assert by_hand(size=1.1)[SIZE] == 1.1
    with pytest.raises(LocomotionError, match="trait 'limp': valid: phase"):
        by_hand(limp=1.0)
    with pytest.raises(LocomotionError, match=r"size is 3.0, expected a number from 0.8 to 1.2"):
        by_hand(size=3.0)


def test_chance_goes_by_seed_and_place_to_the_millimetre():
    place = np.array([1.0, -2.0, 0.5])
    drawn = chance_at(place, 3).random()
    assert chance_at(place + 2e-4, 3).random() == drawn
    assert chance_at(place + 1e-3, 3).random() != drawn != chance_at(place, 4).random()
