"""Crowds on small levels: what walkers do."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import navmesh
from benchmarks.crowd import door_figures
from locomotion import LocomotionError
from locomotion.crowd import Crowd, NoRoute
from locomotion.crowd.gates import find_gates
from locomotion.events import Arrived, GotStuck, SetOff
from navmesh.graph.kernel_arrays import net_of


def level_of(*plates: tuple[float, float, float, float, float]) -> navmesh.Terrain:
    """Plates (x0, y0, x1, y1, z)."""
    corners, faces = [], []
    for x0, y0, x1, y1, z in plates:
        faces += [[len(corners) + k for k in triangle] for triangle in ((0, 1, 2), (0, 2, 3))]
        corners += [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)]
    return navmesh.Terrain.from_arrays(np.array(corners, dtype=float), np.array(faces))


def graph_of(*plates: tuple[float, float, float, float, float]) -> navmesh.NodeGraph:
    return navmesh.NodeGraph.build(level_of(*plates), navmesh.WalkRules(resolution=0.2), obstacle_rules=None)


@pytest.fixture(scope="module")
def hall() -> navmesh.NodeGraph:
    return graph_of((0.0, 0.0, 20.0, 10.0, 0.0))


@pytest.fixture(scope="module")
def corner() -> navmesh.NodeGraph:
    """Two halls joined by a corridor of 1 m."""
    return graph_of((0.0, 0.0, 6.0, 6.0, 0.0), (6.0, 2.0, 12.0, 3.0, 0.0), (12.0, 0.0, 18.0, 6.0, 0.0))


def deepest_overlap(crowd: Crowd) -> float:
    """The greatest overlap of two bodies, as a share of the smaller radius."""
    spots, radii = crowd.positions[:, :2], np.array([walker.radius for walker in crowd.walkers])
    away = np.linalg.norm(spots[:, None] - spots[None], axis=2)
    away[np.diag_indices(len(spots))] = np.inf
    return float(((radii[:, None] + radii - away) / np.minimum(radii[:, None], radii)).max())


def run(crowd: Crowd, seconds: float) -> float:
    """Run until nobody walks; returns the deepest overlap. All stay on the surface."""
    worst = -np.inf
    for _ in range(round(seconds / crowd.dt)):
        crowd.tick()
        worst = max(worst, deepest_overlap(crowd))
        if not any(walker.status == "walking" for walker in crowd.walkers):
            break
    radii = np.array([walker.radius for walker in crowd.walkers])
    assert (crowd.graph.clearance_at(crowd.positions) >= 0.99 * radii).all()
    return worst


def test_a_walker_goes_straight_to_its_goal(hall):
    crowd = Crowd(hall)
    walker = crowd.add((2.0, 5.0, 0.0))
    walker.go_to([(12.0, 5.0, 0.0)], speed=2.0, facing=1.0)
    run(crowd, 10.0)
    assert walker.status == "arrived"
    assert walker.position == pytest.approx([12.0, 5.0, 0.0], abs=0.16)
    assert walker.time == pytest.approx(10.0 / 2.0, abs=1.0)
    kinds = [type(event) for event in walker.events]
    assert kinds == [SetOff, Arrived]
    for _ in range(100):
        crowd.tick()
    assert walker.yaw == pytest.approx(1.0, abs=0.01)
    assert np.hypot(*walker.velocity) < 0.01


def test_speed_and_acceleration_are_kept(hall):
    crowd = Crowd(hall)
    walker = crowd.add((2.0, 5.0, 0.0), acceleration=3.0)
    walker.go_to([(12.0, 5.0, 0.0)], speed=2.0)
    last = walker.velocity
    while walker.status == "walking":
        crowd.tick()
        assert np.hypot(*walker.velocity) <= 2.0 + 1e-9
        if walker.status == "walking":
            assert np.hypot(*(walker.velocity - last)) <= 3.0 * crowd.dt + 1e-9
        last = walker.velocity


def test_it_visits_the_places_on_its_way(hall):
    crowd = Crowd(hall)
    walker = crowd.add((2.0, 2.0, 0.0))
    walker.go_to([(10.0, 8.0, 0.0), (3.0, 2.0, 0.0)])
    nearest = np.inf
    while walker.status == "walking":
        crowd.tick()
        nearest = min(nearest, float(np.hypot(*(walker.position[:2] - [10.0, 8.0]))))
    assert walker.status == "arrived" and nearest < 0.6


def test_two_that_meet_pass(hall):
    crowd = Crowd(hall)
    one, two = crowd.add((5.0, 5.0, 0.0)), crowd.add((15.0, 5.0, 0.0))
    one.go_to([(15.0, 5.0, 0.0)])
    two.go_to([(5.0, 5.0, 0.0)])
    assert run(crowd, 20.0) < 0.0
    assert one.status == two.status == "arrived"
    assert one.time < 10.0 / 1.4 + 2.0


def test_a_circle_changes_sides_without_touching(hall):
    crowd = Crowd(hall)
    angles = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    spots = np.column_stack([10.0 + 4.4 * np.cos(angles), 5.0 + 4.4 * np.sin(angles), 0.0 * angles])
    for spot, goal in zip(spots, np.roll(spots, 12, axis=0), strict=True):
        crowd.add(spot).go_to([goal])
    assert run(crowd, 40.0) < 0.02
    assert all(walker.status == "arrived" for walker in crowd.walkers)


def test_many_with_one_goal_stand_around_it(hall):
    crowd = Crowd(hall)
    rng = np.random.default_rng(2)
    for spot in hall.random_points(rng, 30, 0.3):
        crowd.add(spot).go_to([(10.0, 5.0, 0.0)])
    run(crowd, 1.0)
    assert run(crowd, 60.0) < 0.1
    assert all(walker.status == "arrived" for walker in crowd.walkers)
    assert np.linalg.norm(crowd.positions[:, :2] - [10.0, 5.0], axis=1).max() < 4.0


def test_walkers_of_all_sizes_get_through_a_corridor_one_way(corner):
    crowd = Crowd(corner)
    rng = np.random.default_rng(4)
    spots = corner.random_points(rng, 200, 0.4)
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
def test_nobody_leaves_the_surface_or_its_connected_part(corner, seed):
    rng = np.random.default_rng(seed)
    crowd = Crowd(corner, dt=1 / 30)
    for spot in corner.random_points(rng, 40, 0.3):
        crowd.add(spot, radius=0.3).go_to(corner.random_points(rng, 1, 0.3), speed=3.0)
    for _ in range(90):
        crowd.tick()
        assert (corner.clearance_at(crowd.positions) >= 0.99 * 0.3).all()


def test_the_same_calls_give_the_same_bits_and_a_saved_moment_goes_on_the_same_way(corner):
    hashes, ends = [], []
    for _ in range(2):
        rng = np.random.default_rng(9)
        crowd = Crowd(corner)
        for spot in corner.random_points(rng, 20, 0.3):
            crowd.add(spot).go_to(corner.random_points(rng, 1, 0.3))
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


def test_one_whose_way_has_gone_is_stuck(hall):
    crowd = Crowd(hall)
    walker = crowd.add((2.0, 5.0, 0.0))
    walker.go_to([(12.0, 5.0, 0.0)])
    crowd.routes.rows[crowd.routes.region(0)[0] + 1, :2] = 30.0, 5.0  # a corner off the surface
    run(crowd, 20.0)
    assert walker.status == "stuck" and isinstance(walker.events[-1], GotStuck)


def test_wrong_input_is_refused(hall):
    crowd = Crowd(hall)
    with pytest.raises(LocomotionError, match="radius"):
        crowd.add((2.0, 5.0, 0.0), radius=0.0)
    with pytest.raises(LocomotionError, match="no room"):
        crowd.add((50.0, 5.0, 0.0))
    with pytest.raises(LocomotionError, match="acceleration"):
        crowd.add((2.0, 5.0, 0.0), acceleration=np.nan)
    with pytest.raises(LocomotionError, match="dt"):
        Crowd(hall, dt=0.0)
    walker = crowd.add((2.0, 5.0, 0.0))
    with pytest.raises(NoRoute, match="off_graph"):
        walker.go_to([(50.0, 5.0, 0.0)])
    for goals in ([(np.nan, 0.0, 0.0)], (1.0, 2.0, 3.0), []):
        with pytest.raises(LocomotionError, match="goals"):
            walker.go_to(goals)
    with pytest.raises(LocomotionError, match="speed"):
        walker.go_to([(3.0, 5.0, 0.0)], speed=-1.0)
    assert walker.status == "standing" and not walker.events


def test_gates_are_the_narrow_passages(corner):
    crowd = Crowd(corner)
    crowd.add((2.0, 2.0, 0.0), radius=0.3)
    gates = find_gates(corner.surface, net_of(corner), 3.25 * 0.3)
    assert len(gates.width) == 1 and gates.width[0] == pytest.approx(0.5, abs=0.01)
    centres = corner.surface.centers(np.flatnonzero(gates.of_cell >= 0))
    assert 5.0 < centres[:, 0].min() < 6.5 and 11.5 < centres[:, 0].max() < 13.0
    inside = (centres[:, 0] > 7.0) & (centres[:, 0] < 11.0)
    assert np.abs(gates.axis[gates.of_cell >= 0][inside, 0]) == pytest.approx(1.0)
    walls = find_gates(corner.surface, net_of(corner), 0.3)
    assert len(walls.width) == 0


def test_two_groups_take_turns_in_a_corridor(corner):
    crowd = Crowd(corner, dt=1 / 30)
    rows = [(x, 1.0 + 0.8 * k) for x in (1.0, 2.0, 3.0) for k in range(5)]
    for x, y in rows:
        crowd.add((x, y, 0.0)).go_to([(18.0 - x, y, 0.0)])
        crowd.add((18.0 - x, y, 0.0)).go_to([(x, y, 0.0)])
    assert run(crowd, 240.0) < 0.1
    assert [walker.status for walker in crowd.walkers] == ["arrived"] * 30


def test_two_who_meet_inside_a_corridor_give_way(corner):
    crowd = Crowd(corner)
    one, two = crowd.add((7.5, 2.5, 0.0)), crowd.add((10.0, 2.5, 0.0))
    one.go_to([(15.0, 3.0, 0.0)])
    two.go_to([(3.0, 3.0, 0.0)])
    assert run(crowd, 60.0) < 0.1
    assert one.status == two.status == "arrived"


def test_a_crowd_changes_halls_through_a_door():
    figures = door_figures(0.3, 40, np.random.default_rng(3), longest=120.0)
    assert figures["through"] == figures["arrived"] == 40
    assert figures["deepest_overlap"] < 0.1
    assert figures["least_clearance"] > 0.99 * 0.3


def test_walkers_go_on_when_the_level_has_changed(corner):
    crowd = Crowd(corner)
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
