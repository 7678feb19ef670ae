"""Crowds on small levels: nobody touches another or leaves the floor, and runs repeat bit for bit."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from locomotion.crowd import Crowd
from locomotion.crowd import layout as at
from tests.locomotion.crowd.levels import corner, graph_of, hall, run


def test_two_that_meet_pass():
    crowd = Crowd(hall())
    one, two = crowd.add((5.0, 5.0, 0.0)), crowd.add((15.0, 5.0, 0.0))
    one.go_to([(15.0, 5.0, 0.0)])
    two.go_to([(5.0, 5.0, 0.0)])
    assert run(crowd, 20.0) < 0.0
    assert one.status == two.status == "arrived"
    assert one.time < 10.0 / 1.4 + 2.0


def test_gates_that_were_found_before_are_those_that_a_tick_would_find():
    crowds = Crowd(corner()), Crowd(corner())
    crowds[0].expect(0.3)
    for crowd in crowds:
        found = crowd._gates
        walker = crowd.add((0.6, 0.6, 0.0), 0.3)
        walker.go_to([crowd.graph.positions[-1]])
        crowd.tick()
        assert (found is None) == (crowd is crowds[1])
        assert found is None or crowd._gates is found  # not found again
    assert all((one == other).all() for one, other in zip(*(crowd._gates for crowd in crowds), strict=True))


def test_a_circle_changes_sides_without_touching():
    crowd = Crowd(hall())
    angles = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    spots = np.column_stack([10.0 + 4.4 * np.cos(angles), 5.0 + 4.4 * np.sin(angles), 0.0 * angles])
    for spot, goal in zip(spots, np.roll(spots, 12, axis=0), strict=True):
        crowd.add(spot).go_to([goal])
    assert run(crowd, 40.0) < 0.02
    assert all(walker.status == "arrived" for walker in crowd.walkers)


def test_many_with_one_goal_stand_around_it():
    crowd = Crowd(hall())
    rng = np.random.default_rng(2)
    for spot in hall().random_points(rng, 30, 0.3):
        crowd.add(spot).go_to([(10.0, 5.0, 0.0)])
    run(crowd, 1.0)
    assert run(crowd, 60.0) < 0.1
    assert all(walker.status == "arrived" for walker in crowd.walkers)
    assert np.linalg.norm(crowd.positions[:, :2] - [10.0, 5.0], axis=1).max() < 4.0


def test_walkers_of_all_sizes_get_through_a_corridor_one_way():
    crowd = Crowd(corner())
    rng = np.random.default_rng(4)
    spots = corner().random_points(rng, 200, 0.4)
    chosen: list[np.ndarray] = []
    for spot in spots[spots[:, 0] < 6.0]:
        if all(np.hypot(*(spot - other)[:2]) > 0.9 for other in chosen) and len(chosen) < 12:
            chosen.append(spot)
    for k, spot in enumerate(chosen):
        crowd.add(spot, radius=0.2 + 0.02 * k).go_to([(15.0, 1.0 + 0.35 * k, 0.0)])
    assert run(crowd, 60.0) < 0.1
    assert all(walker.status == "arrived" for walker in crowd.walkers)


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_nobody_leaves_the_surface_or_its_connected_part(seed):
    rng = np.random.default_rng(seed)
    crowd = Crowd(corner(), dt=1 / 30)
    for spot in corner().random_points(rng, 40, 0.3):
        crowd.add(spot, radius=0.3).go_to(corner().random_points(rng, 1, 0.3), speed=3.0)
    for _ in range(90):
        crowd.tick()
        assert (corner().clearance_at(crowd.positions) >= 0.99 * 0.3).all()


def test_bodies_that_have_their_ticks_in_turns_go_as_far_and_pass_each_other():
    crowd = Crowd(corner(), dt=0.03)
    walkers = [crowd.add((1.0 + 0.7 * k, 1.0 + 4.0 * (k % 2), 0.0)) for k in range(6)]
    for walker in walkers:
        x, y, _ = walker.position
        walker.go_to([(x, 6.0 - y, 0.0)], speed=1.4)
    nearest = np.inf
    for tick in range(900):
        turns = np.arange(6) % 3 == tick % 3
        before = crowd.rows.copy()
        crowd.tick(turns)
        kept = crowd.rows == before
        assert kept[~turns][:, [at.X, at.Y, at.VX, at.VY, at.YAW, at.AGE]].all()
        assert (crowd.rows[turns, at.AGE] == before[turns, at.AGE] + 1.0).all()
        away = np.linalg.norm(crowd.positions[:, None] - crowd.positions, axis=2)
        nearest = min(nearest, away[~np.eye(6, dtype=bool)].min())
    assert [walker.status for walker in walkers] == ["arrived"] * 6 and nearest > 0.55


def test_the_same_calls_give_the_same_bits_and_a_saved_moment_goes_on_the_same_way():
    hashes, ends = [], []
    for _ in range(2):
        rng = np.random.default_rng(9)
        crowd = Crowd(corner())
        for spot in corner().random_points(rng, 20, 0.3):
            crowd.add(spot).go_to(corner().random_points(rng, 1, 0.3))
        for _ in range(200):
            crowd.tick()
        saved = [walker.save() for walker in crowd.walkers]
        for _ in range(2):
            for _ in range(200):
                crowd.tick()
            hashes.append(tuple(walker.state_hash() for walker in crowd.walkers))
            ends.append([len(walker.events) for walker in crowd.walkers])
            for walker, state in zip(crowd.walkers, saved, strict=True):
                walker.restore(state)
    assert len(set(hashes)) == 1 and all(end == ends[0] for end in ends)


def test_walkers_go_on_when_the_level_has_changed():
    crowd = Crowd(corner())
    walker, idle = crowd.add((2.0, 2.5, 0.0)), crowd.add((0.5, 0.5, 0.0))
    walker.go_to([(15.0, 2.5, 0.0)])
    for _ in range(100):
        crowd.tick()
    here = walker.position
    changed = graph_of(  # the corridor is elsewhere, and so is the grid's corner
        (-1.0, -1.0, 6.0, 6.0, 0.0), (6.0, 4.5, 12.0, 5.5, 0.0), (12.0, 0.0, 18.0, 6.0, 0.0)
    )
    crowd.change_graph(changed)
    crowd.tick()
    assert walker.position == pytest.approx(here, abs=0.05)
    assert idle.position == pytest.approx([0.5, 0.5, 0.0], abs=0.01)
    run(crowd, 30.0)
    assert walker.status == "arrived"
    assert walker.position == pytest.approx([15.0, 2.5, 0.0], abs=0.2)
    walker.go_to([(2.0, 2.5, 0.0)])
    crowd.change_graph(graph_of((0.0, 0.0, 6.0, 6.0, 0.0), (12.0, 0.0, 18.0, 6.0, 0.0)))
    run(crowd, 30.0)
    assert walker.status == "stuck"
