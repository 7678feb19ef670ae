"""A training: its folder, what it builds on, what it keeps."""

from dataclasses import replace

import numpy as np
import pytest

from locomotion.errors import LocomotionError
from locomotion.skills import library
from locomotion.training.search.loop import Stage
from locomotion.training.training import Training
from surefoot.files.archive import ArchiveError
from surefoot.files.schema import Numbers


@pytest.fixture
def folder(tmp_path):
    return tmp_path / "new" / "hop.checkpoint"


STAGE = Stage("bowl", 4, 0.5, np.ones(3), {"states": 2})


def prepared(training, out, **changes):
    said = {"skill": "hop", "stages": [STAGE], "builds_on": ("walk",), "clip": "ab", **changes}
    training.prepare(said.pop("skill"), out, said.pop("stages"), said.pop("builds_on"), **said)


def test_a_training_goes_on_in_its_folder_with_the_same_configuration_only(folder, tmp_path, monkeypatch):
    training, out = Training(seed=4, checkpoint=folder), tmp_path / "hop.npz"
    prepared(training, out)
    prepared(replace(training, workers=1), tmp_path / "elsewhere.npz")
    changes = {
        "skill": {"skill": "leap"},
        "clip": {"clip": "cd"},
        "stages": {"stages": [replace(STAGE, options={"states": 3})]},
        "run skill": {"builds_on": ("walk", "run")},
    }
    for name, change in changes.items():
        with pytest.raises(LocomotionError, match=f"differs in {name} "):
            prepared(training, out, **change)
    for name, value in {"seed": 5, "effort": 0.5}.items():
        with pytest.raises(LocomotionError, match=f"differs in {name} "):
            prepared(replace(training, **{name: value}), out)
    monkeypatch.setattr("locomotion.training.training.person_digest", lambda: "taller")
    with pytest.raises(LocomotionError, match="differs in person "):
        prepared(training, out)


def test_a_training_notices_that_what_it_builds_on_was_learned_anew(folder, tmp_path, monkeypatch):
    (tmp_path / "walk.npz").write_bytes(b"as it was")
    (tmp_path / "walk.yaml").write_bytes(b"its clip")
    monkeypatch.setattr(library, "SKILLS", tmp_path)
    monkeypatch.setattr(library, "CLIPS", tmp_path)
    prepared(Training(checkpoint=folder), tmp_path / "hop.npz")
    for file, content in (("walk.npz", b"learned anew"), ("walk.yaml", b"another clip")):
        before = (tmp_path / file).read_bytes()
        (tmp_path / file).write_bytes(content)
        with pytest.raises(LocomotionError, match="differs in walk skill "):
            prepared(Training(checkpoint=folder), tmp_path / "hop.npz")
        (tmp_path / file).write_bytes(before)
    prepared(Training(checkpoint=folder), tmp_path / "hop.npz")


def test_where_the_skill_cannot_be_written_is_known_before_learning(folder, tmp_path, monkeypatch):
    training = Training(checkpoint=folder)
    with pytest.raises(ArchiveError, match="no folder"):
        prepared(training, tmp_path / "missing" / "hop.npz")
    with pytest.raises(ArchiveError, match="is a folder"):
        prepared(training, tmp_path)
    monkeypatch.setattr("os.access", lambda path, mode: False)
    with pytest.raises(ArchiveError, match="is not writable"):
        prepared(training, tmp_path / "hop.npz")
    assert not folder.exists()


KEPT = {"x": Numbers(3)}


def test_what_a_search_has_found_is_kept(folder, tmp_path):
    found = {"x": np.arange(3.0)}
    Training().keep("toy", 0, found)
    assert Training().recall("toy", 0, KEPT) is None  # kept nowhere
    training = Training(checkpoint=folder)
    prepared(training, tmp_path / "hop.npz")
    assert training.recall("toy", 0, KEPT) is None
    training.keep("toy", 0, found)
    np.testing.assert_array_equal(training.recall("toy", 0, KEPT)["x"], found["x"])
    done = folder / "done-0.npz"
    done.write_bytes(done.read_bytes()[:200])
    with pytest.raises(LocomotionError, match="cut off or damaged") as refused:
        training.recall("toy", 0, KEPT)
    assert f"remove {done} to train this part again" in str(refused.value)
