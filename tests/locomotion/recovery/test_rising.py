"""From hands and feet to a stand that holds."""

import math

import numpy as np
import pytest

from locomotion import Human
from locomotion.body_events import Fell, GotUp
from tests.locomotion.recovery.falling import go_on, plane


@pytest.mark.parametrize("slope", [0.5, 0.7])
def test_who_has_got_up_on_a_slope_does_not_fall_again_at_once(slope):
    human, rng, again, up = Human(plane(slope), clearing=(), gets_up=True), np.random.default_rng(3), 0, 0
    for k in range(10):
        way = 2.0 * math.pi * k / 10.0
        ahead = np.linspace(0.0, 12.0, 40)[:, None] * np.array([math.cos(way), math.sin(way), 0.0])
        ahead[:, 2] = slope * ahead[:, 0]
        human.events.clear()
        human.reset((0, 0, 0), way)
        human.follow(ahead, 1.0)
        human.data.qvel[:3] += 2.5 * rng.normal(size=3)
        human.data.qvel[3:6] += 5.0 * rng.normal(size=3)
        go_on(human, 2.0, Fell)
        if not any(isinstance(event, Fell) for event in human.events):
            continue
        go_on(human, 40.0, GotUp)
        fell = len(human.events)
        up += isinstance(human.events[-1], GotUp)
        go_on(human, 2.0)
        again += any(isinstance(event, Fell) for event in human.events[fell:])
    assert up >= 5, "hard enough a push"
    assert again <= 1
