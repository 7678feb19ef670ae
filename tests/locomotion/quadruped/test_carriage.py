"""How high hips and shoulders are carried."""

from itertools import pairwise

import numpy as np
import pytest

from benchmarks.dog_back import going
from benchmarks.dog_gait_changes import Place, steady
from locomotion import Ground
from locomotion.quadruped import layout as at
from locomotion.quadruped import load_body
from locomotion.quadruped.motion import DT
from locomotion.quadruped.pose import body_names
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


@pytest.mark.parametrize(("name", "speed"), [("dog", 7.7), ("cat", 5.8), ("horse", 12.5)])
def test_a_gallop_is_the_same_in_every_stride_and_nothing_snatches_the_trunk_down(name, speed):
    body = load_body(name)
    poses, stands = going(body, speed, "gallop")
    names = body_names(body.spine.bones)
    legs = [f"{pair}_{side}_upper" for pair in ("front", "rear") for side in ("left", "right")]
    joints = poses[:, [names.index(each) for each in legs], 2]
    heights = joints.reshape(-1, 2, 2).mean(axis=2) / [body.front_legs.height, body.rear_legs.height]
    landings = np.flatnonzero(~stands[:-1, 3] & stands[1:, 3]) + 1
    lowest = [heights[a:b].min(axis=0) for a, b in pairwise(landings)]
    assert np.ptp(lowest, axis=0).max() < 0.015
    pulled = np.abs(np.diff(heights, 2, axis=0)).max() * body.rear_legs.height / DT**2
    assert pulled < 12.0 * 9.81


@pytest.mark.parametrize("slope", [-0.12, 0.12])
def test_an_animal_is_as_high_on_an_even_slope_as_on_level_ground(slope):
    """Between the lowest and the highest that hips and shoulders get over the ground."""
    body = load_body("cat")
    place = Place("slope", slope)
    watch, *_ = steady(body, place, np.array([0.5, 0.9]) * place.fastest(body), ["trot", "gallop"])
    middle = 0.5 * (watch.low + watch.high)[:, :2]
    assert middle == pytest.approx(
        np.broadcast_to([body.rear_legs.height, body.front_legs.height], middle.shape), rel=0.03
    )
