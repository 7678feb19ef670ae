"""Getting up after a fall, as far as hands and feet."""

import math

import numpy as np

from locomotion import Ground, Human
from locomotion.body_events import Fell, GotUp
from tests.locomotion.recovery.falling import go_on, push_over


def test_gets_up_again_however_it_was_pushed_over():
    human, down = Human(None, clearing=(), gets_up=True), []
    for k in range(12):
        push_over(human, k * math.pi / 6, (1.2, 3.0)[k % 2])
        go_on(human, 5.0, Fell)
        if not any(isinstance(event, Fell) for event in human.events):
            continue
        go_on(human, 40.0, GotUp)
        up = [event for event in human.events if isinstance(event, GotUp)]
        down.append(up[0].seconds if up else math.inf)
        if up:
            assert human.data.xmat[human.index.chest].reshape(3, 3)[2, 2] > 0.7, "it stands"
    assert len(down) >= 8, "hard enough a push"
    assert max(down) < 40.0 and np.mean(np.array(down) <= 15.0) >= 0.75


def test_gets_up_where_a_level_with_steep_ground_is_level():
    """Hands and feet stick to what holds a body at 38 degrees; nobody came up from them."""
    corners = [[-40.0, -40.0, 0.0], [40.0, -40.0, 0.0], [40.0, 40.0, 0.0], [-40.0, 40.0, 0.0]]
    ground = Ground.from_arrays(corners, [[0, 1, 2], [0, 2, 3]], max_slope=math.radians(38.0))
    assert ground.steep
    human = Human(ground, clearing=(), gets_up=True)
    for direction in (0.0, 2.0, 4.0):
        push_over(human, direction, 3.0)
        go_on(human, 5.0, Fell)
        go_on(human, 40.0, GotUp)
        assert any(isinstance(event, GotUp) for event in human.events)
