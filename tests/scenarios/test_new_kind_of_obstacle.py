"""A kind of obstacle that the package does not know: made here, registered with one call, and then found in a
level, cleared by people, told of in missions and playtests, saved and drawn like the others."""

import contextlib
import json
from collections.abc import Iterator

import numpy as np
import pytest
import trimesh

import navmesh
from locomotion import LocomotionError, SkillKind, register_skill, skill_kinds, unregister_skill
from locomotion.gaits.run.skill import RunSkill
from locomotion.human.saved_state_check import check_person
from locomotion.human.state import MOVING
from locomotion.skills.description import load_description
from locomotion.skills.jump.skill import Jump, load_jump_skill
from locomotion.skills.leap.kind import LEAP_DESCRIPTION
from runtime import World, WorldState
from runtime.cli.app import main
from runtime.events import SkillFinished, SkillStarted
from runtime.missions.check import prepare_mission
from runtime.missions.mission import load_mission, mission_schema
from runtime.missions.run import run_mission
from runtime.playtest import playtest
from runtime.playtest.character import character_of
from runtime.playtest.wording import Wording
from runtime.views.page_data import page_data
from surefoot.files.archive import ArchiveError
from surefoot.files.yamlfile import FileError
from surefoot.progress import Progress

EDGE, WIDE = 16.0, 1.2  # [m]
TAGS = f"""\
add:
  - {{name: brook, affordance: brook, position: [{EDGE}, 4, 0], run_towards_deg: 0, depth: {WIDE}, width: 6}}
remove:
  - {{at: [{EDGE}, 4, 0], affordance: gap}}
  - {{at: [{EDGE + WIDE}, 4, 0], affordance: gap}}
"""
MISSION = """\
level: {file: level.obj}
time_limit: 30
agents:
  - name: ada
    start: [4, 4, 0]
    script: [{use: {skill: bound, obstacle: brook}}]
    expect: {never_falls: true, uses_skills: [bound]}
"""
PLAN = """\
character: {skills: {brook: [0.4, 1.8]}}
spawns: [{name: here, at: [4, 4, 0]}]
places: [{name: beyond, at: [26, 4, 0]}]
"""


def load_bound(run: RunSkill) -> Jump:
    """People bound over a brook as they leap over a gap."""
    leap = load_description(LEAP_DESCRIPTION)
    return Jump(load_jump_skill(leap.learned, leap.kind), run, "brook", leap.load_clip())


BOUND = SkillKind(
    obstacle=navmesh.ObstacleKind("brook", "across", effort=(0.5, 1.0)),
    skill="bound",
    status="bounding",
    verb="bound",
    does="bounds over a brook of {:.2f} m",
    colour="#1e90ff",
    sizes=(0.4, 1.8),
    usual=1.0,
    load=load_bound,
)


@contextlib.contextmanager
def bounding() -> Iterator[None]:
    register_skill(BOUND)
    try:
        yield
    finally:
        unregister_skill("brook")


@pytest.fixture(scope="module", autouse=True)
def registered():
    with bounding():
        yield


@pytest.fixture(scope="module")
def level(tmp_path_factory):
    """Two floors and a trench between them, which tags call a brook."""
    folder = tmp_path_factory.mktemp("brook")
    parts = [((0, 0, -4), (EDGE, 8, 0)), ((EDGE, 0, -4), (EDGE + WIDE, 8, -3))]
    parts += [((EDGE + WIDE, 0, -4), (32, 8, 0))]
    trimesh.util.concatenate([trimesh.creation.box(bounds=part) for part in parts]).export(
        folder / "level.obj"
    )
    (folder / "level.tags.yaml").write_text(TAGS)
    (folder / "mission.yaml").write_text(MISSION)
    return folder / "level.obj"


@pytest.fixture(scope="module")
def graph(level):
    terrain = navmesh.Terrain.load(level, up="z")
    return navmesh.NodeGraph.build(terrain, tags=navmesh.load_tags(navmesh.tags_path(level)))


@pytest.fixture(scope="module")
def result(level):
    loaded = load_mission(level.with_name("mission.yaml"))
    return run_mission(loaded, prepared=prepare_mission(loaded, Progress(shown=False)))


def test_the_graph_leads_over_it_and_its_file_keeps_it(graph, tmp_path):
    assert graph.obstacles.affordance.tolist() == ["brook"]
    assert graph.obstacles.size == pytest.approx([WIDE])
    assert graph.obstacles.landing[0] > 10.0 and graph.obstacles.rise[0] == 0.0
    straight = [np.linalg.norm(link) for link in graph.links.end - graph.links.start]
    assert graph.links.cost == pytest.approx(np.array(straight) + 0.5 + WIDE, abs=0.1)
    ways = {"brook": (0.4, 1.8)}
    start, goal = (4.0, 4.0, 0.0), (28.0, 4.0, 0.0)
    assert graph.find_path(start, goal, radius=0.3, skills=ways).status == "complete"
    assert graph.find_path(start, goal, radius=0.3, skills={"gap": (0.4, 1.8)}).status != "complete"
    graph.save(tmp_path / "graph.npz")
    again = navmesh.NodeGraph.load(tmp_path / "graph.npz")
    assert again.links.affordance.tolist() == ["brook"] * len(graph.links)
    assert again.find_path(start, goal, radius=0.3, skills=ways).status == "complete"


def test_a_person_clears_it_and_a_saved_world_goes_on_in_the_middle_of_it(graph, tmp_path):
    world = World(graph, seed=4)
    ada = world.spawn("human", (4.0, 4.0, 0.0), name="ada")
    assert ada.skills["brook"] == pytest.approx((0.38, 1.82))
    ada.go_to((28.0, 4.0, 0.0), speed=3.4)
    while ada.moving and ada.status != "bounding":
        world.step(0.05)
    assert ada.status == "bounding" and ada.status in MOVING and ada.moving
    world.save().write(tmp_path / "state.npz")
    other = World(graph, seed=4)
    other.restore(WorldState.read(tmp_path / "state.npz"))
    for _ in range(40):
        world.step(0.05)
        other.step(0.05)
    assert other.agents["ada"].pose.transforms.tobytes() == ada.pose.transforms.tobytes()
    done = [event for event in world.events if isinstance(event, SkillStarted | SkillFinished)]
    assert [(type(event).__name__, event.skill) for event in done] == [
        ("SkillStarted", "bound"),
        ("SkillFinished", "bound"),
    ]
    assert str(done[0]) == "ada bounds over a brook of 1.20 m"


def test_a_person_does_nothing_else(graph):
    world = World(graph, seed=4)
    ada = world.spawn("human", (4.0, 4.0, 0.0), name="ada")
    state = ada.human.save_state()
    check_person(state, ada.human)
    with pytest.raises(LocomotionError, match="'flying'"):
        check_person(state._replace(status="flying"), ada.human)


def test_a_mission_uses_it(level, result):
    assert result.held, result.checks
    assert any(isinstance(event, SkillFinished) and event.skill == "bound" for event in result.events)
    assert '"bound"' in json.dumps(mission_schema())
    wrong = level.with_name("wrong.yaml")
    wrong.write_text(MISSION.replace("skill: bound", "skill: leap"))
    with pytest.raises(FileError, match="no obstacle to leap is called 'brook'"):
        prepare_mission(load_mission(wrong), Progress(shown=False))


def test_pictures_show_it_in_its_colour(result):
    header, _ = page_data(result.trace, None)
    assert header["level"]["colours"] == {"brook": pytest.approx([0x1E / 255, 0x90 / 255, 1.0])}
    assert header["level"]["obstacles"][0]["affordance"] == "brook"


def test_a_playtest_tries_it(level):
    report = playtest(level, bots=6, seconds=60.0, seed=3).report
    (crossing,) = report.crossings
    assert (crossing.tag, crossing.affordance) == ("brook", "brook")
    assert crossing.attempts == crossing.cleared > 0
    walker = Wording(character_of("walker"))
    assert walker.leaps(3.0) == "a person leaps 0.40 to 2.50 m and bounds 0.40 to 1.80 m"


def test_people_play_it_by_a_plan_that_names_it(level):
    plan = level.with_name("people.yaml")
    plan.write_text(PLAN)
    report = playtest(level, bots=2, seconds=30.0, seed=3, body="human", plan=plan).report
    (crossing,) = report.crossings
    assert crossing.cleared > 0
    plan.write_text(PLAN.replace("brook:", "ford:"))
    with pytest.raises(FileError, match="'gap' or 'brook', not 'ford'"):
        playtest(level, bots=2, seconds=30.0, seed=3, body="human", plan=plan)


def test_the_command_lists_it(level, capsys, monkeypatch):
    monkeypatch.setattr("runtime.cli.commands.ready", lambda: Progress(shown=False))  # compiles nothing ahead
    with pytest.raises(SystemExit):
        main(["obstacles", str(level), "--up", "z", "--json"])
    (listed,) = json.loads(capsys.readouterr().out)["obstacles"]
    assert (listed["tag"], listed["skill"], listed["affordance"]) == ("brook", "bound", "brook")


def test_names_are_unique_and_the_packages_kinds_stay():
    before = skill_kinds()
    with pytest.raises(LocomotionError, match="brook"):
        register_skill(BOUND)
    with pytest.raises(LocomotionError, match="comes with the package"):
        unregister_skill("vault")
    with pytest.raises(LocomotionError, match="'ford': valid: jump, vault"):
        unregister_skill("ford")
    assert skill_kinds() == before


def test_what_knows_it_is_refused_where_it_is_not_registered(graph, level, tmp_path):
    graph.save(tmp_path / "graph.npz")
    unregister_skill("brook")
    try:
        assert "bounding" not in MOVING
        with pytest.raises(ArchiveError, match="'jump', 'vault', 'drop' or 'gap'"):
            navmesh.NodeGraph.load(tmp_path / "graph.npz")
        with pytest.raises(FileError, match="'jump', 'vault', 'drop' or 'gap', not 'brook'"):
            navmesh.load_tags(navmesh.tags_path(level))
        with pytest.raises(FileError, match="'bound'"):
            load_mission(level.with_name("mission.yaml"))
    finally:
        register_skill(BOUND)
