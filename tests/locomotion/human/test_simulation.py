"""Where a person is on its ground."""

import math

import mujoco
import numpy as np
import pytest

from locomotion.errors import LocomotionError
from locomotion.gaits.run.layout import COM, FEET
from locomotion.ground.ground import FRICTION, Ground
from locomotion.human.simulation import Simulation, movements

CORNERS = np.array([[-5.0, -5, -1.0], [5, -5, 1.0], [5, 5, 1.0], [-5, 5, -1.0]])
FACES = [[0, 1, 2], [0, 2, 3]]
SLOPE = 0.2


@pytest.fixture
def on_slope():
    made = Simulation(Ground.from_arrays(CORNERS, FACES))
    made.control[COM], made.control[FEET] = (2.0, 1.0, 1.3), (2.0, 0.9, 0.45, 2.1, 1.1, 0.47)
    return made


def test_it_is_where_the_ground_is_below_its_centre_of_mass(on_slope):
    assert on_slope.position == pytest.approx([2.0, 1.0, SLOPE * 2.0])
    assert on_slope.slope_here == pytest.approx(SLOPE) and on_slope.over_ground
    assert on_slope.footing == pytest.approx([SLOPE * 2.0, SLOPE * 2.1])


def test_its_grip_is_the_friction_of_its_ground(on_slope):
    assert on_slope.grip == Simulation(None).grip == FRICTION
    on_slope.ground.friction = 0.5
    assert on_slope.grip == 0.5


def test_beside_its_ground_it_is_at_its_lower_foot(on_slope):
    on_slope.control[COM] = 7.0, 1.0, 1.3
    assert on_slope.position == pytest.approx([7.0, 1.0, 0.45])
    assert on_slope.slope_here == 0.0 and not on_slope.over_ground
    on_slope.control[FEET] = 2.0, 0.9, 0.45, 7.0, 1.1, 0.47
    assert np.isnan(on_slope.footing).tolist() == [False, True]


def test_on_the_endless_plane_it_is_at_height_zero():
    body = Simulation(None)
    body.control[COM] = 300.0, 1.0, 0.9
    assert body.position == pytest.approx([300.0, 1.0, 0.0]) and body.over_ground and body.slope_here == 0.0
    assert body.on_ground(np.array([1.0, 2.0, 9.0])).tolist() == [1.0, 2.0, 9.0]


def test_a_place_is_moved_onto_ground_that_is_near(on_slope):
    for off in (-0.45, 0.0, 0.45):
        assert on_slope.on_ground(np.array([2.0, 0.0, 0.4 + off])) == pytest.approx([2.0, 0.0, 0.4])
    for place in ([2.0, 0.0, 1.0], [2.0, 0.0, -0.2], [9.0, 0.0, 0.4]):
        with pytest.raises(LocomotionError, match=r"no ground within 0\.5 m"):
            on_slope.on_ground(np.array(place))


def test_its_yaw_is_that_of_its_pelvis_however_it_leans():
    body = Simulation(None)
    for yaw in (-3.0, -1.0, 0.0, 2.5):
        quaternion = np.empty(4)
        mujoco.mju_euler2Quat(quaternion, np.array([yaw, 0.4, 0.0]), "zyx")
        body.data.qpos[3:7] = quaternion
        assert body.yaw == pytest.approx(yaw)


def test_transforms_are_those_of_the_pose(on_slope):
    data = on_slope.data
    data.qpos[:3], data.qpos[3:7] = (1.0, 2.0, 3.0), (math.cos(0.3), 0.0, 0.0, math.sin(0.3))
    found = on_slope.body_transforms()
    assert found.shape == (on_slope.model.nbody, 7)
    assert found[on_slope.index.root] == pytest.approx(data.qpos[:7])
    head = np.array([0.0, 0.0, 0.12 + 0.20 + 0.23])
    assert found[on_slope.index.head, :3] == pytest.approx(np.array([1.0, 2.0, 3.0]) + head)


def test_on_another_ground_it_has_a_simulation_of_its_own(on_slope):
    model = on_slope.model
    on_slope.stand_on(None)
    assert on_slope.model is not model and on_slope.ground is None and on_slope.data.time == 0.0


def test_several_are_where_each_of_them_is(on_slope):
    beside = Simulation(on_slope.ground)
    beside.control[COM], beside.control[FEET] = (7.0, 1.0, 1.3), (2.0, 0.9, 0.45, 7.0, 1.1, 0.41)
    both = [on_slope, beside]
    assert np.array_equal(movements(both)[0], [each.position for each in both])
    plane = Simulation(None)
    plane.control[COM] = 3.0, 4.0, 1.0
    assert np.array_equal(movements([plane])[0], [plane.position])
    assert movements([])[0].shape == (0, 3)
