"""The report of a suite as a page: one HTML file that needs no server, no network and no scripts."""

import os
from collections.abc import Iterable, Sequence
from html import escape
from importlib.resources import files
from string import Template

from runtime.playtest.suite.findings import Finding
from runtime.playtest.suite.report import Night, SuiteReport
from surefoot.files.atomic_write import whole_file
from surefoot.words import several

__all__ = ["write_suite_page"]

_WIDE, _HIGH = 760, 140  # of the picture of nights
_COLOURS = {"steady": "#c8323a", "flaky": "#b7791f", "coverage": "#1f8a5b"}


def write_suite_page(report: SuiteReport, name: str, path: str | os.PathLike[str]) -> None:
    """Write the page of the suite ``name`` to ``path``, whole or not at all."""
    template = files("runtime.playtest.suite").joinpath("suite.html").read_text(encoding="utf-8")
    fails = [each for each in report.findings if each.fault.fails]
    notes = [each for each in report.findings if not each.fault.fails]
    night = report.night
    values = {
        "title": escape(f"Playtests of {name}"),
        "verdict": "held" if report.held else several(len(fails), "fault"),
        "verdict_class": "held" if report.held else "failed",
        "summary": f"{several(len(report.cells), 'playtest')}; {several(night.steady, 'steady fault')}, "
        f"{night.flaky} flaky; {100.0 * night.coverage:.1f} % of the reachable floor visited",
        "matrix": _matrix(report),
        "difference": _difference(report),
        "faults": _list(fails),
        "notes": _folded(f"Notes ({len(notes)})", _list(notes)) if notes else "",
        "history": _history([*report.history, night]) if report.history else "",
    }
    with whole_file(path) as temporary:
        temporary.write_text(Template(template).substitute(values), encoding="utf-8")


def _folded(title: str, inside: str) -> str:
    return f"<section><details><summary>{title}</summary>{inside}</details></section>"


def _row(cells: Iterable[str], kind: str = "td") -> str:
    return "<tr>" + "".join(f"<{kind}>{cell}</{kind}>" for cell in cells) + "</tr>"


def _matrix(report: SuiteReport) -> str:
    """Levels down, bodies and seeds across."""
    across = list(dict.fromkeys((each.body, each.seed) for each in report.cells))
    results = {(each.level, each.body, each.seed): each for each in report.cells}
    rows = [_row(["", *(f"{escape(body)}, seed {seed}" for body, seed in across)], "th")]
    for level in dict.fromkeys(each.level for each in report.cells):
        cells = [escape(level)]
        for body, seed in across:
            result = results[level, body, seed]
            colour = "bad" if result.faults else "good"
            text = f"{several(result.faults, 'fault')}, {100.0 * result.coverage:.0f} %"
            cells.append(f'<a class="{colour}" href="{escape(result.report)}">{text}</a>')
        rows.append(_row(cells))
    return f"<table>{''.join(rows)}</table>"


def _list(findings: Sequence[Finding]) -> str:
    if not findings:
        return "<p>None.</p>"
    rows = [_row(["level", "body", "", "what", "where", "seen by"], "th")]
    for each in findings:
        kind = '<span class="tag note">flaky</span>' if each.flaky else '<span class="tag bad">steady</span>'
        if not each.fault.fails:
            kind = "flaky" if each.flaky else ""
        where = ", ".join(f"{value:.2f}" for value in each.fault.position)
        seeds = f"{several(len(each.seeds), 'seed')} of {each.tried}"
        what = f"<b>{escape(each.fault.title)}</b><br>{escape(each.fault.text)}"
        rows.append(_row([escape(each.level), escape(each.body), kind, what, where, seeds]))
    return f"<table>{''.join(rows)}</table>"


def _difference(report: SuiteReport) -> str:
    if not report.history:
        return ""
    parts = [f"<h2>Since the night before</h2><p>{len(report.new)} new, {len(report.gone)} gone</p>"]
    for word, colour, some in (("new", "bad", report.new), ("gone", "good", report.gone)):
        for each in some:
            parts.append(f'<p><span class="tag {colour}">{word}</span> {escape(each.text)}</p>')
    return f"<section>{''.join(parts)}</section>"


def _history(nights: Sequence[Night]) -> str:
    """Steady and flaky faults, and coverage, night after night."""
    most = max(1, *(max(night.steady, night.flaky) for night in nights))
    tops = {"steady": most, "flaky": most, "coverage": 1.0}
    lines = []
    for name, top in tops.items():
        points = " ".join(
            f"{_WIDE * k / max(len(nights) - 1, 1):.1f},{_HIGH * (1.0 - getattr(night, name) / top):.1f}"
            for k, night in enumerate(nights)
        )
        lines.append(f'<polyline points="{points}" fill="none" stroke="{_COLOURS[name]}" stroke-width="2"/>')
    picture = f'<svg viewBox="-4 -4 {_WIDE + 8} {_HIGH + 8}">{"".join(lines)}</svg>'
    key = (
        f'<p class="small">{several(len(nights), "night")}, the last one on the right. Red: steady faults, '
        f"brown: flaky ones, up to {most}. Green: coverage, up to 100 %.</p>"
    )
    return f"<section><h2>Nights</h2>{picture}{key}</section>"
