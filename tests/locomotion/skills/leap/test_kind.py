"""The entry of the leap in the registry fits what was learned."""

import pytest

from locomotion.gaits.run.skill import load_run_skill
from locomotion.skills.leap import kind
from locomotion.training.training import Training


def test_what_was_learned_clears_the_sizes_that_the_entry_promises():
    skill = kind.LEAP.load(load_run_skill())
    assert skill is not None and skill.affordance == kind.LEAP.affordance
    assert skill.heights == pytest.approx(kind.LEAP.sizes)
    entry, mark = skill.approach(kind.LEAP.usual)
    assert 2.0 < entry < 5.0 and 0.0 < mark < 4.0


def test_before_it_is_learned_there_is_none(monkeypatch, tmp_path):
    monkeypatch.setattr(kind, "LEAP_DESCRIPTION", tmp_path / "none.yaml")
    assert kind.LEAP.load(load_run_skill()) is None


def test_training_writes_it_where_it_is_told_to(monkeypatch, tmp_path):
    asked = []
    monkeypatch.setattr("locomotion.training.skills.jump.train_described", lambda *given: asked.append(given))
    training = Training(seed=5)
    kind.LEAP.train(training, tmp_path / "new.npz")
    assert asked == [(kind.LEAP_DESCRIPTION, training, tmp_path / "new.npz")]
