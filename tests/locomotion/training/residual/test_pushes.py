"""Pushes of people who learn."""

import numpy as np
import pytest

from locomotion import Human
from locomotion.training.residual.pushes import Pushes


@pytest.fixture(scope="module")
def people():
    return [Human(None, clearing=(), rehearsals=0) for _ in range(2)]


def test_a_push_lasts_a_tenth_of_a_second(people):
    pushes, waist = Pushes(people), people[0].model.body("waist").id
    pushes.draw(0, np.random.default_rng(3), 1.0, 200.0, (10, 20))
    begins, force = int(pushes.begins[0]), float(np.linalg.norm(pushes.force[0]))
    assert 10 <= begins < 20 and 40.0 <= force <= 200.0
    pushed = []
    for decision in range(40):
        pushes.apply(0, decision)
        applied = people[0].data.xfrc_applied
        assert not np.delete(applied, waist, axis=0).any()
        pushed.append(bool(applied[waist].any()))
    assert np.flatnonzero(pushed).tolist() == list(range(begins, begins + 5))
    assert not people[1].data.xfrc_applied.any()


def test_who_is_not_drawn_is_not_pushed(people):
    pushes, rng = Pushes(people), np.random.default_rng(4)
    for _ in range(50):
        pushes.draw(1, rng, 0.0, 200.0, (0, 20))
        for decision in range(25):
            pushes.apply(1, decision)
            assert not people[1].data.xfrc_applied.any()


def test_who_begins_anew_is_pushed_no_longer(people):
    pushes, rng = Pushes(people), np.random.default_rng(5)
    pushes.draw(0, rng, 1.0, 200.0, (0, 1))
    pushes.apply(0, 0)
    assert people[0].data.xfrc_applied.any()
    pushes.draw(0, rng, 1.0, 200.0, (5, 6))
    assert not people[0].data.xfrc_applied.any()
