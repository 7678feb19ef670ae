"""Reports of playtests come back as they were written; what is no report is refused in one sentence."""

import json

import pytest

from runtime.errors import RuntimeInputError
from runtime.playtest.report import read_report, write_report
from tests.runtime.playtest.reports import REPORT


def test_comes_back_as_it_was_written(tmp_path):
    write_report(REPORT, tmp_path / "report.json")
    assert read_report(tmp_path / "report.json") == REPORT


@pytest.mark.parametrize(
    ("keys", "value"),
    [
        (("faults", 0, "kind"), "nothing"),
        (("faults", 0, "position"), [1.0, 2.0]),
        (("faults", 0, "position"), 7),
        (("faults", 0, "text"), None),
        (("setup", "bots"), "4"),
        (("setup", "bots"), True),
        (("crossings", 0, "height"), []),
        (("journeys",), {"x": 1}),
        (("patches",), [[1.0, 2.0, 3.0]]),
        (("coverage",), 1),
        (("reachable",), float("nan")),
        (("reachable",), 10**400),
        (("format",), None),
    ],
)
def test_what_is_no_report_is_refused(tmp_path, keys, value):
    path = tmp_path / "report.json"
    write_report(REPORT, path)
    values = json.loads(path.read_text())
    at = values
    for key in keys[:-1]:
        at = at[key]
    at[keys[-1]] = value
    path.write_text(json.dumps(values))
    with pytest.raises(RuntimeInputError, match=r"report\.json: ") as refused:
        read_report(path)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("text", ["", "[]", "7", "{", "[" * 100_000, "\ud7ff", "1" * 10_000])
def test_what_is_no_json_is_refused(tmp_path, text):
    path = tmp_path / "report.json"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(RuntimeInputError, match=r"report\.json: not a report of a playtest"):
        read_report(path)
