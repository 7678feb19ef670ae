"""Capsules and ellipsoids on the bodies of a skeleton, and the quaternions that turn them."""

import mujoco
import numpy as np
import pytest

from runtime.bodies.figure import Figure, Shapes, rotate, turn


def test_quaternions_compose():
    rng = np.random.default_rng(0)
    p, q = (v / np.linalg.norm(v) for v in rng.normal(size=(2, 4)))
    vector = rng.normal(size=3)
    assert rotate(turn(p, q), vector) == pytest.approx(rotate(p, rotate(q, vector)))


def quarter_turn(axis):
    """The quaternion of 90 degrees about an axis, 0 to 2."""
    return np.eye(4)[0] * np.sqrt(0.5) + np.eye(4)[1 + axis] * np.sqrt(0.5)


def test_a_quarter_turn_about_each_axis():
    x, y, z = np.eye(3)
    assert rotate(quarter_turn(2), x) == pytest.approx(y)
    assert rotate(quarter_turn(0), y) == pytest.approx(z)
    assert rotate(quarter_turn(1), z) == pytest.approx(x)
    both = rotate(np.stack([quarter_turn(2), quarter_turn(0)]), np.stack([x, y]))
    assert both == pytest.approx(np.stack([y, z]))


def test_shapes_go_with_their_bodies():
    """The second body is turned to the left: what lies before it is beside it then."""
    ahead = [1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
    shapes = Shapes(np.array([ahead, ahead]), np.ones((2, 3)), np.array([True, False]), np.zeros((2, 3)))
    figure = Figure(("a", "b"), np.array([-1, 0]), np.array([0, 1]), shapes)
    posed = figure.posed(np.array([[5.0, 0, 0, 1, 0, 0, 0], [0.0, 0, 2, *quarter_turn(2)]]))
    assert posed.place[:, :3] == pytest.approx(np.array([[6.0, 0, 0], [0.0, 1, 2]]))
    assert posed.place[:, 3:] == pytest.approx(np.stack([np.eye(4)[0], quarter_turn(2)]))
    assert posed.size is shapes.size


def test_a_figure_can_be_larger():
    shapes = Shapes(
        np.array([[0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]]), np.ones((1, 3)), np.array([True]), np.zeros((1, 3))
    )
    larger = Figure(("a",), np.array([-1]), np.array([0]), shapes).scaled(2.0)
    assert larger.shapes.place[0].tolist() == [1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
    assert larger.shapes.size.tolist() == [[2.0, 2.0, 2.0]]


MODEL = """
<mujoco><worldbody>
  <geom type="plane" size="9 9 1"/>
  <body name="trunk" pos="0 0 1"><freejoint/>
    <geom type="capsule" size="0.1 0.2" rgba="1 0 0 1"/>
    <geom type="box" size="1 1 1"/>
    <body name="head" pos="0 0 0.4">
      <geom type="sphere" size="0.15" pos="0.1 0 0"/>
      <geom type="ellipsoid" size="0.1 0.2 0.3"/>
    </body>
  </body>
  <body name="handle" mocap="true"><geom type="sphere" size="0.05" contype="0" conaffinity="0"/></body>
</worldbody></mujoco>
"""


def test_of_a_model_the_round_shapes_of_its_limbs_are_drawn():
    """Not its floor and boxes, nor handles that a program moves."""
    figure = Figure.from_model(mujoco.MjModel.from_xml_string(MODEL))
    assert figure.bodies == ("trunk", "head") and figure.parents.tolist() == [-1, 0]
    limbs = figure.owner < 2
    assert figure.owner[limbs].tolist() == [0, 1, 1]
    assert figure.shapes.round[limbs].tolist() == [False, True, True]
    assert figure.shapes.size[limbs] == pytest.approx(np.array([[0.1, 0.2, 0], [0.15] * 3, [0.1, 0.2, 0.3]]))
    assert figure.shapes.place[1, :3].tolist() == [0.1, 0.0, 0.0]
    assert figure.shapes.colour[0].tolist() == [1.0, 0.0, 0.0]
