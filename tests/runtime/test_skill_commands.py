"""Learning and evaluating from the command line."""

import json

import pytest
from filelock import FileLock

from runtime.cli import main


def surefoot(capsys, *arguments):
    with pytest.raises(SystemExit) as left:
        main([str(each) for each in arguments])
    output = capsys.readouterr()
    return left.value.code, output.out, output.err


def test_a_checkpoint_in_use_is_refused(capsys, tmp_path):
    checkpoint, skill = tmp_path / "run.checkpoint", tmp_path / "run.npz"
    with FileLock(f"{checkpoint}.lock"):
        code, _, err = surefoot(capsys, "train", "run", "-o", skill, "--checkpoint", checkpoint)
    assert code == 2 and "another process learns with this checkpoint" in err and err.count("\n") == 1
    assert not checkpoint.exists() and not skill.exists()


def test_a_checkpoint_in_a_folder_that_is_not_there_is_refused(capsys, tmp_path):
    missing = tmp_path / "no" / "run.checkpoint"
    code, _, err = surefoot(capsys, "train", "run", "-o", tmp_path / "run.npz", "--checkpoint", missing)
    assert code == 2 and "there is no folder" in err


def test_what_was_resumed_does_not_count_the_time_before(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(
        "runtime.skill_commands._trainers", lambda: dict.fromkeys(["sit", "lie"], lambda training: None)
    )
    _, whole, _ = surefoot(capsys, "train", "--all")
    (tmp_path / "lie.checkpoint").touch()
    _, resumed, _ = surefoot(capsys, "train", "--all")
    assert whole.count("core-minutes") == 5 and "resumed" not in whole
    said = [line for line in resumed.splitlines() if "since it was resumed" in line]
    assert [line.split()[0] for line in said] == ["lie", "in"]


@pytest.mark.parametrize(("skill", "tests"), [("jump", 2), ("run", 6)])
def test_evaluate_prints_a_table_and_the_same_as_json(capsys, skill, tests):
    code, out, _ = surefoot(capsys, "evaluate", skill, "--trials", "2", "--seed", "3", "--json")
    result = json.loads(out)
    assert [test["trials"] for test in result["tests"]] == [2] * tests
    for test in result["tests"]:
        tried = [each for each in result["attempts"] if each["test"] == test["test"]]
        assert test["held"] == sum(each["held"] for each in tried)
    assert code == (0 if all(test["held"] == 2 for test in result["tests"]) else 1)
    again, table, _ = surefoot(capsys, "evaluate", skill, "--trials", "2", "--seed", "3")
    assert again == code
    for test in result["tests"]:
        assert f"| {test['test']} | {50.0 * test['held']:.1f} % of 2 |" in table


def test_heights_beyond_what_was_learned_count_as_not_held(capsys, monkeypatch):
    monkeypatch.setattr("runtime.evaluation.HEIGHTS", {"jump": (3.0, 4.0)})
    _, out, _ = surefoot(capsys, "evaluate", "jump", "--trials", "1", "--json")
    beyond = json.loads(out)["attempts"][1]
    assert beyond["status"] == "not learned for this height" and beyond["held"] is False
