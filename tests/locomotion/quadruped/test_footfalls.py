"""Feet stand still on the real ground."""

import numpy as np
import pytest

from locomotion import Ground
from locomotion.quadruped import layout as at
from locomotion.quadruped import load_body
from tests.locomotion.quadruped.bends import follow
from tests.locomotion.quadruped.scenes import animal_on, bone_toes, floor, plane, quads, run, stairs


@pytest.mark.parametrize("gait", ["walk", "trot", "gallop", "pace"])
def test_standing_feet_do_not_move(gait):
    speed = {"walk": 1.0, "trot": 2.0, "gallop": 4.0, "pace": 1.1}[gait]
    animal = animal_on(plane())
    animal.go_to((9.0, 0.5, 0.0), speed, gait=gait)
    last = {}

    def look():
        toes = bone_toes(animal)
        for leg, stands in enumerate(animal.herd.standing_feet(animal.index)):
            if stands and leg in last:
                assert np.abs(toes[leg] - last[leg]).max() < 1e-6
            last.pop(leg, None)
            if stands:
                last[leg] = toes[leg]
                assert abs(toes[leg, 2]) < 1e-6

    run(animal, each=look)
    assert animal.status == "arrived"


@pytest.mark.parametrize(
    ("ground", "top"),
    [(stairs(), 0.9), (Ground.from_arrays(*quads(floor(slope=0.45))), 0.45 * 6.0)],
    ids=["stairs", "slope"],
)
def test_feet_stand_on_the_real_ground(ground, top):
    line = np.array([[0.0, 0.0, 0.0], [6.0, 0.0, top]])
    animal = animal_on(ground, line=line)
    animal.go_to(line[-1], 1.0)

    def look():
        toes = bone_toes(animal)
        stands = animal.herd.standing_feet(animal.index)
        below = ground.surface_below(toes + np.array([0.0, 0.0, 0.05]))[0]
        assert np.abs(toes[:, 2] - below)[stands].max(initial=0.0) < 0.01

    run(animal, each=look)
    assert animal.status == "arrived" and animal.front[2] == pytest.approx(top, abs=0.02)


def test_a_swing_begins_when_its_stance_is_over_and_not_with_the_next_tick():
    """Else every swing would begin with another delay, and the gallop's trunk would sink for it by chance."""
    herd, index, _ = follow(load_body("cat"), 5.0, np.array([[0.0, 0, 0], [40.0, 0, 0]]))
    state, feet, swings = herd.state[index], herd.feet[index], 0
    while state[at.SPEED] < 4.99:
        herd.tick()
    for _ in range(100):
        stood = feet[:, at.IN_SWING] == 0.0
        herd.tick()
        left = stood & (feet[:, at.IN_SWING] > 0.0)
        swings += left.sum()
        assert feet[left, at.SWING_FROM] == pytest.approx(feet[left, at.STANCE], abs=0.005)
    assert swings >= 12
