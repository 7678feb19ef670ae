"""Whoever comes to rest, or has to make a step, is where another policy begins."""

from dataclasses import replace

import numpy as np

from locomotion.gaits.policy.layout import ACTIONS, RESTED, RUNNING
from locomotion.training.policies.curriculum import STANDING, WALKING
from locomotion.training.policies.endings import where_it_ended
from locomotion.training.policies.environment import Environment


def decides_nothing(seen):
    return np.zeros((len(seen), ACTIONS))


def test_who_could_stand_steps_on_while_the_walk_is_learned(reference):
    stage = replace(WALKING[2], speeds=(0.0, 0.0), stand=1.0, push=0.0, longest=200)
    environment = Environment(reference, stage, 40, seed=0)
    environment.memory[:, RESTED] = 1.0
    found = where_it_ended(environment, decides_nothing, most=14)
    assert found is not None
    assert (found.memory[:, RUNNING] == 0.0).all()
    assert (environment.memory[:, RUNNING] == 1.0).all()
    standing = Environment(reference, STANDING[0], 40, seed=0, starts=found)
    taken = (standing.physics[:, None] == found.physics[None]).all(axis=2).any(axis=1)
    assert 0.3 < taken.mean() < 1.0
