"""What is new, gone and as before since an earlier report."""

from dataclasses import replace

import trimesh

from runtime.playtest import playtest
from runtime.playtest.diff import compare
from runtime.playtest.fault import Fault
from tests.runtime.playtest.levels import box
from tests.runtime.playtest.reports import REPORT


def test_a_mended_level_differs_from_before(level, outcome, tmp_path):
    mesh = trimesh.util.concatenate([trimesh.load_mesh(level, process=False), box(4, 6, 5, 7, -1.5, 0)])
    mesh.export(tmp_path / "yard.obj")
    mended = playtest(tmp_path / "yard.obj", bots=0).report
    assert mended.held
    assert [fault.kind for fault in compare(outcome.report, mended).gone if fault.fails] == ["trap"]


def report(*faults, coverage=()):
    return replace(REPORT, faults=faults, coverage=coverage)


def fault(x, kind="gap", fails=True):
    return Fault(kind, (x, 0.0, 0.0), "", fails)


def test_findings_of_a_kind_that_are_near_are_the_same():
    difference = compare(report(fault(0.0), fault(9.0)), report(fault(1.9), fault(20.0)))
    assert difference.kept == (fault(1.9),) and difference.new == (fault(20.0),)
    assert difference.gone == (fault(9.0),)


def test_another_kind_or_weight_is_another_finding():
    before = report(fault(0.0))
    for after in (fault(0.0, kind="step"), fault(0.0, fails=False), fault(2.1)):
        difference = compare(before, report(after))
        assert (difference.new, difference.gone, difference.kept) == ((after,), before.faults, ())


def test_one_finding_stands_for_one_only():
    difference = compare(report(fault(0.0)), report(fault(0.5), fault(0.6)))
    assert (difference.kept, difference.new) == ((fault(0.5),), (fault(0.6),))


def test_coverage_is_that_of_the_end():
    assert compare(report(), report(coverage=((1.0, 0.2), (2.0, 0.6)))).coverage == (0.0, 0.6)
