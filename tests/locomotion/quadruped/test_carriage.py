"""How high hips and shoulders are carried."""

import numpy as np
import pytest

from locomotion import Ground
from locomotion.quadruped import layout as at
from locomotion.quadruped.motion import DT
from tests.locomotion.quadruped.scenes import animal_on, bone_toes, quads, run


@pytest.mark.parametrize("steepest", [1.1, 1.3, 1.6])
def test_the_trunk_comes_to_its_steepest_tilt_without_a_jump(steepest):
    x = np.concatenate([[-5.0], np.linspace(1.0, 2.0, 40), [4.0]])
    slopes = steepest * np.clip(x - 1.0, 0.0, 1.0)
    z = np.concatenate([[0.0], np.cumsum(0.5 * (slopes[1:] + slopes[:-1]) * np.diff(x))])
    pieces = zip(x[:-1], x[1:], z[:-1], z[1:], strict=True)
    ground = Ground.from_arrays(
        *quads(*([(a, -3, p), (b, -3, q), (b, 3, q), (a, 3, p)] for a, b, p, q in pieces))
    )
    line = np.column_stack([x[1:], np.zeros_like(x[1:]), z[1:]])
    line[0, 0], line[-1] = 0.0, 0.1 * line[-2] + 0.9 * line[-1]
    animal = animal_on(ground, line=line)
    animal.go_to(line[-1], 1.0)
    pitch = []

    def look():
        pitch.append(animal.herd.state[animal.index, at.PITCH])
        toes, stands = bone_toes(animal), animal.herd.standing_feet(animal.index)
        below = ground.surface_below(toes + np.array([0.0, 0.0, 0.05]))[0]
        assert np.abs(toes[:, 2] - below)[stands].max(initial=0.0) < 0.01

    run(animal, each=look)
    assert max(pitch) > 0.75  # steeper than the trunk likes
    assert np.abs(np.diff(pitch, 2)).max() / DT < 1.0  # rad/s between ticks
