"""The page of a suite."""

from runtime.playtest.suite.page import write_suite_page
from runtime.playtest.suite.report import CellResult, Night, SuiteReport


def test_a_quiet_night_held_and_names_are_escaped(tmp_path):
    cells = tuple(CellResult(f"hall & {k}", "dog", 4, 0, 2, 0.625, f"h{k}/report.html") for k in range(2))
    report = SuiteReport(cells, (), history=(Night(2, 1, 0.5),))
    write_suite_page(report, "night <1>", tmp_path / "index.html")
    page = (tmp_path / "index.html").read_text()
    assert "Playtests of night &lt;1&gt;" in page and '"verdict held">held<' in page
    assert page.count("0 faults, 62 %") == 2 and "hall &amp; 1" in page and "dog, seed 4" in page
    assert "0 new, 0 gone" in page and "2 nights" in page and page.count("<polyline") == 3
