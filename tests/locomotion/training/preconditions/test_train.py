"""All preconditions are learned by one call."""

from types import SimpleNamespace

from locomotion.preconditions.changes import CHANGES
from locomotion.training.preconditions import train as module
from locomotion.training.preconditions.train import sampled_skills, train_preconditions


def test_each_skill_is_sampled_and_its_precondition_written(tmp_path, monkeypatch):
    asked, saved = [], []

    def sample(skill, count, seed, out, place, progress):
        asked.append((skill, count, seed, out))
        return skill

    monkeypatch.setattr(module, "sample", sample)
    monkeypatch.setattr(
        module, "fit_precondition", lambda outcomes: SimpleNamespace(skill=outcomes, save=saved.append)
    )
    train_preconditions(tmp_path / "kept", 3, 70, 1, tmp_path)
    assert [each[0] for each in asked] == ["jump", "vault", "drop-roll", "leap", *CHANGES]
    assert sampled_skills() == tuple(each[0] for each in asked)
    assert [each[1] for each in asked] == [70] * 4 + [28, 21, 14, 14]
    assert asked[2] == ("drop-roll", 70, 3, tmp_path / "kept" / "drop-roll.npz")
    assert saved[2] == tmp_path / "drop_roll.npz"
