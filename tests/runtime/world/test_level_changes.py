"""Changes of the level that are worked out while the world goes on."""

import dataclasses
import threading

import numpy as np
import pytest

import navmesh
from runtime import Arrived, Blocked, RuntimeInputError, World, WorldState
from runtime.planning.level import Level
from runtime.world.level_changes import LevelChanges
from tests.runtime.changing_level import FLOORS, START, quad, two_floors

GOAL = (13.0, 2.0, 0.0)
DOOR = {"door": [(7.0, 0.5, 0.0), (7.0, 3.5, 0.0)], "back door": [(7.0, 5.0, 0.0), (7.0, 8.0, 0.0)]}


@pytest.fixture(scope="module")
def whole():
    return two_floors()


def chunks(world):
    return {chunk.name for chunk in world.graph.terrain.chunks}


def busy(graph, **options):
    """A world in which all kinds of bodies go from west to east."""
    world = World(graph, seed=3, **options)
    for k, body in enumerate(("human", "dog", "walker", "walker")):
        world.spawn(body, (1.0 + k % 2, 1.0 + 1.5 * k, 0.0)).go_to(GOAL, speed=1.5)
    return world


def test_it_comes_before_the_last_tick_of_the_time(whole):
    for within, ticks in ((0.5, 50), (0.01, 1), (0.001, 1), (0.025, 3)):
        world = World(whole)
        world.step(0.2)
        before = world.graph
        world.change_level({"bridge": None}, within=within)
        for _ in range(ticks - 1):
            world.step(0.01)
        assert world.graph is before
        world.step(0.01)
        assert "bridge" not in chunks(world)
        assert world.graph.update({"bridge": quad(*FLOORS["bridge"])}).terrain.digest == whole.terrain.digest


def test_agents_go_on_as_after_a_change_at_once_at_that_tick(whole):
    at_once, later = busy(whole), busy(whole)
    later.change_level({"bridge": None}, within=1.0)
    at_once.step(0.99)
    later.step(0.99)
    assert at_once.state_hash() != later.state_hash()  # one knows of the change
    at_once.change_level({"bridge": None})
    for _ in range(5):
        at_once.step(0.7)
        later.step(0.7)
        assert at_once.state_hash() == later.state_hash()
    for world in (at_once, later):
        world.step(20.0)
        assert {event.agent for event in world.events if isinstance(event, Arrived)} == set(world.agents)


def test_it_is_worked_out_in_another_thread_while_the_world_goes_on(whole, monkeypatch):
    go_on, update = threading.Event(), navmesh.NodeGraph.update

    def slow(graph, changes):
        assert go_on.wait(60.0)
        return update(graph, changes)

    monkeypatch.setattr(navmesh.NodeGraph, "update", slow)
    world = busy(whole)
    world.change_level({"bridge": None}, within=0.5)
    world.step(0.49)
    assert world.time == pytest.approx(0.49) and "bridge" in chunks(world)
    go_on.set()
    world.step(0.01)
    assert "bridge" not in chunks(world)


def test_several_come_in_order_and_the_earlier_ones_with_a_later_one_that_is_due_before(whole):
    world = World(whole)
    world.change_level({"bridge": None}, within=0.5)
    world.change_level({"new": quad(16.0, 0.0, 18.0, 8.0)}, within=0.8)
    world.change_level({"new": None, "detour": None}, within=0.9)
    world.step(0.5)
    assert chunks(world) == set(FLOORS) - {"bridge"}
    world.step(0.3)
    assert chunks(world) == set(FLOORS) - {"bridge"} | {"new"}
    world.change_level({"apart": None}, within=0.05)
    world.step(0.05)
    assert chunks(world) == {"west", "east"}
    world.change_level({"bridge": quad(*FLOORS["bridge"])}, within=3.0)
    world.change_level({"bridge": None})  # at once
    assert chunks(world) == {"west", "east"}
    world.change_level({"west": quad(*FLOORS["west"])}, within=0.1)  # as it is
    before = world.graph
    world.step(0.5)
    assert world.graph is before


def test_a_run_is_the_same_with_more_threads_from_a_file_and_in_another_world(whole, tmp_path):
    changes = [(0.3, {"bridge": None}, 0.7), (0.6, {"apart": None, "new": quad(16.0, 0.0, 18.0, 8.0)}, 0.2)]
    changes.append((1.1, {"bridge": quad(*FLOORS["bridge"])}, 0.55))
    paint = navmesh.Terrain.from_arrays(
        quad(*FLOORS["detour"]).vertices, quad(*FLOORS["detour"]).faces, materials=["mud", "grass"]
    )
    changes.append((1.2, {"detour": paint}, 0.9))

    def run(world, end=3.0):
        for begin, change, within in changes:
            if begin >= world.time - 1e-6 and begin < end:
                world.step(begin - world.time)
                world.change_level(change, within)
        world.step(end - world.time)
        return world

    expected = run(busy(whole)).state_hash()
    assert run(busy(whole, threads=3)).state_hash() == expected
    early = run(busy(whole), 0.7)
    seen = early.state_hash()
    early.save().write(tmp_path / "state.npz")
    other = World(whole, seed=9)
    other.spawn("walker", START)
    other.change_level({"east": None}, within=0.1)
    other.restore(WorldState.read(tmp_path / "state.npz"))
    assert other.state_hash() == seen
    assert run(other).state_hash() == expected
    again = run(busy(whole), 0.7)
    state = again.save()
    again.change_level({"east": None}, within=0.5)
    again.restore(state)
    assert run(again).state_hash() == expected


def test_the_hash_tells_of_what_is_coming(whole):
    world, seen = World(whole), set()
    state = world.save()
    for changes, within in (
        ({"bridge": None}, 0.5), ({"bridge": None}, 0.6), ({"bridge": quad(0.0, 0.0, 1.0, 1.0)}, 0.5),
    ):  # fmt: skip
        seen.add(world.state_hash())
        world.restore(state)
        world.change_level(changes, within)
    assert len(seen | {world.state_hash()}) == 4
    world.restore(state)
    world.step(1.0)
    assert chunks(world) == set(FLOORS)


@pytest.mark.parametrize("late", [False, True])
def test_doors_that_are_shut_and_opened_meanwhile_are_as_they_were_left(whole, late):
    world = busy(whole.with_zones(DOOR))
    world.block("door")
    world.change_level({"apart": None}, within=0.5)
    if late:
        world.step(0.4)
    world.open("door")
    world.block("back door")
    world.step(0.5)
    assert chunks(world) == set(FLOORS) - {"apart"}
    assert world.graph.zones == {"door": False, "back door": True}
    expected = whole.update({"apart": None}).with_zones(DOOR)
    expected.block("back door")
    ways = [graph.find_path(START, GOAL).waypoints for graph in (world.graph, expected)]
    assert np.array_equal(*ways) and ways[0][:, 1].max() < 4.0
    world.block("door")
    world.step(0.1)
    assert any(isinstance(event, Blocked) for event in world.events)


def test_what_is_wrong_at_once_is_said_at_once(whole):
    world = busy(whole)
    world.change_level({"bridge": None}, within=0.5)
    before = world.state_hash()
    for changes, says in (
        ({"bridge": None}, "no chunk 'bridge' to remove"),
        ({"wall": [1, 2, 3]}, "chunk 'wall' is a list"),
        ({name: None for name in FLOORS if name != "bridge"}, "removes all chunks"),
    ):
        for within in (0.0, 0.5):
            with pytest.raises(navmesh.NavmeshError, match=says):
                world.change_level(changes, within)
    for within in (-0.1, np.nan, "soon"):
        with pytest.raises(RuntimeInputError, match="within"):
            world.change_level({"apart": None}, within)  # type: ignore[arg-type]
    assert world.state_hash() == before


def test_what_turns_out_later_stops_the_step_and_the_world_can_go_on(whole):
    world, other = busy(whole), busy(whole)
    world.change_level({**dict.fromkeys(FLOORS), "speck": quad(0.0, 0.0, 0.1, 0.1)}, within=0.5)
    new = {"new": quad(16.0, 0.0, 18.0, 8.0)}
    world.change_level(new, within=0.6)
    with pytest.raises(navmesh.NavmeshError, match=r"'speck', asked for before, .*nothing to walk on"):
        world.step(1.0)
    assert world.time == pytest.approx(0.49) and chunks(world) == set(FLOORS)
    other.step(0.49)
    other.change_level(new, within=0.11)
    world.step(0.0)  # what it owes
    other.step(1.0 - other.time)
    assert world.state_hash() == other.state_hash() and "new" in chunks(world)


def test_one_that_fails_before_a_change_at_once_is_told_of_and_neither_is_made(whole):
    world = World(whole)
    world.change_level({**dict.fromkeys(FLOORS), "speck": quad(0.0, 0.0, 0.1, 0.1)}, within=0.5)
    with pytest.raises(navmesh.NavmeshError, match="no chunk 'apart' to remove"):
        world.change_level({"apart": None})  # it would not be there
    with pytest.raises(navmesh.NavmeshError, match="nothing to walk on"):
        world.change_level({"new": quad(16.0, 0.0, 18.0, 8.0)})
    assert chunks(world) == set(FLOORS)
    world.change_level({"apart": None})
    assert "apart" not in chunks(world)


def test_queries_after_it_find_what_they_need(whole):
    world = World(whole)
    walker = world.spawn("walker", START, radius=0.35)
    walker.go_to(GOAL)
    world.graph.find_path(START, GOAL, radius=0.2, skills={"drop": (0.2, 1.0)})
    world.change_level({"apart": None}, within=0.2)
    world.step(0.2)
    kept = world.graph.cache
    assert {0.2, 0.35} <= set(kept["parts"]) and kept["gates"]
    assert (0.2, (("drop", 0.2, 1.0),), None) in kept["doors"]


def damaged(state, **changes):
    (coming,) = state.coming
    return dataclasses.replace(state, coming=(dataclasses.replace(coming, **changes),))


def test_damaged_ones_are_refused(whole):
    world = busy(whole)
    world.step(0.2)
    world.change_level({"new": quad(16.0, 0.0, 18.0, 8.0)}, within=0.5)
    state, before = world.save(), world.state_hash()
    mesh = state.coming[0].chunks["new"]
    for each in (
        damaged(state, due=3),
        damaged(state, chunks={"no": None}),
        damaged(state, chunks=dict.fromkeys(FLOORS)),
        damaged(state, chunks={"new": mesh._replace(faces=mesh.faces + 4)}),
        damaged(state, chunks={"new": mesh._replace(vertices=mesh.vertices * np.nan)}),
        damaged(state, chunks={"new": mesh._replace(materials=("mud",), face_material=mesh.faces[:, 0] + 9)}),
    ):
        with pytest.raises(RuntimeInputError, match="does not fit"):
            world.restore(each)
        assert world.state_hash() == before
    world.step(0.5)
    assert "new" in chunks(world)


def test_without_any_nothing_is_due():
    level = Level.of(two_floors())
    changes = LevelChanges(lambda level, changes: level)
    assert not changes.due(1e9) and changes.digest() == () and changes.save() == ()
    changes.begin(level, {"bridge": None}, 7)
    assert not changes.due(6) and changes.due(7)
    assert changes.end().graph is level.graph and not changes.due(7)
