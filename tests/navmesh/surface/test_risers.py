"""Steep faces of a step belong to the floor, however they slant; other steep faces do not."""

import math

import pytest

from navmesh import WalkRules
from tests.navmesh.shapes import box, plane, quad
from tests.navmesh.surface.levels import build, parts


@pytest.mark.parametrize(("rise", "passes"), [(0.2, True), (0.4, True), (0.41, False)])
@pytest.mark.parametrize("riser", [True, False])
def test_steps_end_at_the_limit(rise, passes, riser):
    level = [plane(0, 4, 0, 4), plane(4, 8, 0, 4, rise)]
    if riser:
        level.append(quad((4, 0, 0), (4, 0, rise), (4, 4, rise), (4, 4, 0)))
    graph = build(*level)
    a, b = parts(graph, 0.6, (2, 2, 0), (6, 2, rise))
    assert (a == b) == passes
    at_border = graph.clearance_at([[3.875, 2.125, 0], [4.125, 2.125, rise]])
    assert at_border == pytest.approx([1.875, 1.875] if passes else [0.125, 0.125], abs=0.01)


@pytest.mark.parametrize(("rise", "passes"), [(0.2, True), (0.4, True), (0.41, False)])
@pytest.mark.parametrize("degrees", [46, 60, 85])
def test_the_riser_of_a_step_may_slant(degrees, rise, passes):
    run = rise / math.tan(math.radians(degrees))
    middle = quad(
        (4 + run / 3, 0, rise / 3), (4 + run, 0, rise), (4 + run, 4, rise), (4 + run / 3, 4, rise / 3)
    )
    level = [
        plane(0, 4, 0, 4),
        quad((4, 0, 0), (4 + run / 3, 0, rise / 3), (4 + run / 3, 4, rise / 3), (4, 4, 0)),
        middle,
        plane(4 + run, 8, 0, 4, rise),
    ]
    graph = build(*level)
    a, b = parts(graph, 0.6, (2, 2, 0), (7, 2, rise))
    assert (a == b) == passes
    if passes:
        assert graph.clearance_at((4.0, 2.0, 0.0)) > 1.7


def test_a_hump_without_floor_on_top_is_no_step():
    rise = 0.3
    up = quad((3.8, 0, 0), (4, 0, rise), (4, 4, rise), (3.8, 4, 0))
    down = quad((4, 0, rise), (4.2, 0, 0), (4.2, 4, 0), (4, 4, rise))
    graph = build(plane(0, 3.8, 0, 4), up, down, plane(4.2, 8, 0, 4))
    a, b = parts(graph, 0.3, (2, 2, 0), (6, 2, 0))
    assert a != b
    assert graph.clearance_at((2.9, 2, 0)) == pytest.approx(0.9, abs=0.03)


def test_a_step_on_a_slope_is_not_made_higher_by_the_slope():
    slope = math.tan(math.radians(44))
    rules = WalkRules(max_step=0.2, headroom=2.0, resolution=0.25)
    upper = quad(
        (4, 0, 4 * slope + 0.18), (8, 0, 8 * slope + 0.18), (8, 4, 8 * slope + 0.18), (4, 4, 4 * slope + 0.18)
    )
    graph = build(quad((0, 0, 0), (4, 0, 4 * slope), (4, 4, 4 * slope), (0, 4, 0)), upper, rules=rules)
    a, b = parts(graph, 0.6, (1, 2, slope), (7, 2, 7 * slope + 0.18))
    assert a == b


def test_stairs_are_walked_up():
    treads = [box(2 + 0.28 * i, 2 + 0.28 * (i + 1), 0, 3, 0, 0.18 * (i + 1)) for i in range(12)]
    top = box(2 + 0.28 * 12, 10, 0, 3, 0, 0.18 * 12)
    rules = WalkRules(max_step=0.2, headroom=2.0)
    graph = build(plane(-2, 2, 0, 3), *treads, top, rules=rules)
    a, b = parts(graph, 0.6, (0, 1.5, 0), (8, 1.5, 0.18 * 12))
    assert a == b >= 0
