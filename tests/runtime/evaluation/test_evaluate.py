"""Trials are made wherever there are workers, and shown as they come."""

import pytest

from runtime.evaluation import evaluate as module
from runtime.evaluation.evaluate import evaluate
from runtime.evaluation.evaluation import Attempt
from surefoot.progress import Progress


def test_how_many_held_so_far_is_shown(capsys, monkeypatch):
    attempts = [Attempt("a", "", "", held) for held in (True, False)]
    monkeypatch.setattr(module, "_trials_of", lambda *_: [lambda each=each: each for each in attempts])
    assert evaluate("jump", 2, 0, progress=Progress()) == attempts
    assert capsys.readouterr().err.splitlines()[1] == "evaluating: jump: 50 %, 1 of 1 held"


def test_what_is_neither_a_skill_nor_a_file_is_refused():
    with pytest.raises(Exception, match="dance"):
        evaluate("dance.yaml", 1, 0)
