"""What becomes of a person that falls, from losing its balance until it goes on."""

import pytest

from locomotion import Ground, Human
from locomotion.body_events import Arrived, Fell, GotUp, LostGround
from locomotion.human.human import STRAYED
from tests.locomotion.recovery.falling import WAY, go_on, push_over


def test_goes_on_to_its_goal_after_a_fall():
    human, arrived = Human(None, clearing=(), gets_up=True), 0
    for direction in (0.5, 2.2, 4.0, 5.5):
        push_over(human, direction, 1.2)
        go_on(human, 90.0)
        assert any(isinstance(event, Fell) for event in human.events)
        arrived += isinstance(human.events[-1], Arrived)
    assert arrived >= 3


def test_who_gets_up_beside_its_path_is_not_lost_before_it_can_be_told_another():
    human = Human(None, clearing=(), gets_up=True)
    push_over(human, 2.2, 1.2)
    go_on(human, 5.0, Fell)
    human.data.qpos[1] += 2.0 * STRAYED
    go_on(human, 40.0, GotUp)
    assert isinstance(human.events[-1], GotUp) and human.status == "walking"
    assert abs(human.lateral_error) > STRAYED


def test_without_that_a_fall_is_the_end():
    human = Human(None, clearing=())
    push_over(human, 1.6, 1.2)
    go_on(human, 10.0)
    for _ in range(150):
        human.tick()
    assert human.status == "fallen" and human.held


@pytest.mark.parametrize("gets_up", [True, False])
def test_who_falls_off_the_level_is_told_once(gets_up):
    corners = [[-3.0, -3.0, 0.0], [3.0, -3.0, 0.0], [3.0, 3.0, 0.0], [-3.0, 3.0, 0.0]]
    human = Human(Ground.from_arrays(corners, [[0, 1, 2], [0, 2, 3]]), clearing=(), gets_up=gets_up)
    human.reset((0.0, 0.0, 0.0), 0.0)
    human.follow(WAY, 1.2)
    go_on(human, 20.0)
    assert human.status == "fallen" and human.position[2] > -10.0, "soon"
    for _ in range(150):
        human.tick()
    assert human.held
    told = [type(event) for event in human.events]
    assert told[1:] == ([Fell, LostGround] if gets_up else [Fell])
    if gets_up:
        assert human.events[-1].reason == "it has fallen off the level"


def test_who_has_not_got_up_after_two_minutes_stays_down():
    human = Human(None, clearing=(), gets_up=True)
    push_over(human, 1.6, 1.2)
    go_on(human, 5.0, Fell)
    human.fours.fell_at -= 12000.0
    for _ in range(200):
        human.tick()
    assert human.status == "fallen" and human.held
    human.reset((0.0, 0.0, 0.0), 0.0)
    assert human.status == "standing" and not human.fours.active
