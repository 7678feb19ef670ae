"""Many animals at once do not change what each of them does."""

import numpy as np
import pytest

from locomotion import LocomotionError
from locomotion.quadruped import Herd, lay_trail, load_body
from tests.locomotion.quadruped.scenes import animal_on, plane, run


def test_an_animal_does_not_care_about_the_others():
    ground = plane()
    bend = np.column_stack([np.linspace(0, 5, 60), np.sin(np.linspace(0, 5, 60)), np.zeros(60)])

    def hashes(count, chosen):
        herd = Herd(ground)
        for k in range(count):
            body = load_body(("dog", "cat", "horse")[k % 3])
            index = herd.add(body, (0.0, 0.5 * k, 0.0), 0.0)
            herd.follow(index, lay_trail(bend + np.array([0.0, 0.5 * k, 0.0]), body, ground), 0.8)
        for _ in range(200):
            herd.tick()
        return [herd.state_hash(k) for k in chosen]

    assert hashes(4, [0, 1, 3]) == hashes(30, [0, 1, 3])


def test_a_restored_animal_goes_on_the_same_way():
    animal = animal_on(plane(), yaw=2.0)
    animal.go_to([(3.0, 1.0, 0.0), (0.5, 0.5, 0.0)], 1.5, facing=1.0)
    for _ in range(130):
        animal.herd.tick()
        animal.tick()
    saved, events = animal.save(), len(animal.events)
    hashes = []
    for _ in range(2):
        run(animal)
        hashes.append((animal.state_hash(), animal.time, len(animal.events)))
        animal.restore(saved)
        assert len(animal.events) == events
    assert hashes[0] == hashes[1]


def test_what_cannot_be_followed_is_refused():
    body, ground = load_body("dog"), plane()
    herd = Herd(ground)
    with pytest.raises(LocomotionError, match="no ground within"):
        herd.add(body, (0.0, 0.0, 3.0), 0.0)
    index = herd.add(body, (0.0, 0.0, 0.0), 0.0)
    trail = lay_trail([[0, 0, 0], [3, 0, 0]], body, ground)
    with pytest.raises(LocomotionError, match="above 0 m/s"):
        herd.follow(index, trail, 0.0)
    with pytest.raises(LocomotionError, match="valid: walk"):
        herd.follow(index, trail, 1.0, gait="crawl")
    with pytest.raises(LocomotionError, match="in that direction"):
        herd.follow(index, trail, 1.0, start=2.0, end=1.0)
