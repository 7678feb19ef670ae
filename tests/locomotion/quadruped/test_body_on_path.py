"""Following paths: root and front on the path, standing feet on the ground, head a time ahead, stops."""

import math

import numpy as np
import pytest
from scipy.spatial import KDTree

from locomotion.quadruped import load_body
from tests.locomotion.quadruped.bends import follow
from tests.locomotion.quadruped.scenes import animal_on, plane, run


@pytest.mark.parametrize(("name", "speed"), [("dog", 1.0), ("dog", 2.0), ("cat", 0.6), ("horse", 1.2)])
def test_root_and_front_are_on_the_path(name, speed):
    herd, index, trail = follow(load_body(name), speed)
    line = KDTree([trail.point(arc) for arc in np.arange(-1.5, trail.length + 1.5, 0.002)])
    roots, fronts = [], []
    while not herd.resting(index):
        herd.tick()
        roots.append(herd.root(index)[:2])
        fronts.append(herd.front(index).copy())
    assert line.query(roots)[0].max() < 0.01
    # it is put down straight where the path bends: a second to bend onto it
    assert np.percentile(line.query(fronts[100:])[0], 95) < 0.03


@pytest.mark.parametrize("degrees", [1.0, 3.0, 6.0, 15.0])
def test_the_front_is_on_the_path_from_the_first_step(degrees):
    turn = math.radians(degrees)
    animal = animal_on(plane())
    animal.go_to((3.0 * math.cos(turn), 3.0 * math.sin(turn), 0.0), 1.0)
    beside = []

    def look():
        if animal.speed > 0.0:
            x, y = animal.herd.front(animal.index)
            beside.append(abs(y * math.cos(turn) - x * math.sin(turn)))

    run(animal, each=look)
    assert max(beside) < 0.03


def test_a_flexible_body_bends_more():
    bends = {}
    for flex in (0.2, 1.3):
        dog = load_body("dog")
        body = dog.model_copy(update={"spine": dog.spine.model_copy(update={"flex": flex})})
        herd, index, _ = follow(body, 0.8)
        most = 0.0
        while not herd.resting(index):
            herd.tick()
            most = max(most, abs(herd.place(index).bend))
        bends[flex] = most
    assert bends[1.3] > 3.0 * bends[0.2]
