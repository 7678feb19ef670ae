"""Places of missions: refused where nobody can be, with the nearest place that would be right."""

import re

import numpy as np
import pytest
import trimesh

import navmesh
from runtime.missions.places import what_is_wrong
from runtime.planning.rules import person_walk_rules


@pytest.fixture(scope="module")
def room():
    """A floor of 12 m by 8 m with a wall of 0.25 m across it, x 6 to 6.25, that leaves a passage at y > 6."""
    boxes = ((0, 0, -0.3), (12, 8, 0)), ((6, 0, 0), (6.25, 6, 2.5))
    mesh = trimesh.util.concatenate([trimesh.creation.box(bounds=each) for each in boxes])
    terrain = navmesh.Terrain.from_arrays(mesh.vertices, mesh.faces)
    return navmesh.NodeGraph.build(terrain, person_walk_rules())


def right_place(message):
    return np.array([float(number) for number in re.findall(r"[-\d.]+", message.split("[")[-1])][:3])


@pytest.mark.parametrize("point", [(2.0, 2.0, 0.0), (6.5, 3.0, 0.2), (0.35, 0.35, -0.3)])
def test_places_on_the_floor_are_right(room, point):
    assert what_is_wrong(room, np.array(point), 0.3, "human") is None


@pytest.mark.parametrize(
    ("point", "says", "right"),
    [
        ((6.1, 3.0, 0.0), "in a wall", (6.55, 3.0, 0.0)),
        ((2.0, 2.0, 0.9), "0.90 m above the floor", (2.0, 2.0, 0.0)),
        ((20.0, 4.0, 0.0), "not on the floor", (11.7, 4.0, 0.0)),
        ((2.0, 2.0, -7.0), "not on the floor", (2.0, 2.0, 0.0)),
    ],
)
def test_other_places_are_refused_with_the_right_one_near_by(room, point, says, right):
    message = what_is_wrong(room, np.array(point), 0.3, "human")
    assert message is not None and says in message and str(list(point)) in message
    place = right_place(message)
    assert np.linalg.norm(place - point) <= np.linalg.norm(np.array(right) - point) + 0.1
    assert what_is_wrong(room, place, 0.3, "human") is None


def test_no_place_for_a_body_that_is_too_wide(room):
    assert "nowhere" in str(what_is_wrong(room, np.array([2.0, 2.0, 0.0]), 30.0, "walker"))
