"""Learning and evaluating from the command line."""

import json
import time
from dataclasses import replace
from itertools import count

import pytest
from filelock import FileLock

from locomotion.preconditions import precondition
from locomotion.skills import library
from locomotion.skills.jump.kind import JUMP
from locomotion.training.progress import Progress
from locomotion.training.training import NotLearnedError
from runtime.cli import skill_commands
from runtime.cli.app import main
from runtime.cli.skill_commands import _cpu_minutes, _trainers, train_skill
from runtime.errors import RuntimeInputError
from surefoot.workers.pool import worker_pool


def surefoot(capsys, *arguments):
    with pytest.raises(SystemExit) as left:
        main([str(each) for each in arguments])
    output = capsys.readouterr()
    return left.value.code, output.out, output.err


def test_a_checkpoint_in_use_is_refused(capsys, tmp_path):
    checkpoint, skill = tmp_path / "run.checkpoint", tmp_path / "run.npz"
    with FileLock(f"{checkpoint}.lock"):
        code, _, err = surefoot(capsys, "train", "run", "-o", skill, "--checkpoint", checkpoint)
    assert code == 2 and "another process is using this checkpoint" in err and err.count("\n") == 1
    assert not checkpoint.exists() and not skill.exists()


def test_a_checkpoint_in_a_folder_that_is_not_there_is_refused(capsys, tmp_path):
    missing = tmp_path / "no" / "run.checkpoint"
    code, _, err = surefoot(capsys, "train", "run", "-o", tmp_path / "run.npz", "--checkpoint", missing)
    assert code == 2 and "no folder" in err


def test_a_checkpoint_in_a_folder_with_other_files_is_refused(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "notes.txt").touch()
    code, _, err = surefoot(capsys, "train", "walk", "-o", "walk.npz", "--checkpoint", ".")
    assert code == 2 and "holds files but no configuration.json" in err


def interrupted_first(training, out):
    """Takes three minutes, or one that counts and is cut short, where each look at the clock takes one."""
    training.on_progress(Progress("sitting", 1, 1, 0.0, 1.0, 0.0, 0.0))
    if not training.checkpoint.exists():
        training.checkpoint.touch()
        raise KeyboardInterrupt


def test_the_time_before_an_interruption_counts(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("runtime.cli.skill_commands._trainers", lambda: {"sit": interrupted_first})
    monkeypatch.setattr("runtime.cli.skill_commands._cpu_minutes", count().__next__)
    assert surefoot(capsys, "train", "--all")[0] == 130
    code, out, _ = surefoot(capsys, "train", "--all")
    assert code == 0 and out.splitlines()[1:] == [
        f"{name:12} {3.0:7.1f} core-minutes" for name in ("sit", "in all")
    ]
    (tmp_path / "sit.checkpoint.minutes").write_text("noon")
    code, _, err = surefoot(capsys, "train", "--all")
    assert code == 2 and "sit.checkpoint.minutes: expected the minutes" in err
    (tmp_path / "sit.checkpoint").unlink()
    assert surefoot(capsys, "train", "--all")[0] == 130
    assert (tmp_path / "sit.checkpoint.minutes").read_text() == "1.000\n"


@pytest.fixture
def never(monkeypatch):
    """A package whose sitting is learned, whose standing never works, and whose lying comes after it."""

    def train(training, out):
        if out.stem == "stand":
            raise NotLearnedError("stand does not work")
        out.write_text(f"learned with seed {training.seed}")

    names = ("sit", "stand", "lie")
    monkeypatch.setattr("runtime.cli.skill_commands._trainers", lambda: dict.fromkeys(names, train))


@pytest.mark.usefixtures("never")
def test_a_skill_that_never_works_is_said_so_and_fails(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = train_skill("stand", tmp_path / "stand.npz", 0, 1, None, 1.0, False)
    result.show()
    output = capsys.readouterr()
    assert not result.held and not (tmp_path / "stand.npz").exists()
    assert "stand does not work. No skill was written" in output.err and "learned in" not in output.out


@pytest.mark.usefixtures("never")
def test_the_library_ends_with_what_never_works(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(library, "SKILLS", tmp_path)
    code, out, err = surefoot(capsys, "train", "--all")
    assert code == 1 and "sit learned in" in out and "stand does not work" in err
    assert (tmp_path / "sit.npz").exists() and not (tmp_path / "lie.npz").exists()


@pytest.mark.usefixtures("never")
def test_the_packages_skills_are_replaced_only_when_asked_to(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(library, "SKILLS", tmp_path / "package")
    (tmp_path / "package").mkdir()
    mine, other = tmp_path / "package" / "lie.npz", tmp_path / "lie.npz"
    mine.write_text("as it came")
    for arguments in (["--all"], ["--all", "--seed", 1]):
        code, _, err = surefoot(capsys, "train", *arguments)
        assert code == 2 and f"{mine}: is the built-in lie" in err and "--replace" in err
    assert list(tmp_path.glob("**/*.npz")) == [mine]
    with pytest.raises(RuntimeInputError, match=r"built-in lie.* \(-o lie\.npz\)"):
        train_skill("lie", None, 0, 1, None, 1.0, False)
    assert train_skill("lie", other, 5, 1, None, 1.0, False).held
    assert (mine.read_text(), other.read_text()) == ("as it came", "learned with seed 5")
    assert train_skill("lie", None, 6, 1, None, 1.0, True).held
    assert mine.read_text() == "learned with seed 6"
    assert surefoot(capsys, "train", "--all", "--replace", "--seed", 7)[0] == 1  # standing never works
    assert (tmp_path / "package" / "sit.npz").read_text() == "learned with seed 7"


def test_who_trains_a_skill_of_the_package_is_told_that_its_precondition_is_outdated(capsys, monkeypatch):
    skill_commands._tell_outdated()
    assert capsys.readouterr().err == ""
    digest = precondition.skill_and_run
    monkeypatch.setattr(
        precondition, "skill_and_run", lambda skill: "another" if skill == "vault" else digest(skill)
    )
    skill_commands._tell_outdated()
    assert "the preconditions of vault belong to the skills before" in capsys.readouterr().err


def test_the_packages_skills_are_where_they_are_replaced():
    for skill in _trainers():
        assert library.package_skill(skill).is_file()


def test_training_jump_leaves_the_packages_jump_alone(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, _, err = surefoot(capsys, "train", "jump")
    assert code == 2 and "is the built-in jump" in err and not list(tmp_path.iterdir())


def test_a_picture_of_tests_without_a_plane_is_refused_before_they_run(capsys, tmp_path, monkeypatch):
    def run(*arguments):
        raise AssertionError

    monkeypatch.setattr("runtime.evaluation.evaluate.evaluate", run)
    for name in ("walk", "speed-up", "slow-down", "brake"):
        code, _, err = surefoot(capsys, "evaluate", name, "--picture", tmp_path / "x.png")
        assert code == 2 and f"the tests of {name} do not vary in two numbers" in err
    monkeypatch.setattr("os.access", lambda path, mode: False)
    code, _, err = surefoot(capsys, "evaluate", "run", "--picture", tmp_path / "x.png")
    assert code == 2 and "is not writable" in err


def compute(seconds):
    while time.process_time() < seconds:
        pass


def test_what_workers_compute_counts_while_they_live_and_after():
    before, least = _cpu_minutes(), 1.9 / 60.0  # the system counts whole ticks of 10 ms
    with worker_pool(2, compute, (1.0,)) as pool:
        pool.map(compute, [1.0, 1.0])
        assert _cpu_minutes() - before >= least
    assert _cpu_minutes() - before >= least


@pytest.mark.parametrize(("skill", "tests"), [("jump", 3), ("run", 6)])
def test_evaluate_prints_a_table_and_the_same_as_json_and_draws_it(capsys, tmp_path, skill, tests):
    asked = ("evaluate", skill, "--trials", "1", "--seed", "3")
    code, out, _ = surefoot(capsys, *asked, "--json", "--picture", tmp_path / "x.png")
    assert (tmp_path / "x.png").read_bytes().startswith(b"\x89PNG")
    result = json.loads(out)
    assert [test["trials"] for test in result["tests"]] == [1] * tests
    for test in result["tests"]:
        tried = [each for each in result["attempts"] if each["test"] == test["test"]]
        assert test["held"] == sum(each["held"] for each in tried)
    assert code == (0 if all(test["held"] == 1 for test in result["tests"]) else 1)
    again, table, _ = surefoot(capsys, *asked)
    assert again == code
    for test in result["tests"]:
        assert f"| {test['test']} | {100.0 * test['held']:.1f} % of 1 |" in table


def test_heights_beyond_what_was_learned_count_as_not_held(capsys, monkeypatch):
    high = replace(JUMP, sizes=(3.0, 4.0), usual=3.0)
    monkeypatch.setattr("locomotion.skills.registry._kinds", {"jump": high})
    _, out, _ = surefoot(capsys, "evaluate", "jump", "--trials", "1", "--json")
    beyond = json.loads(out)["attempts"][1]
    assert beyond["status"] == "not learned for this height" and beyond["held"] is False
