"""Whoever is taken from the pool is as good as new, and of the size that was asked for."""

import numpy as np
import pytest

from runtime.bodies.human_pool import HumanPool
from runtime.planning.level import Level


@pytest.fixture
def pool(graph):
    return HumanPool(Level.of(graph), (), "planned", rehearsals=0, waits=True)


def test_one_that_was_put_back_is_as_good_as_new(pool):
    ada = pool.take(1.0)
    new = ada.state_hash()
    ada.reset((2.0, 3.0, 0.0), 0.5)
    ada.follow(np.array([(2.0, 3.0, 0.0), (6.0, 3.0, 0.0)]), 1.2)
    for _ in range(20):
        ada.tick()
    ada.bravery = 0.4
    assert ada.state_hash() != new
    pool.put_back(ada, 1.0)
    assert pool.take(0.9) is not ada
    again = pool.take(1.0)
    assert again is ada and again.state_hash() == new and again.bravery is None
    assert not again.events


def test_each_stands_on_the_ground_in_its_own_measure(pool, graph):
    level = Level.of(graph)
    assert pool.take(1.0).ground is level.ground
    assert pool.take(0.9).ground is level.ground_for(0.9)
    pool.put_back(pool.take(0.9), 0.9)
    pool.forget()
    assert pool.take(0.9).ground is level.ground_for(0.9)
