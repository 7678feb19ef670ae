"""The crowd's kernels against slow and obvious versions of them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from locomotion.crowd.avoidance import body_plane
from locomotion.crowd.neighbours import brute_neighbours, find_neighbours
from locomotion.crowd.orca_program import choose_velocity
from locomotion.crowd.reference import orca_plane, velocity, worst_violation

SPEED = 1.5


def random_planes(rng: np.random.Generator, count: int, room: float) -> np.ndarray:
    angle = rng.uniform(-np.pi, np.pi, count)
    return np.column_stack([np.cos(angle), np.sin(angle), rng.uniform(-1.0, room, count)])


@pytest.mark.parametrize("room", [1.5, 0.6, 0.2])
def test_the_velocity_is_the_optimum(room):
    rng = np.random.default_rng(3)
    kept_all = 0
    for _ in range(60):
        count = int(rng.integers(0, 9))
        hard = int(rng.integers(0, min(count, 2) + 1))
        planes, wish = random_planes(rng, count, room), rng.uniform(-2.0, 2.0, 2)
        planes[:hard, 2] = np.abs(planes[:hard, 2])  # the velocity 0 keeps the walls
        exact, possible = velocity(planes, hard, SPEED, wish)
        found = np.array(choose_velocity(planes, count, hard, SPEED, *wish, np.empty_like(planes)))
        assert np.hypot(*found) <= SPEED + 1e-9
        kept_all += possible
        if possible:
            assert found == pytest.approx(exact, abs=1e-3)
            assert worst_violation(planes, found) <= 1e-6
        else:
            assert worst_violation(planes[:hard], found) <= 1e-6
            assert worst_violation(planes[hard:], found) == pytest.approx(
                worst_violation(planes[hard:], exact), abs=1e-5
            )
    assert 0 < kept_all < 60 or room > 1.0


def test_walls_that_leave_no_velocity_are_violated_least():
    planes = np.array([[1.0, 0.0, -0.2], [-1.0, 0.0, -0.4], [0.0, 1.0, 1.0]])
    found = np.array(choose_velocity(planes, 3, 2, SPEED, 0.0, 0.5, np.empty_like(planes)))
    assert found[0] == pytest.approx(0.1)
    assert worst_violation(planes, found) == pytest.approx(0.3)


def test_the_plane_of_a_neighbour_is_the_one_of_its_definition():
    rng = np.random.default_rng(5)
    row = np.empty((1, 3))
    for _ in range(200):
        offset = rng.uniform(-4.0, 4.0, 2)
        reach = rng.uniform(0.1, 0.95) * np.hypot(*offset)
        own, other = rng.uniform(-2.0, 2.0, (2, 2))
        share, horizon = rng.uniform(0.0, 1.0), rng.uniform(0.3, 3.0)
        body_plane(row, 0, *offset, *own, *other, reach, share, horizon)
        assert row[0] == pytest.approx(orca_plane(offset, own, other, reach, share, horizon), abs=1e-5)


def test_two_that_keep_their_planes_do_not_collide():
    rng = np.random.default_rng(7)
    one, two = np.empty((1, 3)), np.empty((1, 3))
    for _ in range(200):
        offset, reach, horizon = np.array([2.0, 0.3]), 0.6, 1.5
        a, b = rng.uniform(-1.5, 1.5, (2, 2))
        share = rng.uniform(0.2, 0.8)
        body_plane(one, 0, *offset, *a, *b, reach, share, horizon)
        body_plane(two, 0, *-offset, *b, *a, reach, 1.0 - share, horizon)
        u = np.array(choose_velocity(one, 1, 0, 3.0, *a, np.empty((1, 3))))
        v = np.array(choose_velocity(two, 1, 0, 3.0, *b, np.empty((1, 3))))
        t = np.linspace(0.0, horizon, 50)[:, None]
        assert np.linalg.norm(offset + t * (v - u), axis=1).min() >= reach - 1e-9


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 60), st.floats(0.5, 60.0))
def test_neighbours_are_those_of_looking_at_every_pair(seed, count, side):
    rng = np.random.default_rng(seed)
    x, y = np.round(rng.uniform(0.0, side, (2, count)), 1)  # rounded: some are equally far
    z = rng.choice([0.0, 1.0, 3.0], count)
    reach = rng.uniform(0.2, 5.0, count)
    wanted = rng.random(count) < 0.9
    order, found, number = find_neighbours(x, y, z, reach, wanted)
    assert sorted(order.tolist()) == list(range(count))
    for i, near in enumerate(brute_neighbours(x, y, z, reach)):
        assert found[i, : number[i]].tolist() == (near if wanted[i] else [])
