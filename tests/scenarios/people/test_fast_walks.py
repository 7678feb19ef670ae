"""Walks faster than usual: who is told to goes so, and comes to rest; where the capture point is foreseen."""

import math

import numpy as np
import pytest

from locomotion import Human
from locomotion.body.anatomy import MASS
from locomotion.gaits.run.layout import COM_VELOCITY
from locomotion.gaits.walk.controller import legs_momentum
from locomotion.gaits.walk.layout import CLOCK, DOUBLE, PHASE, SEEN_PELVIS, SEEN_SOLES, SINGLE, WALK_STANCE
from locomotion.human.state import MOVING

WAY = 30.0


@pytest.mark.parametrize(("told", "least"), [(1.25, 1.2), (1.5, 1.4), (1.75, 1.5), (2.0, 1.6)])
def test_who_is_told_to_walk_fast_does_and_comes_to_rest(told, least):
    for start in (0.0, 0.1, 0.2):
        human = Human(None, clearing=())
        human.reset((start, 0, 0), 0.0)
        human.follow([[start, 0, 0], [WAY, 0, 0]], told)
        begun = ended = math.nan
        while human.status in MOVING and human.time < 60.0:
            human.tick()
            assert human.gait_now == "walk"
            if human.com[0] > 10.0 and math.isnan(begun):
                begun = human.time
            if human.com[0] > 25.0 and math.isnan(ended):
                ended = human.time
        assert human.status == "arrived"
        assert least < 15.0 / (ended - begun) < told + 0.1
        while not human.held and human.status == "arrived" and human.time < 90.0:
            human.tick()
        assert human.status == "arrived" and human.held


def test_without_the_legs_momentum_the_capture_point_is_foreseen_where_it_will_be_at_touchdown():
    """In the middle of a swing the body is faster than it lands, by what the leg takes up that is thrown
    ahead."""
    human = Human(None, clearing=())
    human.reset((0, 0, 0), 0.0)
    human.follow([[0, 0, 0], [WAY, 0, 0]], 1.25)
    foreseen, errors = [], []
    while human.time < 10.0:
        human.tick()
        walk, (x, _, height), speed = human.on_feet.walk, human.com, human.control[COM_VELOCITY.start]
        omega = math.sqrt(9.81 / height)
        capture = x + speed / omega
        if walk[PHASE] == SINGLE and walk[CLOCK] > 0.1:
            stance = SEEN_SOLES.start + (3 if walk[WALK_STANCE] > 0.0 else 0)
            momentum = legs_momentum(walk[SEEN_PELVIS], speed, human.data.qpos, human.data.qvel)
            less = capture - momentum / (MASS * height * omega)
            foreseen.append((human.time, omega, walk[stance], capture, less))
        elif walk[PHASE] == DOUBLE and walk[CLOCK] == 0.0:
            for time, rate, foot, plain, corrected in foreseen if human.time > 4.0 else ():
                growth = math.exp(rate * (human.time - time))
                errors.append([foot + growth * (at - foot) - capture for at in (plain, corrected)])
            foreseen = []
    plain, corrected = np.abs(errors).mean(axis=0)
    assert len(errors) > 150 and plain > 0.08 and corrected < 0.5 * plain
