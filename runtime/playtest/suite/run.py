"""Running a suite: one playtest after the other, each with its own report, and then the whole one's."""

import shutil
from pathlib import Path

from runtime.playtest.junit import write_junit
from runtime.playtest.kept_runs import FOLDER
from runtime.playtest.page import write_page
from runtime.playtest.report import Report, write_report
from runtime.playtest.run import playtest
from runtime.playtest.suite.findings import findings_of
from runtime.playtest.suite.page import write_suite_page
from runtime.playtest.suite.plan import cells_of, read_suite
from runtime.playtest.suite.report import (
    CellResult,
    SuiteReport,
    read_suite_report,
    write_suite_junit,
    write_suite_report,
)
from surefoot.files.outputs import check_output_folder
from surefoot.progress import Progress

__all__ = ["FILES", "run_suite"]

FILES = ("suite.json", "junit.xml", "index.html")


def run_suite(
    path: Path,
    out: Path,
    before: Path | None = None,
    processes: int = 1,
    cluster: str | None = None,
    progress: Progress | None = None,
) -> SuiteReport:
    """Run the suite at ``path`` and leave its report in ``out``: `FILES`, and a folder for each playtest.

    ``before``: the suite.json of the night before. ``processes`` and ``cluster`` as of `playtest`; the report
    is the same. If it is interrupted, the same call goes on with the bots that had not finished.
    """
    suite, progress = read_suite(path), progress or Progress(shown=False)
    earlier = None if before is None else read_suite_report(before)
    written = check_output_folder(out, FILES)
    cells = cells_of(suite, path)
    results: list[CellResult] = []
    reports: dict[tuple[str, str], list[Report]] = {}
    for number, cell in enumerate(cells, start=1):
        with progress.stage(f"{number} of {len(cells)}: {cell.level}, {cell.body}, seed {cell.seed}"):
            folder = out / cell.folder
            folder.mkdir(parents=True, exist_ok=True)
        outcome = playtest(
            cell.file, bots=suite.bots, seconds=suite.seconds, seed=cell.seed, body=cell.body,
            plan=cell.plan, up=cell.up, scale=cell.scale, processes=processes, cluster=cluster,
            checkpoint=out / FOLDER / cell.folder, progress=progress,
        )  # fmt: skip
        write_report(outcome.report, folder / "report.json")
        write_junit(outcome.report, folder / "junit.xml")
        write_page(outcome, folder / "report.html", progress=progress)
        results.append(CellResult.of(cell.level, outcome.report, cell.folder / "report.html"))
        reports.setdefault((cell.level, cell.body), []).append(outcome.report)
    findings = [each for pair, some in reports.items() for each in findings_of(*pair, some)]
    report = SuiteReport(tuple(results), tuple(findings))
    if earlier is not None:
        report = report.since(earlier)
    write_suite_report(report, written[0])
    write_suite_junit(report, written[1])
    write_suite_page(report, path.stem, written[2])
    shutil.rmtree(out / FOLDER)
    return report
