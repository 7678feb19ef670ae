"""Learning that comes to its end without a success: it says so, and writes no skill."""

import numpy as np
import pytest

from locomotion.skills.description import load_description
from locomotion.skills.drop_roll.skill import load_drop_roll_skill
from locomotion.skills.leap.kind import LEAP_DESCRIPTION
from locomotion.skills.vault.skill import load_vault_skill
from locomotion.training.gaits import brake, run, slow_down, speed_up, walk
from locomotion.training.search.loop import Stage
from locomotion.training.skills import drop_roll, vault
from locomotion.training.skills.jump import train_described
from locomotion.training.skills.jump_trial import JumpSimulator
from locomotion.training.training import NotLearnedError, Training


class Darts:
    """Two throws a generation, of which those hit that are as good as the candidate needs."""

    def stages(self):
        return [Stage("first", 1, 1.0, np.ones(1)), Stage("last", 1, 1.0, np.ones(1))]

    def start(self):
        return np.zeros(1)

    def scenarios(self, stage, generation, rng):
        assert stage.name == "last"
        return list(rng.random(2))

    def evaluate(self, stage, candidate, scenarios):
        assert len(scenarios) == 1
        return 0.0, float(scenarios[0] > candidate[0])


@pytest.mark.parametrize("needs", [0.0, 0.9])
def test_one_success_is_enough(needs):
    Training().demand_success("darts", Darts(), np.array([needs]))


def test_none_is_not():
    with pytest.raises(NotLearnedError, match="darts does not work: after 'last' none of 24 trials succeeds"):
        Training().demand_success("darts", Darts(), np.array([1.0]))


@pytest.fixture
def as_it_began(monkeypatch):
    """Nothing is learned."""
    monkeypatch.setattr(Training, "learn", lambda self, problem, *arguments, **more: problem.start())
    monkeypatch.setattr(JumpSimulator, "fit_stride", lambda self, entry, rng: (0.25, 0.0, 0.25))


def own(folder, **changes):
    clip = load_description(LEAP_DESCRIPTION).clip
    said = {"name": "hop", "affordance": "gap", "sizes": [1.6], "least": 0.5, "clip": str(clip), **changes}
    path = folder / "hop.yaml"
    path.write_text("".join(f"{key}: {value}\n" for key, value in {**said, "learned": "hop.npz"}.items()))
    (folder / "hop.npz").write_bytes(b"learned before")
    return path


@pytest.mark.usefixtures("as_it_began")
def test_a_skill_of_ones_own_that_never_clears_a_size_is_not_written(tmp_path):
    path = own(tmp_path, pace=[0.1, 0.1, 0.1, 0.1], entry=3.5)
    with pytest.raises(NotLearnedError, match=r"hop skill does not work: after '1\.6 m, feedback' none of"):
        train_described(path, Training(checkpoint=tmp_path / "kept", effort=0.01))
    assert (tmp_path / "hop.npz").read_bytes() == b"learned before"


@pytest.mark.usefixtures("as_it_began")
def test_a_skill_of_ones_own_that_no_run_up_comes_to_is_not_written(tmp_path, monkeypatch):
    monkeypatch.setattr(JumpSimulator, "harvest", lambda *arguments: [])
    with pytest.raises(NotLearnedError, match=r"no run-up to 1\.6 m comes to where the last step begins"):
        train_described(own(tmp_path), Training(effort=0.01))


def all_but_the_last(monkeypatch, last, arrays):
    """What was found before the search ``last``, by each one."""
    monkeypatch.setattr(
        Training, "recall", lambda self, kind, number, kinds: arrays() if number < last else None
    )


def vaulted():
    skill = load_vault_skill()
    arrays = {"heights": skill.heights, "table": skill.table, "references": skill.references}
    return {**arrays, "refined": np.zeros_like(skill.table[0])}


def rolled():
    skill = load_drop_roll_skill()
    return {"x": skill.table[0], "reference": skill.references[0]}


@pytest.mark.usefixtures("as_it_began")
@pytest.mark.parametrize("skill", ["walk", "run", "speed-up", "slow-down", "brake", "vault", "drop-roll"])
def test_a_skill_of_the_package_that_never_works_is_not_written(skill, tmp_path, monkeypatch):
    def refuse(training, name, problem, learned):
        assert name == skill and learned.shape == problem.start().shape
        raise NotLearnedError(name)

    monkeypatch.setattr(Training, "demand_success", refuse)
    monkeypatch.setattr(run, "begin", lambda training, stages, clock: run.first_guess())
    monkeypatch.setattr(brake, "draw_starts", lambda *arguments: [])
    monkeypatch.setattr(vault, "_STATES", 4)
    monkeypatch.setattr(drop_roll, "_STATES", 4)
    monkeypatch.setattr(drop_roll, "_ROLLS", 2)
    monkeypatch.setattr(drop_roll, "fit", lambda problem, x, *arguments: x)
    train = {
        "walk": walk.train_walk, "run": run.train_run, "speed-up": speed_up.train_speed_up,
        "slow-down": slow_down.train_slow_down, "brake": brake.train_brake, "vault": vault.train_vault,
        "drop-roll": drop_roll.train_drop_roll,
    }[skill]  # fmt: skip
    if skill == "vault":
        all_but_the_last(monkeypatch, len(vault.curriculum(Training())) - 1, vaulted)
    if skill == "drop-roll":
        all_but_the_last(monkeypatch, 4, rolled)
    with pytest.raises(NotLearnedError):
        train(Training(effort=0.01), tmp_path / "skill.npz")
    assert not (tmp_path / "skill.npz").exists()
