"""The picture of what a skill covers has a plane for each test that varies two numbers."""

import matplotlib.figure
import matplotlib.image
import pytest

from runtime.evaluation.coverage_plot import plot_coverage
from runtime.evaluation.evaluation import Attempt


def attempt(test, held, **at):
    return Attempt(test, "", "", held, at={name.replace("_", " "): value for name, value in at.items()})


ATTEMPTS = [
    attempt("wide", True, run_up=10.0, height=0.4),
    attempt("wide", False, run_up=12.0, height=0.7),
    attempt("wide", True, run_up=14.0, height=0.5),
    attempt("line", True, speed=3.0),
    attempt("bend", False, speed=3.0, turn=5.0),
]


def test_each_trial_is_at_its_place_by_whether_it_held(tmp_path, monkeypatch):
    figures, saved = [], matplotlib.figure.Figure.savefig

    def keep(figure, *arguments, **options):
        figures.append(figure)
        saved(figure, *arguments, **options)

    monkeypatch.setattr(matplotlib.figure.Figure, "savefig", keep)
    plot_coverage("jump", ATTEMPTS, tmp_path / "a.png")
    (figure,) = figures
    wide, bend = figure.axes
    assert (wide.get_title(), wide.get_xlabel(), wide.get_ylabel()) == ("jump: wide", "run up", "height")
    holds, fails = (points.get_offsets().tolist() for points in wide.collections)
    assert holds == [[10.0, 0.4], [14.0, 0.5]] and fails == [[12.0, 0.7]]
    assert [text.get_text() for text in wide.get_legend().get_texts()] == ["holds: 2", "does not: 1"]
    assert bend.get_title() == "jump: bend"
    assert matplotlib.image.imread(tmp_path / "a.png").shape[:2] == (450, 1200)


def test_a_picture_that_fails_leaves_nothing(tmp_path, monkeypatch):
    def fail(*_, **__):
        raise OSError("full")

    monkeypatch.setattr(matplotlib.figure.Figure, "savefig", fail)
    with pytest.raises(OSError, match="full"):
        plot_coverage("jump", ATTEMPTS, tmp_path / "a.png")
    assert list(tmp_path.iterdir()) == []
