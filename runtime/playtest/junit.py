"""A report as JUnit XML, which build servers show as a list of tests."""

import os
from xml.etree import ElementTree as xml

from runtime.playtest.fault import KINDS
from runtime.playtest.report import Report
from surefoot.files.atomic_write import whole_file

__all__ = ["write_junit"]


def write_junit(report: Report, path: str | os.PathLike[str]) -> None:
    """Write ``report`` to ``path``, whole or not at all: one test for each kind of finding and, failed,
    one for each fault; notes are skipped tests."""
    suite = xml.Element("testsuite", name=f"playtest {report.setup.level}")
    found = {fault.kind for fault in report.faults}
    passed = [kind for kind in KINDS if kind not in found]
    for kind in passed:
        xml.SubElement(suite, "testcase", classname=report.setup.level, name=f"no {KINDS[kind]}")
    for number, fault in enumerate(report.faults, start=1):
        case = xml.SubElement(suite, "testcase", classname=report.setup.level, name=f"{number}: {fault.name}")
        kind = "failure" if fault.fails else "skipped"
        xml.SubElement(case, kind, type=fault.kind, message=_legal(fault.text))
    suite.set("tests", str(len(passed) + len(report.faults)))
    suite.set("failures", str(len(report.failures)))
    suite.set("skipped", str(len(report.faults) - len(report.failures)))
    with whole_file(path) as temporary:
        xml.ElementTree(suite).write(temporary, encoding="utf-8", xml_declaration=True)


def _legal(text: str) -> str:
    """Without the control characters that XML does not know, which names in a file may hold."""
    return "".join(each if each.isprintable() else "?" for each in text)
