"""Playtests: planted faults are found, the same seed gives the same report, and everybody can read it."""

import json
import re

import numpy as np
import pytest
import trimesh

import navmesh
from benchmarks.playtest_faults import COURTYARD, plants
from runtime.playtest import bots, compare, playtest, read_report, write_report
from runtime.playtest.analysis import core_parts
from runtime.playtest.bots import run_bot
from runtime.playtest.character import character_of
from runtime.playtest.holes import find_holes
from runtime.playtest.looks import figure_of
from runtime.playtest.movers import WorldMover
from runtime.playtest.page import write_page
from runtime.playtest.plan import LoadedPlan
from runtime.playtest.replay import replay
from surefoot.files.yamlfile import FileError
from tests.browser import BROWSER, screenshot
from tests.runtime.playtest.levels import analysed, box, site_of, unreached


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
    ring = [box(30, 32, 0, 6, -0.5, 0), box(34, 36, 0, 6, -0.5, 0)]
    ring += [box(32, 34, 0, 2, -0.5, 0), box(32, 34, 4, 6, -0.5, 0)]
    site = site_of(trimesh.util.concatenate([box(0, 12, 0, 12, -0.5, 0), *ring]))
    inside = np.ones(len(site.areas), dtype=bool)
    assert [hole.enclosed for hole in find_holes(site, inside)].count(True) == 1
    assert not any(hole.enclosed for hole in find_holes(site, site.reached(core_parts(site))))


def test_the_pit_is_a_trap_and_bots_meet_it(outcome):
    assert kinds(outcome.report) == ["trap"]
    trap = outcome.report.failures[0]
    assert np.allclose(trap.position, (5.0, 6.0, -1.5), atol=0.5)
    assert "1.50 m high; a person steps 0.20 m and jumps 0.70 m" in trap.text
    assert outcome.report.coverage[-1][1] > 0.5


def test_tops_of_walls_are_one_note():
    floor, fence = box(0, 20, 0, 12, -1, 0), box(0, 20, 12, 12.15, -1, 0.9)
    tops = [box(0, 20, 12.15, 12.65, -1, 0.2), box(0, 20, -0.5, 0, -1, 1.5)]  # the first behind the fence
    level = trimesh.util.concatenate([floor, fence, *tops])
    found = [each for each in unreached(level, body="dog") if each.kind != "open_edge"]
    assert [(each.kind, each.fails) for each in found] == [("tops", False)]
    assert "2 parts like it" in found[0].text
    broad = trimesh.util.concatenate([floor, box(0, 20, 12, 13.5, -1, 1.5)])
    assert [each.kind for each in unreached(broad, body="dog") if each.kind != "open_edge"] == ["unreachable"]


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
    alone = run_bot(stage.site, stage.goals, 7, 6, 40.0)  # the last that travels
    assert alone.visits and alone.visits == outcome.tally.visits[-len(alone.visits) :]


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
        playtest(level, bots=2, seconds=4.0, seed=3, body="human", processes=number).report
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
    trouble = outcome.tally.met(fault.sightings[0])
    assert trouble is not None and np.array_equal(agent.poses, trouble.poses)


def test_a_horse_plays_a_level_whose_tagged_obstacles_it_steps_over():
    assert playtest(COURTYARD, bots=1, seconds=3.0, body="horse").report.coverage[-1][1] > 0.0


def test_a_report_is_read_as_it_was_written(outcome, tmp_path):
    write_report(outcome.report, tmp_path / "report.json")
    again = read_report(tmp_path / "report.json")
    assert json.dumps(again.to_dict()) == json.dumps(outcome.report.to_dict())
    same = compare(again, outcome.report)
    assert (same.new, same.gone, len(same.kept)) == ((), (), len(outcome.report.faults))


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


def test_the_courtyards_own_plan_is_valid():
    plan = LoadedPlan.read(COURTYARD.with_name("courtyard.playtest.yaml"))
    assert [each.name for each in plan.plan.places] == ["stage", "terrace", "walkway", "trench"]
