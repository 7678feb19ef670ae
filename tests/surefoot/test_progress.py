"""What is told while something takes long, on a terminal and in a pipe."""

import io

import pytest
from rich.console import Console

from surefoot import progress
from surefoot.compile_notice import TIME
from surefoot.progress import Progress

LONGEST = (f"compiling kernels, once: {TIME}", "running and jumping")


def test_in_a_pipe_lines_tell_of_each_tenth(capsys):
    with Progress().stage("running") as stage:
        for k in range(1000):
            stage.update(k / 1000, f"{k} done")
    assert capsys.readouterr().err.splitlines() == [
        "running", *(f"running: {10 * k} %, {100 * k} done" for k in range(1, 10)), "running: done"
    ]  # fmt: skip


def test_what_has_no_tenths_is_told_when_it_begins(capsys):
    with Progress().stage("building"):
        assert capsys.readouterr().err == "building\n"
    assert capsys.readouterr().err == ""


def test_it_can_be_quiet(capsys):
    with Progress(shown=False).stage("running") as stage:
        stage.update(0.5)
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize("width", [60, 80, 120])
def test_a_bar_is_not_cut_off(width):
    label, note = LONGEST
    out = io.StringIO()
    console = Console(file=out, force_terminal=True, width=width, color_system=None)
    stage = progress._Bar(label, console)
    with stage.told():
        stage.update(0.4, note)
        stage._bars.refresh()
    shown = out.getvalue()
    assert "…" not in shown
    if width >= 80:
        assert f"{label}: {note}" in shown and ("40 %" in shown or width > 110)
