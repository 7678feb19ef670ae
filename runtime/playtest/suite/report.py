"""The report of a suite: every playtest in a matrix, findings over all seeds, and how it was before."""

import json
import os
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from runtime.errors import RuntimeInputError
from runtime.playtest.fault import Fault
from runtime.playtest.junit import suite_of, write_junit_of_all
from runtime.playtest.report import Report, fault_of
from runtime.playtest.suite.findings import Finding, changed
from surefoot.errors import SurefootError
from surefoot.files.atomic_write import whole_file
from surefoot.files.jsonfile import read_json
from surefoot.files.record_types import wrong_field

__all__ = [
    "CellResult", "Night", "SuiteReport", "read_suite_report", "write_suite_junit", "write_suite_report",
]  # fmt: skip

FORMAT = "surefoot playtest suite 1"
_NIGHTS = 90  # kept


@dataclass(frozen=True)
class CellResult:
    """What one playtest came to. ``report`` is its page, relative to the suite's; ``coverage`` a share."""

    level: str
    body: str
    seed: int
    faults: int
    notes: int
    coverage: float
    report: str

    @classmethod
    def of(cls, level: str, report: Report, page: Path) -> "CellResult":
        failures = len(report.failures)
        covered = report.coverage[-1][1] if report.coverage else 0.0
        setup = report.setup
        return cls(
            level, setup.body, setup.seed, failures, len(report.faults) - failures, covered, page.as_posix()
        )


@dataclass(frozen=True)
class Night:
    """A night in numbers: faults that every seed shows, faults that only some do, mean coverage (a share)."""

    steady: int
    flaky: int
    coverage: float


@dataclass(frozen=True)
class SuiteReport:
    """What a suite found. ``new`` and ``gone`` are findings since the night before, ``history`` the nights
    before this one, the oldest first; empty without one."""

    cells: tuple[CellResult, ...]
    findings: tuple[Finding, ...]
    new: tuple[Finding, ...] = ()
    gone: tuple[Finding, ...] = ()
    history: tuple[Night, ...] = ()

    @property
    def held(self) -> bool:
        """Whether nothing fails it, steady or flaky."""
        return not any(each.fault.fails for each in self.findings)

    @property
    def night(self) -> Night:
        """This night in numbers."""
        fails = [each for each in self.findings if each.fault.fails]
        flaky = sum(each.flaky for each in fails)
        coverage = sum(each.coverage for each in self.cells) / max(len(self.cells), 1)
        return Night(len(fails) - flaky, flaky, round(coverage, 4))

    def since(self, before: "SuiteReport") -> "SuiteReport":
        """This report with what has changed since the one ``before``."""
        new, gone = changed(before.findings, self.findings)
        return replace(self, new=new, gone=gone, history=(*before.history, before.night)[-_NIGHTS:])

    def to_dict(self) -> dict[str, Any]:
        """As plain values, for JSON."""
        return {
            "format": FORMAT,
            "held": self.held,
            "night": asdict(self.night),
            "cells": [asdict(each) for each in self.cells],
            **{name: [_plain(each) for each in getattr(self, name)] for name in ("findings", "new", "gone")},
            "history": [asdict(each) for each in self.history],
        }


def _plain(finding: Finding) -> dict[str, Any]:
    return {
        "level": finding.level,
        "body": finding.body,
        "seeds": list(finding.seeds),
        "tried": finding.tried,
        "flaky": finding.flaky,
        "title": finding.fault.title,
        "fault": finding.fault.to_dict(),
    }


def _finding(values: dict[str, Any]) -> Finding:
    seeds = tuple(values["seeds"])
    return Finding(values["level"], values["body"], fault_of(values["fault"]), seeds, values["tried"])


def write_suite_report(report: SuiteReport, path: str | os.PathLike[str]) -> None:
    """Write ``report`` as JSON, whole or not at all."""
    with whole_file(path) as temporary:
        temporary.write_text(json.dumps(report.to_dict(), indent=1) + "\n", encoding="utf-8")


def read_suite_report(path: str | os.PathLike[str]) -> SuiteReport:
    """Read what `write_suite_report` wrote. Raises `RuntimeInputError` for any other file."""
    file = Path(path)
    try:
        values = read_json(file, "report of a suite of playtests")
    except SurefootError as error:
        raise RuntimeInputError(str(error)) from None
    if not isinstance(values, dict) or values.get("format") != FORMAT:
        raise RuntimeInputError(f"{file}: not the report of a suite: expected format {FORMAT!r}")
    try:
        findings = {
            name: tuple(_finding(each) for each in values[name]) for name in ("findings", "new", "gone")
        }
        report = SuiteReport(
            cells=tuple(CellResult(**each) for each in values["cells"]),
            history=tuple(Night(**each) for each in values["history"]),
            **findings,
        )
        parts = [*report.cells, *report.history, *(each for some in findings.values() for each in some)]
        for part in (*parts, *(each.fault for each in parts if isinstance(each, Finding))):
            if (field := wrong_field(part)) is not None:
                raise TypeError(f"{field} of a {type(part).__name__} is of a wrong type")
        return report
    except (KeyError, TypeError, ValueError) as error:
        raise RuntimeInputError(f"{file}: not a whole report of a suite: {error}; run it again") from None


def write_suite_junit(report: SuiteReport, path: str | os.PathLike[str]) -> None:
    """Write ``report`` as JUnit XML: a test suite for each level and body. A flaky fault fails, too, and says
    in how many of the seeds it was seen."""
    faults: dict[tuple[str, str], list[Fault]] = {(each.level, each.body): [] for each in report.cells}
    for finding in report.findings:
        faults[finding.level, finding.body].append(_told(finding))
    suites = [suite_of(f"{level}, {body}", some) for (level, body), some in faults.items()]
    write_junit_of_all(suites, path)


def _told(finding: Finding) -> Fault:
    if not finding.flaky:
        return finding.fault
    return replace(
        finding.fault, text=f"{finding.fault.text} (in {len(finding.seeds)} of {finding.tried} seeds)"
    )
