"""The capsule that walks on the mesh: it steps over cracks and falls where there is nothing."""

import math

import numpy as np
import pytest
import trimesh

from runtime.playtest import feet
from runtime.playtest.feet import ARRIVED, FELL, roam
from runtime.playtest.movers import CapsuleMover
from tests.runtime.playtest.levels import FLOOR, D, box, room, site_of


def test_a_roamer_steps_over_cracks_and_falls_through_holes():
    for width, ends in ((0.01, "arrived"), (0.12, "arrived"), (0.3, "arrived"), (0.6, "fell")):
        for turn in (0.0, 0.7):
            floors = [box(-9, 9, 0, 9, -0.2, 0), box(-9, 9, -9, -width, -0.2, 0)]
            mesh = trimesh.util.concatenate(floors)
            mesh.apply_transform(trimesh.transformations.rotation_matrix(turn, (0, 0, 1)))
            mover = CapsuleMover(site_of(mesh))
            start = np.array([-2.0 * np.sin(turn), 2.0 * np.cos(turn), 0.0])
            mover.appear(start, 0.0)
            leg = mover.wander(np.array([turn - 0.5 * np.pi]), 1.5)
            assert leg.status == ends, (width, turn)


def test_a_roamer_falls_through_a_hole():
    mesh = trimesh.util.concatenate([box(0, 9, 0, 4, -0.2, 0), box(11, 20, 0, 4, -0.2, 0)])
    mover = CapsuleMover(site_of(mesh))
    mover.appear(np.array([7.0, 2.0, 0.0]), 0.0)
    leg = mover.wander(np.array([0.0]), 5.0)
    assert leg.status == "fell" and 8.8 < leg.place[0] < 9.5


def roamed(mesh, start, headings, seconds=4.0, speed=2.0):
    """(end, place [m]) after walking straight on from ``start``, with the body of a person."""
    site = site_of(mesh)
    rules = site.graph.rules
    grid, origin = site.mesh_grid.arrays, site.graph.surface.origin
    limits = np.array([0.3, rules.max_step, rules.headroom, 1.0, 0.25])
    place, track = np.array(start, float) - origin, np.zeros((200, 4))
    end, time, count = roam(grid, place, np.array(headings, float), speed, limits, seconds, track)
    assert time >= seconds or end == FELL
    assert (np.diff(track[:count, 0]) > 0.0).all()
    return end, place + origin


@pytest.mark.parametrize(
    ("block", "height"),
    [((9, 12, 0, D, 0, 0.15), 0.15), ((9, 12, 0, D, 0, 0.5), 0.0), ((9, 12, 0, D, 1.5, 2.5), 0.0)],
    ids=["a low step", "a high step", "a beam at head height"],
)
def test_it_goes_up_what_is_a_step_and_stops_before_what_is_not(block, height):
    end, place = roamed(room(FLOOR, box(*block)), (7.5, 5.0, 0.0), [0.0], seconds=1.5)
    assert end == ARRIVED and place[2] == pytest.approx(height, abs=0.01)
    assert place[0] > 9.0 if height else place[0] < 9.0 - 0.8 * 0.3 + 0.11


def test_it_falls_onto_a_lower_floor_and_out_of_the_level():
    floors = trimesh.util.concatenate([box(0, 5, 0, 4, -0.2, 0), box(5, 9, 0, 4, -1.0, -0.8)])
    end, place = roamed(floors, (4.0, 2.0, 0.0), [0.0], seconds=1.5)
    assert end == ARRIVED and place[2] == pytest.approx(-0.8, abs=0.01)
    assert roamed(floors, (8.0, 2.0, -0.8), [0.0])[0] == FELL


def test_at_a_wall_it_takes_the_next_heading():
    end, place = roamed(room(FLOOR), (14.0, 5.0, 0.0), [0.0, math.pi], seconds=3.0)
    assert end == ARRIVED and place[0] < 13.0 and place[1] == pytest.approx(5.0, abs=0.05)


@pytest.mark.parametrize(
    ("turned", "angle"), [(3.5 * math.pi, -0.5 * math.pi), (-4.0, 2.0 * math.pi - 4.0), (1.0, 1.0)]
)
def test_angles_are_taken_the_short_way_round(turned, angle):
    assert feet._angle(turned) == pytest.approx(angle)
