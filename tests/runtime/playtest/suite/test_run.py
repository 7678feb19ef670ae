"""A whole suite: what it leaves, and that it goes on where it was."""

import json
from dataclasses import replace
from xml.etree import ElementTree

import pytest

from runtime.errors import RuntimeInputError
from runtime.playtest.fault import Fault
from runtime.playtest.kept_runs import FOLDER, KeptRuns
from runtime.playtest.run import Outcome
from runtime.playtest.suite import run as module
from runtime.playtest.suite.report import read_suite_report
from runtime.playtest.suite.run import run_suite

CHANCE = Fault("fell", (1.0, 2.0, 0.0), "bots fall <here> & there", found_by="bots")


@pytest.fixture
def night(tmp_path, outcome, monkeypatch):
    """A suite of two levels with two seeds, in which the second seed of the second level shows one more
    fault; and the playtests that were asked for."""
    asked = []

    def playtest(file, *, seed, body, checkpoint, **_):
        asked.append((file.stem, seed))
        KeptRuns(checkpoint, "x")
        report = replace(outcome.report, setup=replace(outcome.report.setup, body=body, seed=seed))
        if (file.stem, seed) == ("two", 8):
            report = replace(report, faults=(*report.faults, CHANCE))
        return Outcome(report, outcome.tally, outcome.stage, 0.0)

    monkeypatch.setattr(module, "playtest", playtest)
    monkeypatch.setattr(module, "write_page", lambda outcome, path, progress: path.write_text("a page"))
    for name in ("one", "two"):
        (tmp_path / f"{name}.obj").write_text("")
    (tmp_path / "night.yaml").write_text("levels: [one.obj, two.obj]\nseeds: [7, 8]\n")
    return tmp_path / "night.yaml", asked


def test_it_leaves_one_report_of_all(night, tmp_path, outcome):
    path, asked = night
    report = run_suite(path, tmp_path / "out")
    assert asked == [("one", 7), ("one", 8), ("two", 7), ("two", 8)]
    assert (tmp_path / "out" / "two" / "walker" / "seed-8" / "report.html").read_text() == "a page"
    assert not (tmp_path / "out" / FOLDER).exists()
    steady = 2 * len(outcome.report.failures)
    assert (report.held, report.night.steady, report.night.flaky) == (False, steady, 1)
    assert read_suite_report(tmp_path / "out" / "suite.json") == report
    suites = ElementTree.parse(tmp_path / "out" / "junit.xml").getroot()
    assert [each.get("name") for each in suites] == ["playtest one, walker", "playtest two, walker"]
    (flaky,) = [each for each in suites.iter("failure") if each.get("type") == "fell"]
    assert flaky.get("message") == "bots fall <here> & there (in 1 of 2 seeds)"
    page = (tmp_path / "out" / "index.html").read_text()
    assert "bots fall &lt;here&gt; &amp; there" in page and 'href="two/walker/seed-8/report.html"' in page
    assert "Nights" not in page and "<script" not in page


def test_the_next_night_says_what_is_new_and_how_it_was(night, tmp_path):
    path, _ = night
    run_suite(path, tmp_path / "a")
    path.write_text("levels: [one.obj, two.obj]\nseeds: [7]\n")
    second = run_suite(path, tmp_path / "b", tmp_path / "a" / "suite.json")
    assert [each.fault for each in second.gone] == [CHANCE] and second.new == ()
    third = run_suite(path, tmp_path / "c", tmp_path / "b" / "suite.json")
    assert [each.flaky for each in third.history] == [1, 0] and third.gone == ()
    assert "3 nights" in (tmp_path / "c" / "index.html").read_text()


def test_equal_suites_give_equal_bytes(night, tmp_path):
    for name in ("a", "b"):
        run_suite(night[0], tmp_path / name)
    for file in ("suite.json", "junit.xml", "index.html"):
        assert (tmp_path / "a" / file).read_bytes() == (tmp_path / "b" / file).read_bytes()


def test_other_files_are_no_report_of_a_suite(night, tmp_path):
    run_suite(night[0], tmp_path / "out")
    whole = json.loads((tmp_path / "out" / "suite.json").read_text())
    for change in ({"format": "other"}, {"cells": [{"level": 1}]}, {"history": 3}, {"new": [{}]}):
        (tmp_path / "bad.json").write_text(json.dumps(whole | change))
        with pytest.raises(RuntimeInputError, match=r"bad\.json: not (a whole|the) report of a suite"):
            read_suite_report(tmp_path / "bad.json")
