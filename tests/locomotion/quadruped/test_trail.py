"""A path as an animal follows it."""

import numpy as np
import pytest

from locomotion import Ground, LocomotionError
from locomotion.quadruped import lay_trail, load_body
from locomotion.quadruped import layout as at
from tests.locomotion.quadruped.scenes import floor, plane, quads


def test_a_path_that_is_none_is_refused():
    body, ground = load_body("dog"), plane()
    for points, says in (
        ([[0, 0, 0]], "at least two points"), ([[0, 0, 0], [0, 0, 1]], "at least two points"),
        ([[0, 0, 0], [1, np.nan, 0]], "point 1 of the path"), ([[0, 0], [1, 0]], "shape"),
    ):  # fmt: skip
        with pytest.raises(LocomotionError, match=says):
            lay_trail(points, body, ground)


def test_it_leads_through_the_points_with_its_own_direction_and_curvature():
    angle = np.linspace(0.0, 1.5 * np.pi, 120)
    circle = np.column_stack([4.0 * np.sin(angle), 4.0 * (1.0 - np.cos(angle)), 0.0 * angle])
    trail = lay_trail(circle, load_body("dog"), plane())
    assert trail.length == pytest.approx(6.0 * np.pi, abs=1e-3) and trail.step <= 0.05
    for arc in np.linspace(0.5, trail.length - 0.5, 15):
        turned = arc / 4.0
        assert trail.point(arc) == pytest.approx(
            [4.0 * np.sin(turned), 4.0 * (1.0 - np.cos(turned))], abs=2e-3
        )
        assert trail.heading(arc) == pytest.approx(turned, abs=0.02)
    inner = trail.rows[10:-10]
    assert inner[:, at.PCURVATURE].mean() == pytest.approx(0.25, abs=0.005)
    assert trail.point(-1.0)[0] == pytest.approx(-1.0, abs=1e-3)  # straight on before its beginning


def test_it_lies_on_the_ground_and_is_slow_in_bends_and_on_steep_ground():
    body = load_body("dog")
    hill = lay_trail([[-3, 0, -1.2], [3, 0, 1.2]], body, Ground.from_arrays(*quads(floor(slope=0.4))))
    assert hill.rows[:, at.PZ] == pytest.approx(0.4 * hill.rows[:, at.PX], abs=1e-6)
    level = lay_trail([[-3, 0, 0], [3, 0, 0]], body, plane())
    assert hill.rows[20:-20, at.PSPEED].max() < level.rows[20:-20, at.PSPEED].min()
    corner = lay_trail([[-3, 0, 0], [0, 0, 0], [0, 3, 0]], body, plane())
    slowest = corner.rows[np.argmin(corner.rows[:, at.PSPEED]), [at.PX, at.PY]]
    assert np.linalg.norm(slowest) < body.spine.length + 0.3
    braking = np.diff(corner.rows[:, at.PSPEED] ** 2) / (2.0 * corner.step)
    assert braking.min() > -body.movement.braking
