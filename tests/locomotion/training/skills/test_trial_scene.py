"""The scene of trials: boxes are out of the way until they are moved."""

import mujoco
import numpy as np
import pytest

from locomotion.body.person import PersonIndex, build_person
from locomotion.training.skills.trial_scene import BOX_LENGTH, BOX_TOP, trial_scene


def height_at(model, x, y=0.0):
    """[m] of what is hit from above."""
    data = mujoco.MjData(model)
    data.qpos[0] = -50.0  # the person is elsewhere
    mujoco.mj_forward(model, data)
    hit = np.zeros(1, np.int32)
    down = mujoco.mj_ray(model, data, np.array([x, y, 9.0]), np.array([0.0, 0.0, -1.0]), None, 1, -1, hit)
    return 9.0 - down


def test_where_nothing_was_moved_there_is_only_the_plane():
    model = trial_scene("stair", "wall")
    for x in (-20.0, 0.0, 500.0, 1000.0, 2000.0):
        assert height_at(model, x) == pytest.approx(0.0, abs=1e-9)
    assert PersonIndex.of(model).bodies == PersonIndex.of(build_person()).bodies


def test_a_box_that_is_moved_is_where_it_was_put():
    model = trial_scene("stair")
    model.geom_pos[model.geom("stair").id] = [3.0 + BOX_LENGTH / 2, 0.0, 0.4 - BOX_TOP]
    for x, height in ((2.99, 0.0), (3.01, 0.4), (62.9, 0.4), (63.1, 0.0)):
        assert height_at(model, x) == pytest.approx(height, abs=1e-9)


def test_a_plane_that_is_moved_or_tilted_is_where_it_was_put():
    model = trial_scene()
    ground = model.geom("ground").id
    model.geom_pos[ground] = [0.0, 0.0, -1.5]
    assert height_at(model, 3.0) == pytest.approx(-1.5)
    model.geom_quat[ground] = [np.cos(0.1), 0.0, -np.sin(0.1), 0.0]
    assert height_at(model, 3.0) == pytest.approx(-1.5 + 3.0 * np.tan(0.2))
