"""What odds of a change are asked of."""

import numpy as np
import pytest

from locomotion import Human
from locomotion.preconditions.changes import CHANGE_FEATURES, changing, describe_change


def running(beside):
    human = Human(rehearsals=0)
    human.reset((0.0, beside, 0.0), 0.0, 3.0)
    human.follow([[0.0, 0.0, 0.0], [30.0, 0.0, 0.0]], 3.0)
    return human


def test_each_choice_has_a_row_and_only_that_differs():
    human = running(0.0)
    human.tick()
    choices = np.array([[1.0, 0.0], [2.0, 0.5]])
    rows = describe_change(changing(human, 3.2, 0.8), choices)
    assert rows.shape == (2, len(CHANGE_FEATURES)) and np.isfinite(rows).all()
    assert (rows[:, :2] == choices).all() and (rows[0, 2:] == rows[1, 2:]).all()
    told = dict(zip(CHANGE_FEATURES, rows[0], strict=True))
    assert (told["grip"], told["asked speed"]) == (0.8, 3.2)
    assert told["speed ahead"] == pytest.approx(human.velocity[0], abs=0.01) and told["upright"] > 0.9
    assert 0.7 < told["height"] < 1.2 and abs(told["face down"]) < 0.4


def test_mirror_images_have_the_same_features():
    human = running(0.3)
    human.tick()
    body, choice = changing(human, 0.0, 0.9), np.zeros((1, 2))
    other = _mirrored(body)
    np.testing.assert_allclose(describe_change(body, choice), describe_change(other, choice), atol=1e-12)


def _mirrored(body):
    from locomotion.gaits.run import layout

    state, plan, qpos, qvel = (each.copy() for each in (body.state, body.plan, body.qpos, body.qvel))
    for at in (layout.COM, layout.COM_VELOCITY):
        state[at][1] *= -1.0
    feet = state[layout.FEET].reshape(2, 3)
    state[layout.FEET] = (feet[::-1] * (1.0, -1.0, 1.0)).ravel()
    plan[1:3] *= -1.0
    qpos[[1, 4, 6]] *= -1.0
    qvel[[1, 3, 5]] *= -1.0
    return body._replace(state=state, plan=plan, beside=-body.beside, qpos=qpos, qvel=qvel)
