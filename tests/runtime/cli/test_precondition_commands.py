"""Sampling, learning and judging preconditions from the command line."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

from locomotion.preconditions.precondition import load_precondition, precondition_file
from locomotion.training.preconditions import outcomes as sampling
from locomotion.training.preconditions import train as training
from runtime.cli.app import main
from runtime.evaluation import preconditions as judging
from runtime.evaluation.preconditions import Bin


def surefoot(capsys, *arguments):
    with pytest.raises(SystemExit) as left:
        main([str(each) for each in arguments])
    output = capsys.readouterr()
    return left.value.code, output.out, output.err


def test_a_skill_is_sampled_into_a_file(capsys, tmp_path):
    asked = ("sample", "jump", "--count", "1", "--seed", "5", "-o", tmp_path / "jump.npz")
    code, out, _ = surefoot(capsys, *asked, "--json")
    told = json.loads(out)
    assert code == 0 and sum(told["ends"].values()) == 1 and (tmp_path / "jump.npz").exists()
    code, _, err = surefoot(capsys, "sample", "fly", "-o", tmp_path / "fly.npz")
    assert code == 2 and "jump, vault, drop-roll, leap, walk-to-run" in err.replace("\n", " ")


def test_the_built_in_ones_are_not_overwritten_by_accident(capsys, tmp_path, monkeypatch):
    code, _, err = surefoot(capsys, "train", "preconditions")
    assert code == 2 and "use --replace to overwrite them all" in err
    code, _, err = surefoot(capsys, "train", "preconditions", "-o", tmp_path / "none")
    assert code == 2 and "no such folder" in err
    learned = SimpleNamespace(skill="jump", meta={"starts": 8, "holds": 0.5, "features": {"size": 0.2}})
    monkeypatch.setattr(training, "train_preconditions", lambda *arguments: [learned])
    code, out, _ = surefoot(capsys, "train", "preconditions", "-o", tmp_path, "--effort", "0.02")
    assert code == 0 and "jump: 8 starts, 50 % hold; size 0.200" in out


def test_odds_are_judged_on_other_starts_and_drawn(capsys, tmp_path, monkeypatch):
    learned_from = load_precondition(precondition_file("jump")).meta["seed"]
    code, _, err = surefoot(capsys, "evaluate", "preconditions", "--seed", learned_from)
    assert code == 2 and "is what the odds were learned from" in err
    rng = np.random.default_rng(0)
    odds = rng.random(200)
    found = [judging.judged("jump", "at take-off", False, odds, rng.random(200) < odds)]
    monkeypatch.setattr(sampling, "sample", lambda *arguments: None)
    monkeypatch.setattr(judging, "judge", lambda known, outcomes: (found, [Bin(200, 0.5, 0.52)]))
    asked = ("evaluate", "preconditions", "--seed", learned_from + 1)
    code, out, _ = surefoot(capsys, *asked, "--picture", tmp_path / "odds.png")
    assert code == 0 and "| jump | at take-off | all | 200 |" in out and (tmp_path / "odds.png").exists()
    code, out, _ = surefoot(capsys, *asked, "--json")
    assert json.loads(out)["judgements"][0]["count"] == 200
