"""Missions on an open world, of which only what is around its players is loaded."""

import shutil

import numpy as np
import pytest

import navmesh
from runtime import Departed, Waiting
from runtime.missions.check import prepare_mission
from runtime.missions.mission import load_mission
from runtime.missions.run import run_mission
from runtime.planning.rules import obstacle_rules, person_walk_rules
from surefoot.files.yamlfile import FileError
from surefoot.progress import Progress
from tests.runtime.changing_level import quad
from tests.runtime.missions.scripts import verdicts
from tests.runtime.strip import strip_folder

ADA = "  - {name: ada, body: walker, start: [4, 5, 0], speed: 4, goto: [end]}\n"
BOB = "  - {name: bob, body: walker, start: [6, 3, 0], speed: 4, goto: [end]}\n"
HEAD = """\
level: {file: strip.world, radius: 25}
time_limit: 60
waypoints: {end: [116, 5, 0], island: [45, 95, 0]}
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "strip.world").symlink_to(strip_folder())
    return tmp_path


def mission(folder, agents, head=HEAD):
    (folder / "mission.yaml").write_text(head + "agents:\n" + agents)
    return load_mission(folder / "mission.yaml")


def prepared(*parts):
    return prepare_mission(mission(*parts), Progress(shown=False))


def test_agents_go_to_places_that_are_not_loaded_and_the_trace_has_all_that_was(folder):
    loaded = mission(folder, ADA + BOB)
    world, _ = ready = prepare_mission(loaded, Progress(shown=False))
    assert [agent.name for agent in world.players] == ["ada", "bob"] and "11" not in world.loaded
    result = run_mission(loaded, prepared=ready)
    assert result.held and not [event for event in result.events if isinstance(event, Waiting)]
    assert "00" not in world.loaded
    level = result.trace.level
    assert np.ptp(level.vertices, axis=0)[:2] == pytest.approx([120.0, 10.0])
    assert np.ptp(level.positions[:, 0]) > 100.0


def test_others_than_the_players_wait_for_them(folder):
    walks = ADA.replace("goto: [end]", "script: [{wait: 15}, {goto: end}]") + BOB
    result = run_mission(mission(folder, walks, HEAD + "players: [ada]\n"))
    assert result.held
    told = [type(event) for event in result.events if event.agent == "bob"]
    assert told[:3] == [Departed, Waiting, Departed]


def test_players_may_be_places(folder):
    head = HEAD + "players: [end, [60, 5, 0]]\n"
    world, _ = prepared(folder, BOB, head)
    assert {"00", "05", "11"} <= set(world.loaded) and "02" not in world.loaded
    assert not run_mission(mission(folder, BOB, HEAD + "players: []\n")).held


def test_one_follows_another_through_what_was_not_loaded(folder):
    rex = "  - {name: rex, body: walker, start: [2, 3, 0], speed: 5,\n"
    rex += "     script: [{follow: {agent: ada, distance: 3}}],\n"
    rex += "     expect: {keeps_distance: [{to: ada, at_most: 8, after: 5}]}}\n"
    result = run_mission(mission(folder, ADA + rex, HEAD + "players: [ada]\n"))
    assert result.held, verdicts(result)


def test_one_that_follows_somebody_far_away_waits_until_the_way_is_loaded(folder):
    far = ADA.replace("[4, 5, 0]", "[100, 5, 0]").replace(
        "goto: [end]", "script: [{wait: 4}, {goto: [[6, 5, 0]]}]"
    )
    rex = "  - {name: rex, body: walker, start: [4, 3, 0], speed: 4,\n"
    rex += "     script: [{follow: {agent: ada, distance: 3}}]}\n"
    result = run_mission(mission(folder, far + rex, HEAD + "players: [ada]\n"))
    kinds = [type(event) for event in result.events if event.agent == "rex"]
    assert result.held and Waiting in kinds and Departed in kinds[kinds.index(Waiting) :]


def test_a_skill_is_used_on_an_obstacle_that_is_not_loaded_yet(tmp_path):
    floors = {f"{k}": quad(10.0 * k, 0.0, 10.0 * (k + 1), 10.0, 0.4 * (k > 3)) for k in range(6)}
    riser = [(40.0, y, z) for y in (0.0, 10.0) for z in (0.0, 0.4)]
    floors["riser"] = navmesh.Terrain.from_arrays(riser, [(0, 1, 3), (0, 3, 2)])
    rules = person_walk_rules(), obstacle_rules({})
    navmesh.bake_open_world(floors, tmp_path / "ledge.world", (0.3,), 20.0, *rules)
    agents = """\
  - {name: ada, start: [4, 5, 0], speed: 3, script: [{use: {skill: jump, near: [40, 5, 0]}}],
     expect: {uses_skills: [jump]}}
"""
    loaded = mission(tmp_path, agents, "level: {file: ledge.world, radius: 12}\n")
    world, clearings = prepare_mission(loaded, Progress(shown=False))
    assert not world.open_world.is_loaded([40.0, 5.0, 0.0])[0]
    ((before, beyond),) = clearings.values()
    assert before == pytest.approx([32.0, 5.0, 0.0], abs=0.3) and beyond[0] > 42.0
    assert run_mission(loaded).held
    with pytest.raises(FileError, match="no obstacle to vault lies within 3 m"):
        prepared(tmp_path, agents.replace("{skill: jump", "{skill: vault"), "level: {file: ledge.world}\n")


USE = "  - {name: ada, start: [4, 5, 0], script: [{use: {skill: jump, obstacle: ledge}}]}\n"


@pytest.mark.parametrize(
    ("agents", "head", "at", "says"),
    [
        (ADA.replace("end", "island"), HEAD, "island]}", "cannot be reached: no way leads there"),
        (
            ADA.replace("end", "[99, 12, 0]"),
            HEAD,
            "[99",
            "the nearest place where a walker fits is [99.12, 9.6",
        ),
        (ADA.replace("5, 0", "5, 1"), HEAD, "[4, 5, 1", "1.00 m above the floor"),
        (ADA, HEAD.replace("strip.world", "."), "., ", "a folder without an open world; expected a mesh"),
        (ADA, HEAD.replace("radius: 25", "up: z"), "z}", "level.up: an open world is as it was baked"),
        (
            ADA,
            HEAD + "rules: {max_step: 0.2}\n",
            "{max",
            "an open world has the rules that it was baked with",
        ),
        (
            ADA,
            HEAD + "players: [adda]\n",
            "adda",
            "no agent or waypoint is called 'adda'; did you mean 'ada'",
        ),
        (ADA, HEAD.replace("25", "-2"), "-2", "greater than 0"),
        (USE, HEAD, "ledge", "obstacles of an open world have no names; say near: [x, y, z]"),
    ],
)
def test_what_does_not_fit_is_refused_with_its_place(folder, agents, head, at, says):
    with pytest.raises(FileError) as caught:
        prepared(folder, agents, head)
    before = (head + "agents:\n" + agents).split(at)[0].split("\n")
    assert says in str(caught.value)
    assert f"mission.yaml:{len(before)}:{len(before[-1]) + 1}: " in str(caught.value)


def test_a_level_that_is_a_mesh_has_no_players_and_no_radius(folder):
    (folder / "level.obj").write_text("v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n")
    for head in ("level: {file: level.obj, radius: 9}\n", "level: {file: level.obj}\nplayers: [ada]\n"):
        with pytest.raises(FileError, match="for open worlds; the level is a mesh"):
            mission(folder, ADA.replace("end", "[1, 1, 0]"), head)


def test_a_body_that_the_world_was_not_baked_for_is_named(folder):
    navmesh.bake_open_world(quad(0.0, 0.0, 10.0, 10.0), folder / "slim.world", (0.2,))
    with pytest.raises(
        FileError, match=r"mission.yaml:5:23: .*0.3 m: the world was baked for bodies of up to 0.2"
    ):
        prepared(folder, ADA, HEAD.replace("strip", "slim"))


def test_a_damaged_world_is_named(folder):
    (folder / "strip.world").unlink()
    damaged = shutil.copytree(strip_folder(), folder / "strip.world")
    (damaged / "chunk-00001.npz").unlink()
    with pytest.raises(FileError, match=r"mission.yaml:1:15: level.file: .*chunk-00001"):
        prepared(folder, ADA)
