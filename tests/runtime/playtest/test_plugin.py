"""The plugin of pytest: assertions about a playtest in a game's own tests."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

from runtime.playtest import plugin
from runtime.playtest.fault import Fault
from runtime.playtest.observation import Crossing, Journey
from tests.runtime.playtest.reports import AT, REPORT


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


@pytest.fixture
def played(tmp_path, monkeypatch):
    """Of a report with changes."""
    monkeypatch.setattr("runtime.playtest.page.write_page", lambda outcome, path: path.write_text("page"))

    def make(**changes):
        return plugin.Played(SimpleNamespace(report=replace(REPORT, **changes)), tmp_path)

    return make


def fails(call, *arguments, **options):
    with pytest.raises(pytest.fail.Exception) as failed:
        call(*arguments, **options)
    return str(failed.value)


def test_faults_fail_and_notes_do_not(played, tmp_path):
    gap, edge = Fault("gap", AT, "a wide gap"), Fault("open_edge", AT, "an edge", fails=False)
    both = played(faults=(gap, edge))
    assert both.has_no_faults("hole", "step") is both and played(faults=(edge,)).has_no_faults()
    said = fails(both.has_no_faults)
    assert said.startswith("gap too wide: a wide gap\n") and said.endswith("report.html")
    assert sorted(each.name for each in tmp_path.iterdir()) == ["report.html", "report.json"]
    assert "gap" in fails(both.has_no_faults, "gap")
    with pytest.raises(ValueError, match="unknown kind 'gaps'; valid: hole, "):
        both.has_no_faults("gaps")


def test_floor_has_to_be_covered(played):
    half = played(coverage=((1.0, 0.1), (2.0, 0.5)))
    assert half.covers(0.5) is half
    assert "bots covered 50.0% of the reachable floor, not 51.0%" in fails(half.covers, 0.51)


def test_obstacles_have_to_be_cleared(played):
    never, once = Crossing("low", "jump", 0.4, AT, 3, 0), Crossing("high", "jump", 0.6, AT, 5, 1)
    both = played(crossings=(never, once))
    assert both.clears("high") is both
    for tags in ((), ("low",)):
        assert "low was tried 3 times and never cleared" in fails(both.clears, *tags)
    assert "no bot can reach an obstacle wide; there are: low, high" in fails(both.clears, "wide")


def test_journeys_have_to_arrive_in_time(played):
    def journey(arrived, seconds):
        return played(journeys=(Journey("west", "east", 2, arrived, planned=4.0, seconds=seconds),))

    assert journey(2, 9.0).arrives() and journey(2, 5.0).arrives(within=1.0)
    assert "west to east: 2 of 2 arrived, 9.1 s of 4.0 s planned" in fails(journey(2, 9.1).arrives)
    assert "1 of 2 arrived" in fails(journey(1, 3.0).arrives)
