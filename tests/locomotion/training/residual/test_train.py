"""Learning to correct braking from end to end, so short that little is learned."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from locomotion.errors import LocomotionError
from locomotion.training.policies.groups import Groups
from locomotion.training.policies.learning import Learning
from locomotion.training.residual import train
from locomotion.training.residual.braking import braking_group
from locomotion.training.training import NotLearnedError, Training


@pytest.fixture
def short(monkeypatch):
    monkeypatch.setattr(train, "BRAKING_STAGES", train.BRAKING_STAGES[1:])
    monkeypatch.setattr(train, "LANDING_STAGES", train.LANDING_STAGES[1:])
    monkeypatch.setattr(train, "_PEOPLE", 2)
    monkeypatch.setattr(train, "_TRIALS", 2)
    monkeypatch.setattr(train, "_HOLD", 1.1)


def test_what_does_not_hold_is_not_written(short, tmp_path):
    training = Training(0, tmp_path / "checkpoint", effort=1e-6, on_progress=lambda p: None)
    with pytest.raises(NotLearnedError, match=r"brake-residual does not work: \d of 2 hold"):
        train.train_brake_residual(training, tmp_path / "brake.npz")
    assert not (tmp_path / "brake.npz").exists()
    with pytest.raises(LocomotionError, match="belongs to another configuration"):
        train.train_brake_residual(Training(1, tmp_path / "checkpoint", effort=1e-6), tmp_path / "brake.npz")


def test_an_interrupted_learning_ends_with_the_same_bits(tmp_path):
    stages = [replace(stage, samples=4 * 24) for stage in train.BRAKING_STAGES[:2]]

    def learning(checkpoint=None):
        def people(seed):
            return Groups(partial(braking_group, 2, 2, 3), 1, 1, stages[0], seed)

        return Learning(people, stages, 0, checkpoint, lambda p: None, kept_every=1)

    whole = learning().run()
    for _ in range(5):
        last = learning(tmp_path / "brake.npz").run(most=1)
    assert all(
        np.array_equal(a, b) for a, b in zip(whole.arrays().values(), last.arrays().values(), strict=True)
    )


def test_landings_that_do_not_hold_are_not_written(short, tmp_path):
    training = Training(0, None, effort=1e-6, on_progress=lambda p: None)
    with pytest.raises(NotLearnedError, match=r"landing-residual does not work: \d of 2 hold"):
        train.train_landing_residual(training, tmp_path / "landing.npz")
    assert not (tmp_path / "landing.npz").exists()


def test_a_correction_of_other_skills_is_outdated(monkeypatch):
    assert train.outdated_residuals() == []
    monkeypatch.setattr(train, "skill_digest", lambda name: "another")
    assert train.outdated_residuals() == ["brake-residual", "landing-residual"]
