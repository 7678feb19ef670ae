"""Findings of several seeds, steady and flaky, and of two nights."""

from runtime.playtest.fault import Fault
from runtime.playtest.report import Report, Setup
from runtime.playtest.suite.findings import changed, findings_of


def fault(kind, x, **more):
    return Fault(kind, (x, 0.0, 0.0), f"{kind} at {x}", **more)


def report(seed, *faults):
    setup = Setup("yard.obj", None, None, None, "walker", 1, 1.0, seed)
    return Report(setup, "", {}, faults, (), (), (), (), 1.0)


def test_what_every_seed_shows_is_steady_and_the_rest_flaky():
    seen = findings_of(
        "yard", "walker",
        [
            report(1, fault("hole", 0.0), fault("fell", 5.0)),
            report(2, fault("hole", 0.5), fault("narrow", 5.0)),
            report(3, fault("hole", 9.0), fault("hole", 1.0)),
        ],
    )  # fmt: skip
    told = [(each.fault.text, each.seeds, each.flaky) for each in seen]
    assert told == [
        ("hole at 0.0", (1, 2, 3), False),
        ("fell at 5.0", (1,), True),
        ("narrow at 5.0", (2,), True),
        ("hole at 9.0", (3,), True),
    ]


def test_two_findings_of_one_report_are_two():
    seen = findings_of("yard", "walker", [report(1, fault("hole", 0.0), fault("hole", 0.5))])
    assert len(seen) == 2


def test_faults_and_notes_are_not_the_same():
    seen = findings_of(
        "yard", "walker", [report(1, fault("fell", 0.0)), report(2, fault("fell", 0.0, fails=False))]
    )
    assert len(seen) == 2


def test_new_and_gone_since_the_night_before():
    before = findings_of("yard", "walker", [report(1, fault("hole", 0.0), fault("trap", 3.0))])
    after = findings_of("yard", "walker", [report(1, fault("trap", 3.5), fault("low", 8.0))])
    new, gone = changed(before, after)
    assert [each.fault.kind for each in new] == ["low"] and [each.fault.kind for each in gone] == ["hole"]
    elsewhere = findings_of("hall", "walker", [report(1, fault("trap", 3.5))])
    assert len(changed(before, elsewhere)[0]) == 1
