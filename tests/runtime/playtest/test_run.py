"""Playtests: planted faults are found, the same seed gives the same report, and everybody can read it."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
import trimesh

import navmesh
from benchmarks.playtest_faults import COURTYARD, plants
from runtime.cli.app import main
from runtime.errors import RuntimeInputError
from runtime.playtest import bots, compare, playtest, read_report, write_report
from runtime.playtest.analysis import analyse, core_parts
from runtime.playtest.bots import run_bot
from runtime.playtest.character import character_of
from runtime.playtest.holes import find_holes
from runtime.playtest.looks import figure_of
from runtime.playtest.movers import CapsuleMover, WorldMover
from runtime.playtest.observation import sighted
from runtime.playtest.page import write_page
from runtime.playtest.plan import LoadedPlan
from runtime.playtest.replay import replay
from runtime.playtest.site import Site
from surefoot.files.yamlfile import FileError
from tests.browser import BROWSER, screenshot
from tests.small_level import obj_text

NOBODY = np.empty(0, dtype=np.int64)


def site_of(mesh, tags=None, body="walker"):
    player = character_of(body)
    terrain = navmesh.Terrain.from_arrays(mesh.vertices, mesh.faces)
    return Site(navmesh.NodeGraph.build(terrain, player.rules, player.obstacle_rules(), tags=tags), player)


def slab(x0, x1, y0, y1, z0, z1):
    return trimesh.creation.box(bounds=[(x0, y0, z0), (x1, y1, z1)])


@pytest.fixture(scope="module")
def level(tmp_path_factory):
    """A yard with walls all around, a platform of 0.5 m to jump onto, and a pit that nobody gets out of."""
    folder = tmp_path_factory.mktemp("yard")
    floor = [slab(0, 4, 0, 12, -3, 0), slab(6, 16, 0, 12, -3, 0)]
    floor += [slab(4, 6, 0, 5, -3, 0), slab(4, 6, 7, 12, -3, 0)]
    pit = slab(4, 6, 5, 7, -3, -1.5)
    wall = [slab(-1, 0, -1, 13, -3, 3), slab(16, 17, -1, 13, -3, 3)]
    wall += [slab(0, 16, -1, 0, -3, 3), slab(0, 16, 12, 13, -3, 3)]
    platform = slab(11, 15, 4, 8, 0, 0.5)
    trimesh.util.concatenate([*floor, pit, *wall, platform]).export(folder / "yard.obj")
    return folder / "yard.obj"


@pytest.fixture(scope="module")
def outcome(level):
    return playtest(level, bots=8, seconds=40.0, seed=7)


def kinds(report):
    return [fault.kind for fault in report.failures]


@pytest.fixture(scope="module")
def courtyard():
    return trimesh.load_mesh(COURTYARD, process=False)


def test_the_courtyard_has_no_faults(courtyard):
    site = site_of(courtyard, navmesh.load_tags(navmesh.tags_path(COURTYARD)))
    assert [fault for fault in analysed(site) if fault.fails] == []


@pytest.mark.parametrize("number", [0, 4, 6, 9, 12, 13, 15, 18])
def test_a_planted_fault_is_found_where_it_is(courtyard, number):
    plant = plants()[number]
    site = site_of(plant.edit(courtyard.copy()), navmesh.load_tags(navmesh.tags_path(COURTYARD)))
    faults = [fault for fault in analysed(site) if fault.fails]
    assert [fault.kind for fault in faults if plant.is_found_as(fault)] == [plant.kind]


def test_a_hole_that_nobody_gets_to_is_none():
    """A block of a catalogue that stands apart, with a hole in it, as kits of levels have."""
    ring = [slab(30, 32, 0, 6, -0.5, 0), slab(34, 36, 0, 6, -0.5, 0)]
    ring += [slab(32, 34, 0, 2, -0.5, 0), slab(32, 34, 4, 6, -0.5, 0)]
    site = site_of(trimesh.util.concatenate([slab(0, 12, 0, 12, -0.5, 0), *ring]))
    inside = np.ones(len(site.areas), dtype=bool)
    assert [hole.enclosed for hole in find_holes(site, inside)].count(True) == 1
    assert not any(hole.enclosed for hole in find_holes(site, site.reached(core_parts(site))))


def test_a_level_without_room_is_refused_in_a_sentence(tmp_path):
    slab(0, 1.2, 0, 1.2, -0.5, 0).export(tmp_path / "plate.obj")
    with pytest.raises(RuntimeInputError, match="no part with 1 m² of room for the middle of a person"):
        playtest(tmp_path / "plate.obj", bots=1, seconds=1.0)


def test_the_pit_is_a_trap_and_bots_meet_it(outcome):
    assert kinds(outcome.report) == ["trap"]
    trap = outcome.report.failures[0]
    assert np.allclose(trap.position, (5.0, 6.0, -1.5), atol=0.5)
    assert "1.50 m high; a person steps 0.20 m and jumps 0.70 m" in trap.text
    assert outcome.report.coverage[-1][1] > 0.5


def unreached(mesh, body="walker"):
    """What cannot be reached, or not be left again, from the largest part of a level."""
    return analysed(site_of(mesh, body=body))


def analysed(site):
    starts = core_parts(site)
    return analyse(site, find_holes(site, site.reached(starts)), starts, NOBODY, NOBODY)


def test_floor_inside_a_block_is_no_fault_but_floor_inside_a_room_is():
    floor, block = slab(0, 20, 0, 12, -1, 0), slab(2, 5, 4, 8, 0, 3)
    assert [fault for fault in unreached(trimesh.util.concatenate([floor, block])) if fault.fails] == []
    bottomless = block.copy()
    bottomless.update_faces(bottomless.face_normals[:, 2] > -0.5)
    assert [each for each in unreached(trimesh.util.concatenate([floor, bottomless])) if each.fails] == []
    inside = slab(13, 16, 4, 8, 0, 3)  # the block in the room is nobody's either
    walls = [slab(10, 10.3, 1, 11, 0, 4), slab(18.7, 19, 1, 11, 0, 4)]
    walls += [slab(10, 19, 1, 1.3, 0, 4), slab(10, 19, 10.7, 11, 0, 4)]
    faults = [fault for fault in unreached(trimesh.util.concatenate([floor, block, inside, *walls]))]
    (fault,) = (each for each in faults if each.fails)
    assert fault.kind == "walled_off" and 9.9 <= fault.position[0] <= 19.1


def test_tops_of_walls_are_one_note():
    floor, fence = slab(0, 20, 0, 12, -1, 0), slab(0, 20, 12, 12.15, -1, 0.9)
    tops = [slab(0, 20, 12.15, 12.65, -1, 0.2), slab(0, 20, -0.5, 0, -1, 1.5)]  # the first behind the fence
    level = trimesh.util.concatenate([floor, fence, *tops])
    found = [each for each in unreached(level, body="dog") if each.kind != "open_edge"]
    assert [(each.kind, each.fails) for each in found] == [("tops", False)]
    assert "2 parts like it" in found[0].text
    broad = trimesh.util.concatenate([floor, slab(0, 20, 12, 13.5, -1, 1.5)])
    assert [each.kind for each in unreached(broad, body="dog") if each.kind != "open_edge"] == ["unreachable"]


def gap_of(width):
    return trimesh.util.concatenate([slab(0, 12, 0, 6, -0.3, 0), slab(12 + width, 20 + width, 0, 6, -0.3, 0)])


def test_a_gap_is_not_called_a_wall():
    for width, body, says in (
        (2.2, "human", "2.20 m wide; a person leaps 0.38 to 1.82 m"),
        (1.0, "dog", "1.00 m wide; a dog does not leap gaps"),
    ):
        (fault,) = (each for each in unreached(gap_of(width), body=body) if each.kind != "open_edge")
        assert fault.kind in ("gap", "unreachable")
        assert "gap at" in fault.text and says in fault.text
    assert not [each for each in unreached(gap_of(1.0), body="human") if each.kind != "open_edge"]


def test_what_is_too_low_for_a_skill_is_said_with_its_range():
    low = trimesh.util.concatenate([slab(0, 20, 0, 12, -1, 0), slab(12, 20, 0, 12, 0, 0.45)])
    (fault,) = (each for each in unreached(low, body="human") if each.kind == "one_way")
    least, most = character_of("human").skills["drop"]
    assert f"0.45 m down; a person drops {least:.2f} to {most:.2f} m" in fault.text


def test_obstacles_are_tried_and_cleared(outcome):
    jumps = [each for each in outcome.report.crossings if each.affordance == "jump"]
    assert len(jumps) == 3 and all(each.cleared > 0 for each in jumps)


def test_journeys_take_about_the_planned_time(outcome):
    arrived = [each for each in outcome.report.journeys if each.arrived]
    assert arrived and all(each.seconds < 1.5 * each.planned + 1.0 for each in arrived)


def test_the_same_seed_gives_the_same_report_in_two_processes(level, outcome):
    again = playtest(level, bots=8, seconds=40.0, seed=7, processes=2).report
    assert json.dumps(again.to_dict()) == json.dumps(outcome.report.to_dict())
    other = playtest(level, bots=8, seconds=40.0, seed=8).report
    assert json.dumps(other.to_dict()) != json.dumps(outcome.report.to_dict())


def test_a_bot_depends_on_its_own_number_only(outcome):
    stage = outcome.stage
    alone = run_bot(stage.site, stage.goals, 7, 5, 40.0)
    assert np.array_equal(alone.track, outcome.runs[5].track)


def test_a_roamer_falls_through_a_hole():
    mesh = trimesh.util.concatenate([slab(0, 9, 0, 4, -0.2, 0), slab(11, 20, 0, 4, -0.2, 0)])
    mover = CapsuleMover(site_of(mesh))
    mover.appear(np.array([7.0, 2.0, 0.0]), 0.0)
    leg = mover.wander(np.array([0.0]), 5.0)
    assert leg.status == "fell" and 8.8 < leg.place[0] < 9.5


def test_a_body_of_a_world_plays_too(level):
    report = playtest(level, bots=2, seconds=6.0, seed=1, body="dog").report
    assert report.character["body"] == "dog" and report.coverage[-1][1] > 0.0


def test_a_body_beside_a_wall_appears_as_there_is_room(level):
    mover = WorldMover(playtest(level, bots=0, body="dog").stage.site)
    for heading in np.linspace(-np.pi, np.pi, 5):  # the wall is at x = 0, its head 0.7 m before its rear feet
        mover.appear(np.array([0.4, 6.0, 0.0]), heading)
        assert np.linalg.norm(mover.place[:2] - [0.4, 6.0]) < 0.8


def test_people_give_the_same_report_in_two_processes(level):
    reports = [
        playtest(level, bots=2, seconds=10.0, seed=3, body="human", processes=number).report
        for number in (1, 2)
    ]
    one, two = (json.dumps(report.to_dict()) for report in reports)
    assert one == two and reports[0].coverage[-1][1] > 0.0


def test_the_replay_of_a_body_of_a_world_shows_its_figure(level, monkeypatch):
    monkeypatch.setattr(bots, "_MARGIN", 0.2)  # it gives up long before it is there
    outcome = playtest(level, bots=1, seconds=30.0, seed=1, body="dog")
    fault = next(each for each in outcome.report.faults if each.sightings)
    trace = replay(outcome.report, outcome.report.faults.index(fault) + 1)
    (agent,) = trace.agents
    assert agent.figure.bodies == figure_of(character_of("dog")).bodies
    assert agent.poses.shape[1:] == (len(agent.figure.bodies), 7)
    assert np.linalg.norm(agent.poses[-1, 0, :2] - fault.sightings[0].position[:2]) < 1.0
    trouble = sighted(outcome.runs[0], fault.sightings[0])
    assert trouble is not None and np.array_equal(agent.poses, trouble.poses)


def test_a_horse_plays_a_level_whose_tagged_obstacles_it_steps_over():
    assert playtest(COURTYARD, bots=1, seconds=3.0, body="horse").report.coverage[-1][1] > 0.0


def test_a_report_is_read_as_it_was_written(outcome, tmp_path):
    write_report(outcome.report, tmp_path / "report.json")
    again = read_report(tmp_path / "report.json")
    assert json.dumps(again.to_dict()) == json.dumps(outcome.report.to_dict())
    same = compare(again, outcome.report)
    assert (same.new, same.gone, len(same.kept)) == ((), (), len(outcome.report.faults))


def test_a_mended_level_differs_from_before(level, outcome, tmp_path):
    mesh = trimesh.util.concatenate([trimesh.load_mesh(level, process=False), slab(4, 6, 5, 7, -1.5, 0)])
    mesh.export(tmp_path / "yard.obj")
    mended = playtest(tmp_path / "yard.obj", bots=0).report
    assert mended.held
    assert [fault.kind for fault in compare(outcome.report, mended).gone if fault.fails] == ["trap"]


def test_the_replay_of_a_trap_ends_in_it(outcome):
    number = outcome.report.faults.index(outcome.report.failures[0]) + 1
    trace = replay(outcome.report, number)
    assert trace.times[-1] > 1.0 and abs(trace.agents[0].poses[-1, 0, 2] + 1.5) < 0.1


def test_the_page_needs_no_network(outcome, tmp_path):
    write_page(outcome, tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert [each.name for each in tmp_path.iterdir()] == ["report.html"]
    assert not re.search(r"(src|href)=[\"']?https?:", page) and "__REPORT__" not in page


@pytest.mark.skipif(BROWSER is None, reason="no Chromium here to open the page in")
def test_the_page_draws_map_and_faults(outcome, tmp_path):
    write_page(outcome, tmp_path / "report.html")

    def is_drawn(picture):
        """Red for the fault in the verdict and on the map, and the colours of the heat map."""
        red, green, blue = picture[..., 0], picture[..., 1], picture[..., 2]
        faults = (red > 0.7) & (green < 0.35) & (blue < 0.35)
        hot = (red > 0.7) & (green > 0.4) & (green < 0.8) & (blue < 0.4)
        return faults.sum() > 400 and faults[200:].any() and hot.sum() > 300

    picture = screenshot(tmp_path / "report.html", tmp_path / "profile", (1000, 900), is_drawn, seconds=100.0)
    assert picture is not None, "nothing was drawn within 100 s"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("spawns:\n  - {name: a, at: [1, 1]}\n", ":2:19: spawns[0].at"),
        ("places:\n  - {name: a, at: [99.0, 1.0, 0.0]}\n", ":2:19: places[0].at: [99.0, 1.0"),
        ("character: {skills: {fly: [1.0, 2.0]}}\n", "'jump', 'vault', 'drop' or 'gap'"),
        ("character: {skills: {jump: [0.9, 0.2]}}\n", "least 0.9 m is above greatest 0.2 m"),
        ("routes:\n  - {from: a, to: b, at_most: 3.0}\n", ":2:12: routes[0].from: unknown 'a'"),
        ("spawn: []\n", "did you mean 'spawns'?"),
    ],
)
def test_errors_in_a_plan_name_line_and_column(level, tmp_path, text, says):
    plan = tmp_path / "yard.playtest.yaml"
    plan.write_text(text)
    with pytest.raises(FileError, match=re.escape(says)):
        playtest(level, bots=0, plan=plan)


def test_expectations_that_do_not_hold_are_faults(level, tmp_path):
    plan = tmp_path / "plan.yaml"
    plan.write_text(
        "spawns:\n  - {name: door, at: [1.0, 1.0, 0.0]}\n"
        "places:\n  - {name: pit, at: [5.0, 6.0, -1.5], reachable: false}\n"
        "  - {name: top, at: [13.0, 6.0, 0.5]}\n"
        "routes:\n  - {from: door, to: top, at_most: 5.0}\n"
    )
    found = playtest(level, bots=0, plan=plan).report
    assert sorted(kinds(found)) == ["detour", "forbidden", "trap"]


def test_the_courtyards_own_plan_is_valid():
    plan = LoadedPlan.read(COURTYARD.with_name("courtyard.playtest.yaml"))
    assert [each.name for each in plan.plan.places] == ["stage", "terrace", "walkway", "trench"]


@pytest.fixture
def surefoot(capsys):
    def call(*arguments):
        with pytest.raises(SystemExit) as left:
            main([str(each) for each in arguments])
        return left.value.code, capsys.readouterr()

    return call


def test_the_command_fails_a_level_with_faults_and_replays_them(surefoot, level, tmp_path):
    code, said = surefoot("playtest", level, "--bots", 4, "--seconds", 20, "--out", tmp_path / "out")
    assert code == 1 and "trap" in said.out and "1 fault" in said.out and "4 bots play" in said.err
    made = sorted(each.name for each in (tmp_path / "out").iterdir())
    assert made == ["junit.xml", "report.html", "report.json"]
    suite = ElementTree.parse(tmp_path / "out" / "junit.xml").getroot()
    assert suite.get("failures") == "1" and len(suite.findall("testcase/failure")) == 1
    report = tmp_path / "out" / "report.json"
    code, said = surefoot("replay", report, 1, "-o", tmp_path / "replay.html", "--json")
    assert code == 0 and (tmp_path / "replay.html").stat().st_size > 20_000
    code, said = surefoot("replay", report, 99, "-o", tmp_path / "replay.html")
    assert code == 2 and "1 to" in said.err


def test_the_command_refuses_wrong_input(surefoot, level, tmp_path):
    (tmp_path / "old.json").write_text("{}")
    for arguments, says in (
        (["nowhere.obj"], "no such file"),
        ([level, "--body", "bird"], "'human', 'walker'"),
        ([level, "--seconds", "-1"], "seconds = -1"),
        ([level, "--before", tmp_path / "old.json"], "not a report of a playtest"),
    ):
        code, said = surefoot("playtest", *arguments)
        last = said.err.strip().splitlines()[-1]
        assert code == 2 and says in last and last.startswith("surefoot: ")


def test_a_level_without_faults_holds(surefoot, tmp_path):
    (tmp_path / "level.obj").write_text(obj_text())
    code, said = surefoot("playtest", tmp_path / "level.obj", "--bots", 0, "--json")
    assert code == 0 and json.loads(said.out)["held"] is True


def test_the_plugin_of_pytest(level, tmp_path):
    (tmp_path / "test_level.py").write_text(
        f"LEVEL = {str(level)!r}\n"
        "def test_obstacles(playtest):\n"
        "    played = playtest(LEVEL, bots=8, seconds=40, seed=7)\n"
        "    played.covers(0.3).clears('jump@11.0,6.0,0.5/0').has_no_faults('hole')\n"
        "def test_faults(playtest):\n"
        "    playtest(LEVEL, bots=0).has_no_faults()\n"
    )
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-p",
        "no:cacheprovider",
        "-p",
        "runtime.playtest.plugin",
    ]
    # whether or not the plugin is installed where the tests run, it is loaded once
    environment = {**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    ran = subprocess.run(
        [*command, str(tmp_path)],
        capture_output=True,
        text=True,
        cwd=Path(__file__).parents[3],
        env=environment,
    )
    assert "1 failed, 1 passed" in ran.stdout, ran.stdout + ran.stderr
    assert "is a trap" in ran.stdout and "report.html" in ran.stdout
