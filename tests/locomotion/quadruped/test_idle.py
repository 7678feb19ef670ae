"""Animals that stand: alive, individuals, and the same again."""

import numpy as np
import pytest

from benchmarks.dog_back import standing
from locomotion.quadruped import Herd, load_body
from locomotion.quadruped import layout as at
from locomotion.quadruped.idle import habits
from tests.locomotion.quadruped.scenes import animal_on, bone_toes, plane

SHOWN = [at.GAZE, at.DIP, at.BACK, at.ROLL_REAR, at.SWAY_REAR, at.TAIL_YAW + 2]


def course(herd: Herd, ticks: int) -> np.ndarray:
    seen = []
    for _ in range(ticks):
        herd.tick()
        seen.append(herd.state[:, SHOWN].copy())
    return np.array(seen)


@pytest.mark.parametrize(("name", "breaths"), [("dog", (15, 30)), ("cat", (20, 40)), ("horse", (8, 16))])
def test_breathes_looks_about_and_shifts_its_weight(name, breaths):
    found = standing(load_body(name), 3)
    assert breaths[0] <= found["breaths"] <= breaths[1]
    assert found["gaze_deg"] > 20.0 and found["roll_deg"] > 1.0
    assert found["slide"] == 0.0
    assert found["alike"] < 0.8


def test_its_feet_stay_and_its_joints_do_not_jump():
    animal = animal_on(plane())
    toes, joints = bone_toes(animal), []
    for _ in range(4000):
        animal.herd.tick()
        animal.tick()
        assert np.abs(bone_toes(animal) - toes).max() < 1e-6
        joints.append(animal.herd.joints[0].copy())
    speeds = np.diff(np.array(joints), axis=0) / 0.01
    assert np.abs(speeds).max() < 6.0 and np.abs(np.diff(speeds, axis=0)).max() < 3.0


def test_habits_come_from_the_seed_and_the_place_alone():
    place = np.array([1.0, 2.0, 0.0])
    assert np.array_equal(habits(3, place, 0.5), habits(3, place, 0.5))
    assert not np.array_equal(habits(3, place, 0.5), habits(4, place, 0.5))
    assert not np.array_equal(habits(3, place, 0.5), habits(3, place + 1.0, 0.5))


def test_a_restored_one_goes_on_as_it_would_have():
    herd = Herd(plane())
    herd.add(load_body("cat"), (0.0, 0.0, 0.0), 0.0, seed=5)
    course(herd, 300)
    saved = herd.save(0)
    first = course(herd, 500)
    herd.restore(0, saved)
    assert np.array_equal(course(herd, 500), first)


def test_it_stops_idling_when_it_sets_out():
    animal = animal_on(plane())
    for _ in range(500):
        animal.herd.tick()
        animal.tick()
    assert animal.herd.state[0, at.IDLE] > 0.95
    animal.go_to((6.0, 0.0, 0.0), 2.0)
    for _ in range(150):
        animal.herd.tick()
        animal.tick()
    assert animal.herd.state[0, at.IDLE] < 0.01 and abs(animal.herd.state[0, at.GAZE]) < 0.02
