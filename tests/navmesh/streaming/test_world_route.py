"""Routes in use are told whether they still hold, and whether they could lead farther."""

import numpy as np

from navmesh import OpenWorld, bake_open_world
from tests.navmesh.shapes import box, join, plane, terrain


def row(tmp_path):
    """Twenty floors of 10 m in a row; a wall across the tenth leaves a way round at the upper end."""
    chunks = {f"{i:02}": terrain(plane(10.0 * i, 10.0 * i + 10.0, 0, 10)) for i in range(20)}
    chunks["10"] = terrain(join(plane(100, 110, 0, 10), box(104, 105, 0, 8, 0, 3)))
    return OpenWorld(bake_open_world(chunks, tmp_path / "world", side=20.0), 12.0)


def load(world, x):
    while world.keep_around((x, 5.0, 0.0), 3):
        pass


def test_a_route_is_refined_as_chunks_come_in_and_broken_when_they_go(tmp_path):
    world = row(tmp_path)
    start, goal = (5.0, 5.0, 0.0), (195.0, 5.0, 0.0)
    nothing = world.route(start, goal)
    assert nothing.fine is None and np.array_equal(nothing.waypoints[[0, -1]], [start, goal])
    assert nothing.holds(world) and not nothing.could_be_finer(world)
    load(world, 5.0)
    assert nothing.could_be_finer(world)
    first = world.route(start, goal)
    assert first.holds(world) and not first.could_be_finer(world)
    reached = first.fine.waypoints[-1][0]
    assert 5.0 < reached < 30.0 and first.beyond[0, 0] > reached
    assert first.length == first.fine.length + first.beyond_length
    world.keep_around((20.0, 5.0, 0.0))
    assert first.holds(world) and first.could_be_finer(world)
    second = world.route(start, goal)
    assert second.fine.waypoints[-1][0] > reached and second.status == "complete"
    load(world, 150.0)
    assert not first.holds(world) and not second.holds(world)
    assert world.route(start, goal).fine is None
    assert "coarse waypoints" in repr(first)


def test_routes_without_a_way_have_no_waypoints(tmp_path):
    world = row(tmp_path)
    away = world.route((5.0, 5.0, 0.0), (5.0, 500.0, 0.0))
    assert away.status == "off_graph" and not len(away.waypoints) and away.length == 0.0
    assert away.holds(world) and not away.could_be_finer(world)


def test_a_route_through_a_wall_that_is_not_loaded_holds_until_it_comes(tmp_path):
    """A floor that lies in one chunk, and a wall on it in another."""
    chunks = {"floor": terrain(plane(0, 200, 0, 10)), "wall": terrain(box(104, 105, 0, 8, 0, 3))}
    world = OpenWorld(bake_open_world(chunks, tmp_path / "world", side=20.0), 30.0)
    world.keep_around((5.0, 5.0, 0.0), 5)
    assert world.loaded == ("floor",)
    assert world.is_loaded([(90.0, 5.0, 0.0), (104.0, 5.0, 0.0)]).tolist() == [True, False]
    route = world.route((5.0, 5.0, 0.0), (195.0, 5.0, 0.0))
    assert route.holds(world)
    world.keep_around((90.0, 5.0, 0.0), 5)
    assert not route.holds(world)
    after = world.route((5.0, 5.0, 0.0), (195.0, 5.0, 0.0))
    assert not len(after.beyond) and after.fine.waypoints[:, 1].max() > 8.0
