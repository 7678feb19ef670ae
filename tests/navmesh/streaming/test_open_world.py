"""What is loaded is what the whole graph would be there, and routes answer for the whole world."""

from copy import copy

import numpy as np
import pytest

from benchmarks.navmesh_update import agree, digest
from navmesh import NavmeshError, NodeGraph, OpenWorld, bake_open_world, join_chunks
from navmesh.streaming.cutting import cut_level
from tests.navmesh.shapes import box, plane, quad, terrain
from tests.navmesh.streaming.worlds import (
    RADII,
    SIDE,
    SKILLS,
    WORLDS,
    level,
    loaded_world,
    open_world,
    whole,
)


def off(point, chunk):
    """How far a chunk is from a point, seen from above."""
    low, high = chunk.bounds[:, :2]
    return float(np.linalg.norm(np.maximum(np.maximum(low - point[:2], point[:2] - high), 0.0)))


# --- what is loaded
@pytest.mark.parametrize("kind", WORLDS)
def test_what_is_loaded_along_a_walk_is_what_a_build_of_these_chunks_gives(kind):
    world, chunks = open_world(kind, radius=12.0), cut_level(level(kind), SIDE)
    low, high = level(kind).bounds
    for share in np.linspace(0.0, 1.0, 6):
        point = low + share * (high - low)
        before = set(world.loaded)
        while changes := world.keep_around(point, 2):
            assert len(changes) <= 2
            for name, chunk in changes.items():
                assert (chunk is None) == (name in before)
                before ^= {name}
                assert chunk is None or chunk.digest == chunks[name].digest
            assert before == set(world.loaded)
        distance = {name: off(point, chunk) for name, chunk in chunks.items()}
        assert {name for name in chunks if distance[name] <= 12.0} <= set(world.loaded)
        assert set(world.loaded) <= {name for name in chunks if distance[name] <= 1.2 * 12.0}
        level_now = join_chunks({name: chunks[name] for name in world.loaded})
        assert agree(world.graph, NodeGraph.build(level_now, extent=whole(kind).extent))


def test_chunks_come_nearest_first_and_go_farthest_first_and_nothing_flickers(tmp_path):
    rows = {f"{i:02}": terrain(plane(10.0 * i, 10.0 * i + 10.0, 0, 10)) for i in range(20)}
    world = OpenWorld(bake_open_world(rows, tmp_path / "world"), 24.0, 44.0)
    order = []
    while changes := world.keep_around((55.0, 5.0, 0.0)):
        order += changes
    assert order == ["05", "04", "06", "03", "07"]
    assert list(world.keep_around((60.0, 5.0, 0.0))) == ["08"]
    assert not world.keep_around((55.0, 5.0, 0.0)) and not world.keep_around((60.0, 5.0, 0.0))
    changes = world.keep_around((125.0, 5.0, 0.0), 100)
    assert list(changes) == ["12", "11", "13", "10", "14", "03", "04", "05", "06", "07"]
    assert world.loaded == ("08", "10", "11", "12", "13", "14")


def test_several_players_keep_what_is_around_each(tmp_path):
    rows = {f"{i:02}": terrain(plane(10.0 * i, 10.0 * i + 10.0, 0, 10)) for i in range(20)}
    world = OpenWorld(bake_open_world(rows, tmp_path / "world"), 8.0)
    world.keep_around([(15.0, 5.0, 0.0), (155.0, 5.0, 0.0)], 100)
    assert world.loaded == ("00", "01", "02", "14", "15", "16")
    assert world.graph.find_path((1, 5, 0), (155, 5, 0)).status == "partial"
    route = world.route((1, 5, 0), (155, 5, 0))
    assert route.status == "complete" and route.length == pytest.approx(154.0, rel=0.02)
    assert len(world.keep_around(np.empty((0, 3)), 100)) == 6
    assert world.graph is None and world.loaded == ()


def test_chunks_without_floor_are_loaded_and_dropped_like_others(tmp_path):
    wall = terrain(quad((0, 0, 0), (0, 9, 0), (0, 9, 9), (0, 0, 9)))
    world = OpenWorld(
        bake_open_world({"wall": wall, "z": terrain(plane(30, 40, 0, 10))}, tmp_path / "w"), 5.0
    )
    assert list(world.keep_around((0.0, 5.0, 0.0))) == ["wall"] and world.graph is None
    assert world.route((32.0, 5.0, 0.0), (38.0, 5.0, 0.0)).status == "complete"
    world.keep_around((25.0, 5.0, 0.0), 2)
    assert world.loaded == ("z",) and world.graph is not None
    world.keep_around((0.0, 5.0, 0.0), 2)
    assert world.loaded == ("wall",) and world.graph is None


# --- routes
@pytest.mark.parametrize("skills", [None, SKILLS])
@pytest.mark.parametrize("radius", RADII)
@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.parametrize("kind", WORLDS)
def test_whether_a_goal_can_be_reached_is_what_the_whole_graph_says(kind, seed, radius, skills):
    graph, rng = whole(kind, seed), np.random.default_rng(seed)
    starts, goals = graph.random_points(rng, 400, radius).reshape(2, 200, 3)
    expected = graph.find_paths(starts, goals, radius, skills)
    some = starts[int(np.argmax(expected.length))]
    for world in (open_world(kind, seed), loaded_world(kind, some, seed)):
        found = [world.route(a, b, radius, skills) for a, b in zip(starts, goals, strict=True)]
        for k, route in enumerate(found):
            assert (route.status == "complete") == (expected.status[k] == "complete")
            assert route.status != "off_graph"
            if route.status == "complete":
                continue
            # the nearest place that can be reached, to a cell; it may not be worth going to by as much
            apart = np.linalg.norm(starts[k] - goals[k])
            near = [apart, apart]
            for side, each in enumerate((route.waypoints, expected.waypoints_of(k))):
                if len(each):
                    near[side] = np.linalg.norm(each[-1] - goals[k])
            assert near[0] == pytest.approx(near[1], abs=1.1 * graph.surface.resolution)
    assert {"complete"} < set(expected.status.tolist())


@pytest.mark.parametrize("kind", WORLDS)
def test_points_off_the_floor_are_where_the_whole_graph_finds_them_but_at_half_a_cell(kind):
    """Of points anywhere, few lie so that half a cell decides."""
    graph, rng = whole(kind), np.random.default_rng(9)
    low, high = graph.positions.min(axis=0) - 1.0, graph.positions.max(axis=0) + 1.0
    starts, goals = rng.uniform(low, high, (2, 300, 3))
    expected = graph.find_paths(starts, goals, RADII[0])
    world = open_world(kind)
    found = [world.route(a, b, RADII[0]).status for a, b in zip(starts, goals, strict=True)]
    unlike = (np.array(found) == "complete") != (expected.status == "complete")
    unlike |= (np.array(found) == "off_graph") != (expected.status == "off_graph")
    assert unlike.mean() <= 0.05


@pytest.mark.parametrize("kind", WORLDS)
def test_where_all_is_loaded_routes_are_those_of_the_whole_graph(kind):
    graph, rng = whole(kind), np.random.default_rng(3)
    world = loaded_world(kind, graph.positions[0], radius=1000.0)
    assert set(world.loaded) == set(world.chunks) and digest(world.graph) == digest(graph)
    for start, goal in graph.random_points(rng, 60, 0.25).reshape(30, 2, 3):
        expected = graph.find_path(start, goal, 0.25, SKILLS)
        found = world.route(start, goal, 0.25, SKILLS)
        assert found.status == expected.status and not len(found.beyond)
        if len(expected.waypoints):
            assert np.array_equal(found.fine.waypoints, expected.waypoints)
            assert found.length == expected.length


@pytest.mark.parametrize("kind", ["city", "hills", "clutter"])
def test_coarse_lengths_are_near_those_of_the_whole_graph(kind):
    """But for what the straight lines at both ends leave out."""
    graph, rng = whole(kind), np.random.default_rng(4)
    world, ratios = open_world(kind), []
    starts, goals = graph.random_points(rng, 1000, 0.25).reshape(2, 500, 3)
    expected = graph.find_paths(starts, goals, 0.25)
    for k in np.flatnonzero((expected.status == "complete") & (expected.length > 30.0)):
        route = world.route(starts[k], goals[k], 0.25)
        assert route.fine is None and len(route.beyond)
        ratios.append(route.length / expected.length[k])
    assert len(ratios) > 15
    assert np.median(ratios) == pytest.approx(1.0, abs=0.1)
    assert np.quantile(ratios, 0.05) > 0.75 and np.quantile(ratios, 0.95) < 1.15


@pytest.mark.parametrize("kind", ["city", "pieces"])
def test_the_fine_part_is_walked_over_what_is_loaded_and_the_rest_is_coarse(kind):
    graph, rng = whole(kind), np.random.default_rng(6)
    points = graph.random_points(rng, 40, 0.25, reachable_from=graph.positions[np.argmax(graph.radii)])
    world, some = loaded_world(kind, points[0], radius=10.0), 0
    for goal in points[1:]:
        route = world.route(points[0], goal, 0.25)
        assert route.status == "complete"
        fine = world.graph.find_path(points[0], route.fine.waypoints[-1], 0.25)
        assert route.fine.status == "complete" and route.fine.length == pytest.approx(fine.length, abs=0.5)
        if len(route.beyond):
            some += 1
            assert not world.is_loaded(route.beyond[:1])[0]
            assert np.array_equal(route.beyond[-1], goal)
            assert (graph.find_paths(route.beyond[:-1], route.beyond[1:], 0.25).status == "complete").all()
    assert some > 5


@pytest.mark.parametrize("kind", ["city", "clutter", "pieces"])
def test_a_walk_that_is_refined_as_chunks_come_in_arrives_and_is_not_much_longer(kind):
    graph, rng = whole(kind), np.random.default_rng(8)
    start = graph.positions[np.argmax(graph.radii)]
    for goal in graph.random_points(rng, 4, 0.25, reachable_from=start):
        world, at, walked = open_world(kind, radius=10.0), start, 0.0
        for _ in range(200):
            while world.keep_around(at, 4):
                pass
            route = world.route(at, goal, 0.25)
            assert route.status == "complete" and route.fine is not None
            line = route.fine.waypoints
            ahead = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
            far = min(5.0, ahead[-1])
            leg = int(np.searchsorted(ahead, far, side="right")) - 1
            if leg >= len(line) - 1:
                at, walked = line[-1], walked + far
            else:
                share = (far - ahead[leg]) / (ahead[leg + 1] - ahead[leg])
                at, walked = line[leg] + share * (line[leg + 1] - line[leg]), walked + far
            if not len(route.beyond) and far == ahead[-1]:
                break
        assert np.linalg.norm(at - goal) < 0.5
        expected = graph.find_path(start, goal, 0.25).length
        assert walked <= 1.15 * expected + 1.0


def test_a_link_across_a_border_is_not_lost(tmp_path):
    """Two floors at different heights, joined by nothing but a drop from one chunk into another."""
    chunks = {"high": terrain(box(0, 30, 0, 30, -1, 1.5)), "low": terrain(plane(30, 60, 0, 30))}
    world = OpenWorld(bake_open_world(chunks, tmp_path / "world", side=30.0))
    there = (5.0, 15.0, 1.5), (55.0, 15.0, 0.0)
    assert world.route(*there).status == "partial"
    assert world.route(*there, skills={"drop": (1.0, 2.0)}).status == "complete"
    assert world.route(*there, skills={"drop": (1.0, 1.4)}).status == "partial"
    assert world.route(*there[::-1], skills={"drop": (1.0, 2.0)}).status in ("partial", "no_path")
    world.keep_around((0.0, 15.0, 0.0))
    route = world.route(*there, skills={"drop": (1.0, 2.0)})
    assert route.fine is not None and len(route.beyond) > 0


def test_a_slimmer_body_gets_no_farther_than_the_radius_that_the_world_was_baked_for():
    """The statement of `OpenWorld.route`: conservative between the radii."""
    graph, world, rng = whole("clutter"), open_world("clutter"), np.random.default_rng(2)
    starts, goals = graph.random_points(rng, 300, RADII[1]).reshape(2, 150, 3)
    slim = graph.find_paths(starts, goals, 0.4).status == "complete"
    wide = graph.find_paths(starts, goals, RADII[1]).status == "complete"
    found = (
        np.array([world.route(a, b, 0.4).status for a, b in zip(starts, goals, strict=True)]) == "complete"
    )
    assert np.array_equal(found, wide) and (slim >= wide).all()


def test_the_same_questions_get_the_same_answers():
    points = whole("city").random_points(np.random.default_rng(1), 20, 0.25)

    def answers():
        world = loaded_world("city", points[0], radius=10.0)
        return [world.route(points[0], goal, 0.25).waypoints.tobytes() for goal in points]

    assert answers() == answers()


# --- wrong input
@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda w: w.keep_around("here"), "points: expected coordinates"),
        (lambda w: w.keep_around((1.0, 2.0)), "points: expected finite coordinates"),
        (lambda w: w.keep_around((1.0, 2.0, np.nan)), "points: expected finite coordinates"),
        (lambda w: w.keep_around((1.0, 2.0, 3.0), 0), "changes = 0: expected a whole number"),
        (lambda w: w.route((0, 0, 0), (1, 1)), "goal: expected finite coordinates"),
        (lambda w: w.route([(0, 0, 0), (1, 1, 1)], (1, 1, 1)), "start: expected three numbers"),
        (lambda w: w.route((0, 0, 0), (1, 1, 1), 0.7), "radius = 0.7 m: the world was baked for bodies of"),
        (lambda w: w.route((0, 0, 0), (1, 1, 1), -1), "radius = -1: expected a body's radius"),
        (lambda w: w.route((0, 0, 0), (1, 1, 1), skills={"fly": (0, 1)}), "skill 'fly': expected one of"),
        (lambda w: OpenWorld(w._folder, 0.0), "radius = 0.0: expected a length"),
        (lambda w: OpenWorld(w._folder, 50.0, 20.0), "drop_beyond = 20 m: expected at least the radius"),
    ],
)
def test_wrong_input_is_refused(ask, message):
    with pytest.raises(NavmeshError, match=message):
        ask(open_world("pieces"))


# --- what a world of agents asks for
def row(tmp_path, radius):
    rows = {f"{i:02}": terrain(plane(10.0 * i, 10.0 * i + 10.0, 0, 10)) for i in range(20)}
    return OpenWorld(bake_open_world(rows, tmp_path / "world"), radius)


def test_what_is_held_is_not_dropped_and_what_is_needed_is_loaded_last(tmp_path):
    world = row(tmp_path, 12.0)
    world.keep_around((55.0, 5.0, 0.0), 100)
    assert world.loaded == ("04", "05", "06")
    far = (155.0, 5.0, 0.0)
    assert world.next_changes(far, 100) == ("15", "14", "16", "04", "05", "06")
    assert world.next_changes(far, 100, held=(35.0, 5.0, 0.0)) == ("15", "14", "16", "06")
    needed = world.next_changes((55.0, 5.0, 0.0), 100, needed=(105.0, 5.0, 0.0))
    assert needed == ("10",)
    world.change(needed)
    assert world.is_loaded((105.0, 5.0, 0.0))[0] and not world.next_changes(
        (55.0, 5.0, 0.0), 100, needed=(105.0, 5.0, 0.0)
    )
    assert world.next_changes((55.0, 5.0, 0.0), 100) == ("10",)


def test_a_copy_has_a_window_of_its_own(tmp_path):
    world = row(tmp_path, 12.0)
    world.keep_around((55.0, 5.0, 0.0), 100)
    graph, other = world.graph, copy(world)
    assert list(other.change(["07", "04"])) == ["07", "04"]
    assert world.loaded == ("04", "05", "06") and world.graph is graph
    assert other.loaded == ("05", "06", "07")
    assert other.change([]) == {}
    world.change(["07", "04"])
    assert agree(world.graph, other.graph)


def test_a_chunk_that_there_is_not_cannot_be_changed(tmp_path):
    world = row(tmp_path, 12.0)
    with pytest.raises(NavmeshError, match="no chunk '20'"):
        world.change(["01", "20"])
    assert world.loaded == ()


def test_the_digest_is_of_the_whole_world_whatever_is_loaded(tmp_path):
    world = row(tmp_path, 12.0)
    before = world.digest
    world.keep_around((55.0, 5.0, 0.0), 100)
    assert world.digest == before == OpenWorld(tmp_path / "world").digest
    other = bake_open_world({"00": terrain(plane(0, 10, 0, 10))}, tmp_path / "other")
    assert OpenWorld(other).digest != before


@pytest.mark.parametrize("kind", ["city", "pieces"])
def test_a_place_is_moved_to_where_a_body_fits_loaded_or_not(kind):
    world, graph, random = open_world(kind), whole(kind), np.random.default_rng(4)
    low, high = graph.terrain.bounds
    for radius in RADII:
        wide = graph.positions[graph.radii >= radius]
        for point in [
            *wide[random.integers(len(wide), size=20)],
            *random.uniform(low - 9.0, high + 9.0, (20, 3)),
        ]:
            place, near = world.place_near(point, radius, anywhere=True), world.place_near(point, radius)
            here = graph.find_path(place, place, radius)
            assert here.status == "complete" and np.linalg.norm(here.waypoints[0] - place) < 0.25
            off = np.linalg.norm(place - point)
            assert off < np.linalg.norm(wide - point, axis=1).min() + 0.25
            assert near is None or off < np.linalg.norm(near - point) + 0.01
            assert near is not None or off > 2.0 * radius
    with pytest.raises(NavmeshError, match=r"bodies of up to 0\.25, 0\.6 m"):
        world.place_near(low, 0.7)
