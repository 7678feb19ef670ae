"""States of several kinds in which some who learn begin."""

import numpy as np

from locomotion.training.policies.starts import Starts, together


def test_states_of_two_kinds_are_as_many_of_each():
    few, many = (Starts(*(np.full((n, k), float(n)) for k in (2, 3, 4))) for n in (3, 7))
    both = together(few, many)
    assert [values.shape for values in vars(both).values()] == [(14, 2), (14, 3), (14, 4)]
    assert (both.memory[:, 0] == 3.0).sum() == (both.sensed[:, 0] == 7.0).sum() == 7
    assert together(many, None) is many
