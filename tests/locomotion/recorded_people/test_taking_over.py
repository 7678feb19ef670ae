"""Recorded motion goes on from another body in the phase that is most like it, and without a jump."""

import numpy as np

from locomotion.recorded_people import layout as at
from locomotion.recorded_people.taking_over import go_on_from
from tests.locomotion.recorded_people.test_people import crowd_of, played


def test_one_who_takes_over_from_one_like_it_is_in_its_phase():
    people, (ada, bob) = crowd_of(2)
    ada.go_to([(9.0, 5.0, 0.0)], 1.4, None)
    played(people, ada, 2.0)
    people.rows[bob.index, at.TRAITS] = people.rows[ada.index, at.TRAITS]
    pose, rates, place = ada.qpos, ada.qpos_rates, ada.position
    go_on_from(bob, people, pose, rates, place, ada.walker.velocity)
    np.testing.assert_allclose(bob.qpos, pose, atol=1e-9)
    apart = (people.rows[bob.index, at.PHASE] - people.rows[ada.index, at.PHASE] + 0.5) % 1.0 - 0.5
    assert abs(apart) < 0.12


def test_one_who_takes_over_from_a_slow_runner_runs():
    people, (ada, bob) = crowd_of(2)
    ada.go_to([(18.0, 5.0, 0.0)], 3.5, None)
    played(people, ada, 2.5)
    ada.walker.stop()
    while people.rows[ada.index, at.SPEED] > 2.1:  # a speed at which others walk
        people.tick()
    run = people.rows[ada.index, at.GAIT]
    assert people.gaits[int(run)].name == "run"
    go_on_from(bob, people, ada.qpos, ada.qpos_rates, ada.position, ada.walker.velocity)
    assert people.rows[bob.index, at.GAIT] == run
