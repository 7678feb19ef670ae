"""What an animal does with its orders."""

import math

import numpy as np
import pytest

from locomotion import Ground, LocomotionError
from locomotion.body_events import Arrived, BackedOut, MissedGoal, SetOff
from locomotion.quadruped import Animal, Herd
from locomotion.quadruped.body_on_path import wrap
from tests.locomotion.quadruped.dead_ends import DOG, GraphPlanner, dead_end
from tests.locomotion.quadruped.scenes import animal_on, floor, plane, quads, run, wall


@pytest.mark.parametrize(
    ("speed", "far"), [(1.0, 3.0), (2.2, 6.0), (4.5, 14.0)], ids=["walk", "trot", "gallop"]
)
def test_stops_at_the_goal_facing_as_told(speed, far):
    for turn in (-0.8, 0.0, 0.6):
        animal = animal_on(plane(), yaw=0.3)
        animal.go_to((far, 1.0, 0.0), speed, facing=turn)
        run(animal)
        feet = animal.herd.toes(animal.index)
        front, rear = feet[:2, :2].mean(axis=0), feet[2:, :2].mean(axis=0)
        assert np.linalg.norm(front - [far, 1.0]) < 0.02
        assert abs(wrap(math.atan2(*(front - rear)[::-1]) - turn)) < math.radians(2.0)
        assert isinstance(animal.events[-1], Arrived)


def test_turns_its_front_first_and_slides_its_rear_out_at_the_end():
    animal = animal_on(plane(), yaw=0.0)
    animal.go_to((2.0, 1.2, 0.0), 1.0)
    root = animal.position[:2].copy()
    for _ in range(25):
        animal.herd.tick()
        animal.tick()
    assert animal.position[:2] == pytest.approx(root) and animal.yaw > 0.2
    fronts = []
    run(animal, each=lambda: fronts.append((animal.speed, *animal.herd.front(animal.index))))
    last = np.array([row[1:] for row in fronts[-20:]])
    assert np.ptp(last, axis=0).max() < 1e-3
    assert animal.herd.place(animal.index).bend == pytest.approx(0.0, abs=1e-4)


def test_little_flex_needs_no_motion_of_its_own():
    animal = animal_on(plane())
    animal.go_to((3.0, 0.1, 0.0), 1.0)
    assert isinstance(animal.events[0], SetOff)


def test_stands_still_when_the_ground_goes():
    animal = animal_on(plane())
    animal.go_to((8.0, 0.0, 0.0), 1.0)
    for _ in range(250):
        animal.herd.tick()
        animal.tick()
    gone = Ground.from_arrays(*quads(floor(x1=3.5), floor(x0=6.0)))
    before = animal.position
    assert animal.herd.change_ground(gone).tolist() == [animal.index]
    steps = []
    for _ in range(300):
        animal.herd.tick()
        animal.tick()
        steps.append(animal.position[:2].copy())
    assert animal.status == "lost" and animal.speed == 0.0
    assert np.linalg.norm(np.diff(steps, axis=0), axis=1).max() < 0.02
    assert animal.front[0] < 3.5 and animal.position[0] >= before[0] - 1e-6
    assert not any(isinstance(event, MissedGoal) for event in animal.events)


def test_backs_out_of_a_dead_end_and_turns_where_there_is_room():
    vertices, faces = dead_end(0.5)
    ground = Ground.from_arrays(vertices, faces)
    herd = Herd(ground)
    animal = Animal(herd, herd.add(DOG, (-2.0, 0.3, 0.0), 0.0), GraphPlanner(vertices, faces))
    animal.go_to((1.5, 0.0, 0.0), 1.0)
    run(animal)
    assert animal.status == "arrived" and animal.front[0] == pytest.approx(1.5, abs=0.02)
    animal.go_to((-3.0, 0.5, 0.0), 1.0)
    inside = []
    run(animal, each=lambda: inside.append((animal.position[0], animal.yaw)))
    assert animal.status == "arrived" and animal.front[0] == pytest.approx(-3.0, abs=0.02)
    (backed,) = [event for event in animal.events if isinstance(event, BackedOut)]
    assert backed.distance > 1.0
    assert all(abs(yaw) < 0.3 for x, yaw in inside if x > 0.3)  # it never turns in the passage


def test_without_room_for_any_move_it_is_told_so_and_stays_as_it_is():
    loop = [(-0.2, -0.2), (1.0, -0.2), (1.0, 0.2), (-0.2, 0.2)]
    walls = (wall(a, b) for a, b in zip(loop, loop[1:] + loop[:1], strict=True))
    animal = animal_on(Ground.from_arrays(*quads(floor(), *walls)))
    before = animal.herd.toes(0)
    with pytest.raises(LocomotionError, match="a dog has no room to turn towards its path"):
        animal.go_to((-3.0, 0.5, 0.0), 1.0)
    assert animal.status == "standing" and not animal.events and animal.trail is None
    animal.herd.tick()
    assert np.array_equal(animal.herd.toes(0), before)


def test_told_anew_while_it_turns_onto_its_path_it_takes_the_new_one():
    animal = animal_on(plane())
    animal.go_to((3.0, 1.0, 0.0), 1.0)
    assert animal._phase == "flexing"
    for _ in range(5):
        animal.herd.tick()
        animal.tick()
    animal.go_to((-1.0, 4.0, 0.0), 1.0)
    run(animal)
    assert animal.status == "arrived"
    assert np.linalg.norm(animal.front[:2] - (-1.0, 4.0)) < 0.1


@pytest.mark.parametrize("goals", [(), (1.0, 2.0), (0.0, math.nan, 0.0)])
def test_a_goal_that_is_none_is_refused(goals):
    with pytest.raises(LocomotionError, match="goals must be finite"):
        animal_on(plane()).go_to(goals)
