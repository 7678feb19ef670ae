"""What ``surefoot playtest`` and ``surefoot replay`` do."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from runtime.cli.commands import Result, check_page, ready
from runtime.errors import RuntimeInputError
from runtime.playtest.diff import Difference, compare
from runtime.playtest.fault import Fault
from runtime.playtest.junit import write_junit
from runtime.playtest.kept_runs import FOLDER
from runtime.playtest.page import write_page
from runtime.playtest.replay import replay
from runtime.playtest.report import read_report, write_report
from runtime.playtest.run import Outcome, playtest
from runtime.playtest.suite.run import FILES, run_suite
from surefoot.files.outputs import check_output_folder
from surefoot.words import several

__all__ = ["playtest_level", "playtest_suite", "replay_finding"]


def playtest_level(level: Path, options: Mapping[str, Any], out: Path | None, before: Path | None) -> Result:
    """Playtest ``level``; holds when nothing fails. With ``out`` leave report.html, report.json and
    junit.xml there; one that was interrupted goes on with the bots that had not finished.

    ``options`` are those of `playtest`; ``before`` is an earlier report to compare with.
    """
    written = [] if out is None else check_output_folder(out, ("report.json", "junit.xml", "report.html"))
    earlier = None if before is None else read_report(before)
    progress = ready()
    checkpoint = None if out is None else out / FOLDER
    outcome = playtest(level, **options, checkpoint=checkpoint, progress=progress)
    difference = None if earlier is None else compare(earlier, outcome.report)
    if written:
        written[0].parent.mkdir(parents=True, exist_ok=True)
        write_report(outcome.report, written[0])
        write_junit(outcome.report, written[1])
        write_page(outcome, written[2], difference, progress)
        assert outcome.kept is not None
        outcome.kept.forget()
    values = {**outcome.report.to_dict(), "files": [str(each) for each in written]}
    if difference is not None:
        values["new"] = [fault.to_dict() for fault in difference.new]
        values["gone"] = [fault.to_dict() for fault in difference.gone]
    return Result(values, outcome.report.held, lambda: _show(outcome, difference, written))


def playtest_suite(
    suite: Path, out: Path | None, before: Path | None, processes: int, cluster: str | None
) -> Result:
    """Run a ``suite`` of playtests and leave its report in ``out``; holds when nothing fails. ``before`` is
    the suite.json of an earlier night."""
    if out is None:
        raise RuntimeInputError(
            f"{suite}: a suite leaves a page and a folder for each playtest: say where (--out)"
        )
    report = run_suite(suite, out, before, processes, cluster, ready())
    written = [str(out / name) for name in FILES]

    def show() -> None:
        night = report.night
        for finding in report.findings:
            if finding.fault.fails:
                seen = f"{len(finding.seeds)} of {finding.tried} seeds"
                print(
                    f"{finding.level}, {finding.body}: {finding.fault.title}: {finding.fault.text} ({seen})"
                )
        print(
            f"{several(len(report.cells), 'playtest')}: {several(night.steady, 'steady fault')}, "
            f"{night.flaky} flaky; {100.0 * night.coverage:.0f} % of the reachable floor visited"
        )
        if before is not None:
            print(f"since the night before: {len(report.new)} new, {len(report.gone)} gone")
        for path in written:
            print(f"wrote {path}")

    return Result({**report.to_dict(), "files": written}, report.held, show)


def replay_finding(report: Path, number: int, output: Path) -> Result:
    """Write a page that plays finding ``number`` of ``report``."""
    from runtime.views.view import write_page as write_view

    check_page(output)
    found = read_report(report)
    progress = ready()
    with progress.stage("running the bot again"):
        trace = replay(found, number)
    with progress.stage("writing the page"):
        write_view(trace, output)
    text = found.faults[number - 1].text
    values = {
        "output": str(output),
        "finding": number,
        "text": text,
        "seconds": round(float(trace.times[-1]), 2),
    }
    return Result(values, True, lambda: print(f"{number}: {text}\n{output}: open it in a browser"))


def _show(outcome: Outcome, difference: Difference | None, written: list[Path]) -> None:
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    report = outcome.report
    console = Console(highlight=False)
    table = Table(
        "", "", "what", title=Path(report.setup.level).name, title_justify="left", show_header=False
    )
    for number, fault in enumerate(report.faults, start=1):
        colour = "red" if fault.fails else "yellow"
        table.add_row(str(number), f"[{colour}]{fault.title}[/]", escape(_sentence(fault)))
    if report.faults:
        console.print(table)
    fails = len(report.failures)
    verdict = "[green]held[/]" if report.held else f"[red]{fails} fault{'s' * (fails != 1)}[/]"
    notes = len(report.faults) - fails
    covered = 100.0 * (report.coverage[-1][1] if report.coverage else 0.0)
    console.print(
        f"{verdict}, {notes} note{'s' * (notes != 1)}; {covered:.0f} % of {report.reachable:.0f} m² visited"
    )
    if report.chunks is not None:
        loaded = report.chunks.count - len(report.chunks.not_loaded)
        console.print(f"bots had {loaded} of {report.chunks.count} chunks loaded")
    if difference is not None:
        new, gone, kept = len(difference.new), len(difference.gone), len(difference.kept)
        console.print(f"since the earlier report: {new} new, {gone} gone, {kept} as before")
    total, bots = outcome.tally.seconds, report.setup.bots
    if bots:
        pace = total / max(outcome.wall, 1e-9)
        console.print(f"{bots} bots, {total:.0f} s in {outcome.wall:.1f} s ({pace:.0f} x real time)")
    for path in written:
        console.print(f"wrote {path}", soft_wrap=True)


def _sentence(fault: Fault) -> str:
    bots = len({each.bot for each in fault.sightings})
    met = f" (met by {bots} bot{'s' * (bots != 1)})" if bots and fault.found_by == "analysis" else ""
    return fault.text + met
