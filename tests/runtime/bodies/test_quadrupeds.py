"""Dogs, cats and horses in worlds and missions."""

from importlib import import_module
from importlib.resources import files

import numpy as np
import pytest

import navmesh
import pathsmooth
from locomotion.quadruped import manoeuvres
from runtime import Arrived, Blocked, Departed, RuntimeInputError, World
from runtime.missions.check import prepare_mission
from runtime.missions.mission import load_mission
from runtime.missions.run import run_mission
from runtime.planning.rules import walk_rules
from runtime.traces.trace import Trace
from runtime.views.view import write_page
from surefoot.files.yamlfile import FileError
from surefoot.progress import Progress
from tests.small_level import MISSION


def test_a_dog_goes_where_it_is_told(graph):
    world = World(graph)
    dog = world.spawn("dog", (2.0, 3.0, 0.0))
    assert dog.go_to((9.0, 4.0, 0.0), speed=1.5, facing=1.0) == "running"
    assert isinstance(world.events[0], Departed)
    while dog.status == "running":
        world.step(0.1)
    assert dog.status == "arrived" and isinstance(world.events[-1], Arrived)
    assert dog.position == pytest.approx([9.0, 4.0, 0.0], abs=0.02)
    assert dog.facing == pytest.approx(1.0, abs=0.03)
    assert dog.plans and dog.progress == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("facing", [0.0, 3.0])
def test_a_path_is_smoothed_once_for_an_order(graph, monkeypatch, facing):
    """That takes long; who faces away asks only for a route from where it will have turned."""
    smoothed, tightening = [], pathsmooth.tightening
    monkeypatch.setattr(
        pathsmooth, "tightening", lambda *problem: (smoothed.append(1), tightening(*problem))[1]
    )
    world = World(graph)
    dog = world.spawn("dog", (2.0, 3.0, 0.0), facing)
    dog.go_to((9.0, 4.0, 0.0), speed=1.5)
    assert len(smoothed) == 1
    told = world.events[0]
    assert isinstance(told, Departed)
    assert told.length == pytest.approx(np.hypot(7.0, 1.0), rel=0.05)
    assert dog.go_to((200.0, 4.0, 0.0)) == "blocked" and isinstance(world.events[-1], Blocked)
    assert len(smoothed) == 1


def test_no_order_waits_for_the_tables_of_turns(graph, monkeypatch):
    """They are made when the first dog is spawned."""
    local_motion = import_module("locomotion.quadruped.local_motion")  # not the function of that name
    local_motion._table_for.cache_clear()
    manoeuvres._moves_for.cache_clear()
    solved, solve = [], local_motion._solve
    monkeypatch.setattr(local_motion, "_solve", lambda *wanted: (solved.append(1), solve(*wanted))[1])
    world = World(graph)
    dog = world.spawn("dog", (2.0, 3.0, 0.0), 3.0)
    assert len(solved) == 1 and manoeuvres._moves_for.cache_info().currsize == 1
    dog.go_to((9.0, 4.0, 0.0), speed=1.5)
    world.step(0.1)
    assert len(solved) == 1


def test_a_person_and_animals_share_a_world(graph):
    world = World(graph)
    agents = [
        world.spawn(body, (2.0 + k, 3.0, 0.0)) for k, body in enumerate(("human", "dog", "cat", "horse"))
    ]
    assert [agent.name for agent in agents] == ["human1", "dog2", "cat3", "horse4"]
    for agent in agents:
        pose = agent.pose
        assert pose.transforms.shape == (len(pose.names), 7) and pose.parents[0] == -1
        assert np.linalg.norm(pose.transforms[:, 3:], axis=1) == pytest.approx(1.0)
        assert len(agent.figure.posed(pose.transforms).size) > 10
    with pytest.raises(RuntimeInputError, match="is a dog, not a Human"):
        _ = agents[1].human
    assert agents[1].animal.body.name == "dog"


def test_a_restored_world_with_a_dog_goes_on_the_same_way(graph):
    world = World(graph, seed=5)
    dog = world.spawn("dog", (2.0, 3.0, 0.0))
    cat = world.spawn("cat", (2.0, 4.0, 0.0))
    dog.go_to((9.0, 3.0, 0.0), speed=2.0)
    world.step(1.0)
    saved = world.save()
    hashes = set()
    for _ in range(2):
        cat.go_to((6.0, 4.0, 0.0), speed=1.0)
        world.step(1.0)
        hashes.add((world.state_hash(), len(world.events)))
        world.restore(saved)
    assert len(hashes) == 1
    assert World(graph, seed=5).state_hash() != world.state_hash()


def test_a_goal_in_a_wall_or_off_the_level_blocks_it(graph):
    world = World(graph)
    dog = world.spawn("dog", (2.0, 3.0, 0.0))
    for goal in ((18.0, 3.0, 0.0), (50.0, 3.0, 0.0)):
        assert dog.go_to(goal) == "blocked"
        assert isinstance(world.events[-1], Blocked)
    before, feet = dog.position, dog.animal.herd.toes(dog.animal.index)
    world.step(0.5)
    assert dog.position == pytest.approx(before, abs=1e-3)
    assert np.array_equal(dog.animal.herd.toes(dog.animal.index), feet)
    with pytest.raises(RuntimeInputError, match="speed"):
        dog.go_to((6.0, 3.0, 0.0), speed=-1.0)


def test_a_horse_that_is_told_to_go_where_its_rear_feet_are_says_that_it_cannot(graph):
    world = World(graph)
    horse = world.spawn("horse", (4.0, 3.0, 0.0))
    assert horse.go_to((4.0, 3.0, 0.0)) == "blocked"
    assert isinstance(world.events[-1], Blocked)
    assert horse.go_to((9.0, 3.0, 0.0)) == "running"


def test_a_horse_beside_walls_turns_or_says_that_it_cannot():
    corners = np.array([(0.0, 0.0, 0.0), (8.0, 0.0, 0.0), (8.0, 2.6, 0.0), (0.0, 2.6, 0.0)])
    lane = navmesh.Terrain.from_arrays(corners, np.array([(0, 1, 2), (0, 2, 3)]))
    world = World(navmesh.NodeGraph.build(lane, walk_rules(["horse"])))
    for place in ((4.0, 1.3), (4.0, 0.7), (4.0, 1.9)):
        horse = world.spawn("horse", (*place, 0.0))
        assert horse.go_to((1.0, 1.3, 0.0)) in ("running", "blocked")  # that is behind it
        while horse.moving:
            world.step(0.1)
        assert horse.status in ("arrived", "stuck")
        horse.remove()


def test_a_dog_needs_room_for_its_head():
    corners = [(0, 0, 0), (6, 0, 0), (6, 4, 0), (0, 4, 0), (3, 0, 0), (3, 4, 0), (3, 4, 1.5), (3, 0, 1.5)]
    faces = [(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)]
    terrain = navmesh.Terrain.from_arrays(np.array(corners, float), np.array(faces))
    world = World(navmesh.NodeGraph.build(terrain, walk_rules(["dog"], resolution=0.1)))
    with pytest.raises(RuntimeInputError, match="has no room for its head"):
        world.spawn("dog", (2.3, 2.0, 0.0), facing=0.0)
    world.spawn("dog", (2.2, 2.0, 0.0), facing=np.pi)


def test_a_mission_with_a_dog_runs_and_is_drawn(folder):
    text = MISSION.replace("body: human", "body: dog").replace("speed: 3.0", "speed: 2.0")
    (folder / "mission.yaml").write_text(text)
    loaded = load_mission(folder / "mission.yaml")
    assert loaded.rules().headroom < 1.0
    result = run_mission(loaded)
    assert result.held, result.checks
    result.trace.write(folder / "trace.npz")
    trace = Trace.read(folder / "trace.npz")
    assert trace.state_hash == result.trace.state_hash
    write_page(trace, folder / "run.html")
    assert (folder / "run.html").stat().st_size > 50_000


def mutt(folder, old, new):
    """The path of a dog's file with one change."""
    text = (files("locomotion.data") / "bodies" / "dog.yaml").read_text()
    assert old in text
    (folder / "mutt.yaml").write_text(text.replace(old, new, 1))
    return str(folder / "mutt.yaml")


def test_a_body_of_ones_own_lives_in_a_world(graph, tmp_path):
    path = mutt(tmp_path, "look_ahead: 0.6", "look_ahead: 0.9")
    world = World(graph)
    dog = world.spawn(path, (2.0, 3.0, 0.0))
    assert dog.name == "mutt1" and dog.animal.body.head.look_ahead == 0.9
    saved = world.save()
    dog.go_to((4.0, 3.0, 0.0))
    world.step(0.5)
    world.remove(dog)
    world.restore(saved)
    assert world.agents["mutt1"].animal.body.head.look_ahead == 0.9


def test_a_body_that_does_not_add_up_names_its_line(graph, tmp_path):
    world = World(graph)
    with pytest.raises(RuntimeInputError, match=r"mutt\.yaml:[0-9]+:[0-9]+: .*4 bones of 0.11 m make 0.44 m"):
        world.spawn(mutt(tmp_path, "length: 0.44, bones: 4", "length: 0.50, bones: 4"), (2.0, 3.0, 0.0))
    for body in ("mutt", str(tmp_path / "none.yaml")):
        with pytest.raises(RuntimeInputError, match=r"valid: .*\.yaml|none\.yaml"):
            world.spawn(body, (2.0, 3.0, 0.0))
    assert not world.agents


def test_a_mission_names_a_body_file_beside_it(folder, monkeypatch):
    mutt(folder, "look_ahead: 0.6", "look_ahead: 0.9")
    mission = folder / "mission.yaml"
    mission.write_text(MISSION.replace("body: human", "body: mutt.yaml").replace("speed: 3.0", "speed: 2.0"))
    monkeypatch.chdir(folder.parent)
    loaded = load_mission(mission)
    assert loaded.rules() == walk_rules([str(folder / "mutt.yaml")])
    world = prepare_mission(loaded, Progress(shown=False)).world
    assert world.agents["ada"].animal.body.head.look_ahead == 0.9


@pytest.mark.parametrize(
    ("body", "says"),
    [
        ("none.yaml", r"no such body file: .*none\.yaml"),
        ("mutt.yaml", r"mutt\.yaml:[0-9]+:[0-9]+: .*4 bones of 0.11 m make 0.44 m"),
    ],
)
def test_a_mission_with_a_body_file_that_does_not_hold_is_refused(folder, body, says):
    mutt(folder, "length: 0.44, bones: 4", "length: 0.50, bones: 4")
    (folder / "mission.yaml").write_text(MISSION.replace("body: human", f"body: {body}"))
    with pytest.raises(FileError, match=rf"mission\.yaml:8:11: agents\[0\]\.body: .*{says}"):
        load_mission(folder / "mission.yaml")
