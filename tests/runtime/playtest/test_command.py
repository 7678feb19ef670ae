"""``surefoot playtest`` and ``surefoot replay``: what they leave, say and refuse."""

import json
from dataclasses import replace
from xml.etree import ElementTree

from runtime.playtest import command
from tests.small_level import obj_text


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


def test_what_has_changed_since_an_earlier_report_is_told(surefoot, level, outcome, tmp_path, monkeypatch):
    monkeypatch.setattr(command, "playtest", lambda *_, **__: outcome)
    command.write_report(replace(outcome.report, faults=()), tmp_path / "before.json")
    arguments = ("playtest", level, "--before", tmp_path / "before.json")
    code, said = surefoot(*arguments, "--json")
    told = json.loads(said.out)
    assert code == 1 and [fault["kind"] for fault in told["faults"] if fault["fails"]] == ["trap"]
    assert len(told["new"]) == len(told["faults"]) and told["gone"] == [] and told["files"] == []
    new = len(told["faults"])
    assert f"since the earlier report: {new} new, 0 gone, 0 as before" in surefoot(*arguments)[1].out
