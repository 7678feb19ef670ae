"""The training of the walk from end to end, so short that nothing is learned."""

from collections import Counter

import pytest

from locomotion.errors import LocomotionError
from locomotion.training.policies import walk
from locomotion.training.policies.curriculum import CATCHING, RUNNING, STANDING, WALKING
from locomotion.training.policies.walk import train_walk_policy
from locomotion.training.training import NotLearnedError, Training


def test_what_does_not_walk_is_not_written(tmp_path, monkeypatch, reference, both):
    told = Counter()
    training = Training(0, tmp_path / "checkpoint", effort=1e-6, on_progress=lambda p: told.update([p.stage]))
    monkeypatch.setattr(walk, "WALKING", WALKING[4:])
    monkeypatch.setattr(walk, "RUNNING", RUNNING[:1])
    monkeypatch.setattr(walk, "STANDING", STANDING[:1])
    monkeypatch.setattr(walk, "_PEOPLE", 16)
    monkeypatch.setattr(walk, "_STANDERS", 16)
    monkeypatch.setattr(walk, "_PUSHED_FOR", 40)
    monkeypatch.setattr(walk, "_TAKEOVERS", 30)
    monkeypatch.setattr(walk, "_OUT_OF_RUNS", 30)
    monkeypatch.setattr(walk, "make_reference", lambda: reference)
    monkeypatch.setattr(walk, "with_run", lambda walks: both)
    with pytest.raises(NotLearnedError, match=r"walk-policy does not work: at 0.8 m/s it falls within 18 s"):
        train_walk_policy(training, tmp_path / "policy.npz")
    assert not (tmp_path / "policy.npz").exists()
    learned = WALKING[4:] + RUNNING[:1] + STANDING[:1] + CATCHING
    assert told == {stage.name: 1 for stage in learned}
    with pytest.raises(LocomotionError, match="belongs to another configuration"):
        train_walk_policy(Training(1, tmp_path / "checkpoint", effort=1e-6), tmp_path / "policy.npz")
