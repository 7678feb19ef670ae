"""Playtests of an open world: bots have it loaded around them, the report is of all of it."""

import shutil

import pytest

from runtime.playtest import playtest, read_report, write_report
from runtime.playtest.page import write_page
from runtime.playtest.replay import replay
from surefoot.errors import SurefootError
from tests.runtime.strip import ISLAND, LENGTH, strip_folder

PLAN = f"""\
radius: 15
spawns:
  - {{name: gate, at: [4, 5, 0]}}
places:
  - {{name: end, at: [116, 5, 0]}}
  - {{name: island, at: {list(ISLAND)}}}
"""


@pytest.fixture
def world(tmp_path):
    shutil.copytree(strip_folder(), tmp_path / "strip.world")
    (tmp_path / "strip.playtest.yaml").write_text(PLAN)
    return tmp_path / "strip.world"


def test_a_body_of_a_world_crosses_what_was_not_loaded_and_the_report_says_what_never_was(world, tmp_path):
    outcome = playtest(world, bots=2, seconds=100.0, body="dog", seed=1)
    (journey,) = outcome.report.journeys
    assert (journey.start, journey.goal, journey.arrived > 0) == ("gate", "end", True)
    assert outcome.report.reachable == pytest.approx(LENGTH * 10.0, rel=0.1)
    assert outcome.report.chunks.count == 13 and outcome.report.chunks.not_loaded == ("island",)
    assert "unreachable" in [fault.kind for fault in outcome.report.failures]
    write_report(outcome.report, tmp_path / "report.json")
    assert read_report(tmp_path / "report.json") == outcome.report
    write_page(outcome, tmp_path / "report.html")
    assert '"not_loaded": ["island"]' in (tmp_path / "report.html").read_text()


def test_the_report_is_the_same_with_more_processes_and_a_finding_is_shown(world, tmp_path):
    asked = {"bots": 3, "seconds": 30.0, "body": "dog", "seed": 2}
    report = playtest(world, **asked).report
    assert playtest(world, processes=2, **asked).report == report
    assert 0 < len(report.chunks.not_loaded) < report.chunks.count
    assert len(replay(report, 1).times) > 0


def test_the_capsule_plays_the_whole_of_it(world):
    report = playtest(world, bots=5, seconds=60.0, seed=1).report
    assert report.coverage[-1][1] > 0.2 and 0 < len(report.chunks.not_loaded) < report.chunks.count


@pytest.mark.parametrize(
    ("options", "plan", "says"),
    [
        ({"up": "y"}, PLAN, "strip.world: an open world is as it was baked; leave out up"),
        ({}, PLAN + "character: {max_step: 0.2}\n", "the rules that it was baked with"),
        ({}, PLAN + "character: {radius: 0.8}\n", "baked for bodies of up to 0.5 m"),
        ({}, PLAN.replace("15", "-1"), "radius: "),
        ({}, PLAN.replace("[4, 5, 0]", "[4, 50, 0]"), "not near a place"),
    ],
)
def test_what_does_not_fit_is_refused(world, options, plan, says):
    world.with_suffix(".playtest.yaml").write_text(plan)
    with pytest.raises(SurefootError, match=says):
        playtest(world, bots=0, **options)


def test_a_folder_without_an_open_world_is_refused(tmp_path):
    with pytest.raises(SurefootError, match="no open world there"):
        playtest(tmp_path, bots=0)
