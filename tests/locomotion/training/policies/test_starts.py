"""Some who learn begin in states that are given."""

from dataclasses import replace

import numpy as np

from locomotion.training.policies.curriculum import WALKING
from locomotion.training.policies.environment import Environment
from locomotion.training.policies.starts import Starts


def test_as_many_as_asked_begin_in_one_of_the_states_memory_and_body(reference):
    stage = replace(WALKING[1], from_starts=0.4)
    given = Environment(reference, stage, 3, seed=5)
    starts = Starts(given.memory, given.physics, given.sensed)
    begun = Environment(reference, stage, 200, seed=0, starts=starts)
    same = [
        (getattr(begun, name)[:, None] == values[None]).all(axis=2) for name, values in vars(starts).items()
    ]
    taken = np.logical_and.reduce(same)
    assert 0.3 < taken.any(axis=1).mean() < 0.5
    assert taken.any(axis=0).all()
