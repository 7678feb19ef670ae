"""Training grounds are as rough as they say, and their meshes lie on their heights."""

import numpy as np
import pytest

from locomotion.training.gaits.grounds import FLIGHTS, HALF, KINDS, ground_height, training_ground

STEEPEST = {
    "level": 0.0, "gentle": 0.15, "rolling": 0.5, "ramps": 0.3, "moguls": 0.5, "crags": 0.44, "ridges": 0.45,
}  # fmt: skip


def slopes(kind, count=20_000, step=1e-4):
    """The steepest slope at each of random points."""
    x, y = np.random.default_rng(0).uniform(-HALF + 1.0, HALF - 1.0, (2, count))
    here = ground_height(kind, x, y)
    along = ground_height(kind, x + step, y) - here, ground_height(kind, x, y + step) - here
    return np.hypot(*along) / step


@pytest.mark.parametrize("kind", STEEPEST)
def test_no_slope_is_steeper_than_it_is_said_to_be_and_some_nearly_are(kind):
    found = slopes(kind)
    assert found.max() <= STEEPEST[kind] + 1e-6
    assert found.max() >= 0.95 * STEEPEST[kind]


@pytest.mark.parametrize(
    ("kind", "usual"), [("gentle", 0.07), ("rolling", 0.22), ("moguls", 0.17), ("crags", 0.31)]
)
def test_most_places_are_less_steep(kind, usual):
    assert np.median(slopes(kind)) == pytest.approx(usual, abs=0.02)


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "stairs"])
def test_the_mesh_lies_on_the_heights(kind):
    ground = training_ground(kind)
    corners = ground.vertices[:: len(ground.vertices) // 50]
    assert corners[:, 2] == pytest.approx(ground_height(kind, corners[:, 0], corners[:, 1]), abs=1e-9)
    assert ground.low[:2] == pytest.approx([-HALF, -HALF]) and ground.high[:2] == pytest.approx([HALF, HALF])
    assert training_ground(kind) is ground


def test_flights_of_stairs_are_as_people_build_them():
    ground = training_ground("stairs")
    for first, tread, riser, last in FLIGHTS:
        assert 0.12 <= abs(riser) <= 0.2 and tread >= 0.27 and last < HALF
        middles = first + tread * (np.arange(7) + 0.5)
        x = np.concatenate([[first - 0.5], middles, [last + 0.5]])
        z, _ = ground.surface_below(np.column_stack([x, 0.0 * x, 0.0 * x + 9.0]))
        assert np.diff(z) == pytest.approx([riser] * 7 + [0.0], abs=1e-9)
        assert z == pytest.approx(ground_height("stairs", x, 0.0 * x), abs=1e-9)
    assert {bool(riser > 0.0) for _, _, riser, _ in FLIGHTS} == {True, False}
