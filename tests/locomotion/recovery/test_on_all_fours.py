"""A person that gets up after a fall, and one that goes on hands and feet where it is too steep to walk."""

import math

import numpy as np

from locomotion import Ground, Human
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


def test_it_begins_to_stand_up_only_where_the_ground_around_it_is_gentle_as_well_as_its_way():
    corners = [[x, y, 0.8 * max(x, 0.0)] for x in (-20.0, 0.0, 20.0) for y in (-20.0, 20.0)]
    faces = [[k, k + 2, k + 3] for k in (0, 2)] + [[k, k + 3, k + 1] for k in (0, 2)]
    ground = Ground.from_arrays(corners, faces, max_slope=math.atan(0.8))
    human = Human(ground, clearing=(), gets_up=True)
    human.reset((-4.0, 0.0, 0.0), math.pi)
    human.follow([[-4.0, 0.0, 0.0], [-14.0, 0.0, 0.0]], 1.2)
    gentle = []
    for x in (4.0, 1.0, -1.0, -4.0, -1.0):  # there is no going back once it has begun
        human.fours.look(ground, np.array([x, 0.0, 0.8 * max(x, 0.0)]), human.follower)
        gentle.append(human.fours.gentle)
    assert gentle == [0.0, 0.0, 0.0, 1.0, 1.0]
