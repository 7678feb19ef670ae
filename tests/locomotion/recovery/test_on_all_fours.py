"""A person that gets up after a fall, and one that goes on hands and feet where it is too steep to walk."""

import math

import numpy as np

from locomotion import Human
from locomotion.body.arm_reach import HAND_RADIUS
from locomotion.body_events import Fell
from tests.locomotion.recovery.falling import go_on, push_over


def test_hands_and_forearms_do_not_sink_into_the_ground_in_a_fall():
    human = Human(None, clearing=(), gets_up=True)
    names = [f"{side}_{part}" for side in ("right", "left") for part in ("hand", "forearm")]
    arms = [human.index.bodies[name] for name in names]
    for direction in (0.0, math.pi, 5.0 * math.pi / 3.0):
        push_over(human, direction, 3.0)
        go_on(human, 5.0, Fell)
        deepest = 0.0
        for _ in range(200):
            human.tick()
            contact = human.data.contact
            of_arms = np.isin(human.model.geom_bodyid[contact.geom.max(axis=1)], arms)
            deepest = min(deepest, contact.dist[of_arms].min(initial=0.0))
        assert -HAND_RADIUS < deepest < -0.005, "it has put them down"


def test_a_saved_person_gets_up_in_the_same_way():
    human, twin = Human(None, clearing=(), gets_up=True), Human(None, clearing=(), gets_up=True)
    push_over(human, 2.5, 1.2)
    go_on(human, 5.0, Fell)
    for _ in range(300):
        human.tick()
    assert human.status == "getting up" and human.gait_now == "scramble"
    twin.restore_state(human.save_state())
    for _ in range(400):
        human.tick()
        twin.tick()
    assert twin.state_hash() == human.state_hash()
