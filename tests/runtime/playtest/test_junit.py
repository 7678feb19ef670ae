"""Build servers are told of each kind of finding that is not there, and of each that is."""

from dataclasses import replace
from xml.etree import ElementTree

from runtime.playtest.fault import KINDS, Fault
from runtime.playtest.junit import write_junit
from tests.runtime.playtest.reports import AT, REPORT


def test_faults_fail_notes_are_skipped_and_the_rest_passes(tmp_path):
    found = (
        Fault("gap", AT, "a <gap> & more\x00\x1b[0m"),
        Fault("gap", (9.0, 0.0, 0.0), "another"),
        Fault("open_edge", AT, "an edge", fails=False),
    )
    write_junit(replace(REPORT, faults=found), tmp_path / "junit.xml")
    suite = ElementTree.parse(tmp_path / "junit.xml").getroot()
    cases = suite.findall("testcase")
    assert suite.get("name") == "playtest level.obj"
    assert [suite.get(name) for name in ("tests", "failures", "skipped")] == [str(len(KINDS) + 1), "2", "1"]
    assert len(cases) == len(KINDS) + 1
    assert [case.get("name") for case in cases if len(case)] == [
        f"{number}: {fault.name}" for number, fault in enumerate(found, start=1)
    ]
    failure = cases[-3].find("failure")
    assert failure.get("type") == "gap" and failure.get("message") == "a <gap> & more??[0m"
    assert cases[-1].find("skipped").get("message") == "an edge"
    assert {case.get("name") for case in cases if not len(case)} == {
        f"no {title}" for kind, title in KINDS.items() if kind not in ("gap", "open_edge")
    }
