"""The head turns before the body."""

import numpy as np
import pytest

from locomotion.gaits.policy.skill import load_policy
from locomotion.human.human import Human


def head_and_pelvis(human):
    """Yaw of both, (2,) [rad]."""
    rows = [human.model.body(name).id for name in ("head", "pelvis")]
    ahead = human.data.xmat[rows].reshape(2, 3, 3)[:, :2, 0]
    return np.arctan2(ahead[:, 1], ahead[:, 0])


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_who_turns_on_the_spot_looks_there_first_and_ahead_again_when_it_walks(side):
    human = Human(None, clearing=(), rehearsals=0, policy=load_policy())
    human.reset((0.0, 0.0, 0.0), 0.0)
    human.follow([[0, 0, 0], [0, 8.0 * side, 0]], 1.2)
    for _ in range(50):
        human.tick()
    head, pelvis = side * head_and_pelvis(human)
    assert head > pelvis + 0.5, "after half a second"
    while human.arc_length < 5.0:
        human.tick()
    head, pelvis = head_and_pelvis(human)
    assert abs(head - pelvis) < 0.25


def test_who_walks_straight_on_looks_straight_ahead():
    human = Human(None, clearing=(), rehearsals=0, policy=load_policy())
    human.reset((0.0, 0.0, 0.0), 0.0)
    human.follow([[0, 0, 0], [12, 0, 0]], 1.2)
    off = []
    while human.arc_length < 8.0:
        human.tick()
        if human.arc_length > 2.0:
            off.append(head_and_pelvis(human)[0])
    assert np.abs(off).max() < 0.25
