"""What a person can be told at any moment."""

import numpy as np
import pytest

from locomotion.errors import LocomotionError
from locomotion.human.human import Human
from locomotion.paths.smoothing import ObstacleAhead
from tests.locomotion.human.people import STRAIGHT, Recorder, finish


def test_stopped_anywhere_it_stands_and_when_told_again_goes_on_to_its_goal():
    human, goal = Human(None, clearing=()), (13.0, 2.0, 0.0)
    for seconds in np.arange(0.7, 2.25, 0.1):
        human.reset((2.0, 2.0, 0.0), 0.0)
        human.follow([(2.0, 2.0, 0.0), goal], 1.5)
        for _ in range(round(100 * seconds)):
            human.tick()
        human.stop()
        for _ in range(600):
            human.tick()
        assert human.status == "standing"
        human.follow([human.position, goal], 1.5)
        finish(human, human.time + 30.0)
        assert human.status == "arrived", seconds


def test_person_that_is_told_to_go_elsewhere_in_the_middle_of_a_skill_runs_on():
    human = Human(None, clearing=[Recorder()])
    human.reset((0, 0, 0), 0.0, speed=3.0)
    obstacle = ObstacleAhead(10.0, "jump", 0.4, np.array([10.0, 0, 0.4]), np.array([-1.0, 0, 0]))
    human.follow([[0, 0, 0], [25, 0, 0]], 3.0, [obstacle])
    while human.status != "jumping":
        assert human.time < 10.0
        human.tick()
    human.follow([human.position, [25, 0, 0]], 3.0)
    assert human.status == "running"


def test_fallen_person_must_be_reset():
    human = Human(None)
    human.reset((3, 1, 0), 0.0)
    assert human.status == "standing" and human.held
    human.follow([[3, 1, 0], [3, 20, 0]], 3.0)
    human.data.qvel[:3] = [0, -6.0, 0]
    for _ in range(300):
        human.tick()
    assert human.status == "fallen" and human.events[-1].slope == 0.0
    with pytest.raises(LocomotionError, match="has fallen"):
        human.follow(STRAIGHT, 3.0)
    human.reset((0, 0, 0), 0.0)
    assert human.status == "standing"
