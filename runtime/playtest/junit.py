"""A report as JUnit XML, which build servers show as a list of tests."""

import os
from collections.abc import Sequence
from xml.etree import ElementTree as xml

from runtime.playtest.fault import KINDS, Fault
from runtime.playtest.report import Report
from surefoot.files.atomic_write import whole_file

__all__ = ["suite_of", "write_junit", "write_junit_of_all"]


def write_junit(report: Report, path: str | os.PathLike[str]) -> None:
    """Write ``report`` to ``path``, whole or not at all: one test for each kind of finding and, failed,
    one for each fault; notes are skipped tests."""
    _write(suite_of(report.setup.level, report.faults), path)


def write_junit_of_all(suites: Sequence[xml.Element], path: str | os.PathLike[str]) -> None:
    """Write several suites of `suite_of` to ``path``, whole or not at all."""
    whole = xml.Element("testsuites")
    whole.extend(suites)
    _write(whole, path)


def suite_of(name: str, faults: Sequence[Fault]) -> xml.Element:
    """The tests of a playtest that found ``faults``."""
    suite = xml.Element("testsuite", name=f"playtest {name}")
    found = {fault.kind for fault in faults}
    passed = [kind for kind in KINDS if kind not in found]
    for kind in passed:
        xml.SubElement(suite, "testcase", classname=name, name=f"no {KINDS[kind]}")
    for number, fault in enumerate(faults, start=1):
        case = xml.SubElement(suite, "testcase", classname=name, name=f"{number}: {fault.name}")
        kind = "failure" if fault.fails else "skipped"
        xml.SubElement(case, kind, type=fault.kind, message=_legal(fault.text))
    failures = sum(fault.fails for fault in faults)
    suite.set("tests", str(len(passed) + len(faults)))
    suite.set("failures", str(failures))
    suite.set("skipped", str(len(faults) - failures))
    return suite


def _write(element: xml.Element, path: str | os.PathLike[str]) -> None:
    with whole_file(path) as temporary:
        xml.ElementTree(element).write(temporary, encoding="utf-8", xml_declaration=True)


def _legal(text: str) -> str:
    """Without the control characters that XML does not know, which names in a file may hold."""
    return "".join(each if each.isprintable() else "?" for each in text)
