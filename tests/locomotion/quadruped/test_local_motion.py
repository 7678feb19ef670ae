"""Short moves to any place nearby."""

import math

import numpy as np
import pytest

from locomotion import LocomotionError
from locomotion.quadruped import Herd, load_body, local_motion
from locomotion.quadruped.body_on_path import wrap
from locomotion.quadruped.local_motion import play_blends
from tests.locomotion.quadruped.dead_ends import DOG
from tests.locomotion.quadruped.scenes import animal_on, plane, run


@pytest.mark.parametrize("name", ["dog", "cat", "horse"])
def test_the_table_leads_where_it_says(name):
    table = local_motion(load_body(name))
    rng = np.random.default_rng(1)
    wanted = np.column_stack([rng.uniform(-0.7, 0.7, (200, 2)), rng.uniform(-math.pi, math.pi, 200)])
    weights = np.array([table.look_up(row) for row in wanted])
    miss = play_blends(table.body, weights)[-1] - wanted
    assert np.linalg.norm(miss[:, :2], axis=1).max() < 0.02
    assert np.abs(miss[:, 2]).max() < math.radians(2.0)


def test_a_short_move_ends_where_it_should_with_all_feet_in_place():
    herd = Herd(plane())
    index = herd.add(DOG, (1.0, 1.0, 0.0), 0.5)
    script = local_motion(DOG).script(herd.place(index), (-0.3, 0.4, -1.2))
    herd.play(index, script)
    while not herd.resting(index):
        herd.tick()
    feet = herd.toes(index)
    front, rear = feet[:2, :2].mean(axis=0), feet[2:, :2].mean(axis=0)
    goal = [1.0 - 0.3 * math.cos(0.5) - 0.4 * math.sin(0.5), 1.0 - 0.3 * math.sin(0.5) + 0.4 * math.cos(0.5)]
    assert np.linalg.norm(rear - goal) < 0.02
    assert abs(wrap(math.atan2(*(front - rear)[::-1]) + 0.7)) < math.radians(2.0)


def test_near_goals_are_reached_by_local_motion():
    animal = animal_on(plane())
    animal.go_to((0.5, 0.3, 0.0), facing=0.4)
    assert animal.trail is None and animal.status == "running"
    run(animal)
    assert animal.status == "arrived"
    assert np.linalg.norm(animal.front[:2] - [0.5, 0.3]) < 0.02 and animal.yaw == pytest.approx(0.4, abs=0.02)


def test_out_of_reach_is_refused():
    with pytest.raises(LocomotionError, match="outside of local motion's reach"):
        local_motion(DOG).look_up((2.0, 0.0, 0.0))
    with pytest.raises(LocomotionError, match="finite"):
        local_motion(DOG).look_up((0.0, math.nan, 0.0))
