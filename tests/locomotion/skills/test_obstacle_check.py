"""Obstacles that cannot be, or that no skill clears, are refused."""

from dataclasses import replace

import numpy as np
import pytest

from locomotion.errors import LocomotionError
from locomotion.human.human import Human
from locomotion.paths.smoothing import ObstacleAhead
from tests.locomotion.human.people import STRAIGHT


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"arc_length": np.nan}, "arc_length must be a finite number of metres, not nan"),
        ({"height": None}, "height must be a finite number of metres, not None"),
        ({"depth": np.inf}, "depth must be a finite number of metres, not inf"),
        ({"affordance": "climb"}, "affordance 'climb': valid: 'jump', 'vault', 'drop', 'gap'"),
        ({"position": np.array([8.0, np.nan, 0.4])}, "position must be three finite numbers"),
        ({"position": (8.0, 0.0)}, "position must be three finite numbers"),
        ({"normal": None}, "normal must be three finite numbers, not None"),
        ({"normal": np.zeros(3)}, "normal must be horizontal and 1 long"),
    ],
)
def test_an_obstacle_with_a_mistake_is_refused_by_field(wrong, message):
    human = Human(None)
    before = human.state_hash()
    right = ObstacleAhead(8.0, "jump", 0.4, np.array([8.0, 0, 0.4]), np.array([-1.0, 0, 0]))
    with pytest.raises(LocomotionError, match=f"obstacle 1: {message}"):
        human.follow(STRAIGHT, 3.0, [right, replace(right, **wrong)])
    assert human.state_hash() == before and not human.events


def test_obstacles_out_of_order_are_refused():
    near = ObstacleAhead(8.0, "jump", 0.4, np.array([8.0, 0, 0.4]), np.array([-1.0, 0, 0]))
    with pytest.raises(LocomotionError, match="obstacle 1 is at 8 m, the one before it at 12 m"):
        Human(None).follow(STRAIGHT, 3.0, [replace(near, arc_length=12.0), near])
