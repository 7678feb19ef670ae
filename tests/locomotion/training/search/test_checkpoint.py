"""The folder of a training: it belongs to one configuration, and holds nothing else."""

import json

import pytest

from locomotion.errors import LocomotionError
from locomotion.training.search.checkpoint import CONFIGURATION, claim


@pytest.fixture
def folder(tmp_path):
    return tmp_path / "new" / "hop.checkpoint"


def test_a_folder_is_claimed_once_and_again_by_the_same_configuration(folder):
    asked = {"seed": 3, "marks": (1.3, 0.25), "clip": "ab", "objective": {"pose": 0.1}}
    claim(folder, asked)
    (folder / "done-0.npz").touch()
    claim(folder, asked)
    assert json.loads((folder / CONFIGURATION).read_text())["marks"] == [1.3, 0.25]


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"clip": "cd"}, "clip"),
        ({"objective": {"pose": 0.2}}, "objective"),
        ({"seed": 4, "share": 1.0}, "seed, share"),
    ],
)
def test_a_folder_of_another_configuration_is_refused_by_what_differs(folder, change, named):
    asked = {"seed": 3, "clip": "ab", "objective": {"pose": 0.1}}
    claim(folder, asked)
    with pytest.raises(LocomotionError, match=rf"differs in {named} \(") as refused:
        claim(folder, {**asked, **change})
    assert f"remove {folder} to start over" in str(refused.value)


def test_a_folder_with_anything_else_in_it_is_left_alone(folder):
    folder.mkdir(parents=True)
    (folder / "holiday.jpg").touch()
    with pytest.raises(LocomotionError, match=r"holds files but no configuration\.json"):
        claim(folder, {"seed": 3})
    (folder / "holiday.jpg").rename(folder / f".{CONFIGURATION}.1.x.part.json")  # left by a killed process
    claim(folder, {"seed": 3})


@pytest.mark.parametrize("content", ["", "{", "[1]", "null", "\xff"])
def test_a_damaged_configuration_is_named(folder, content):
    claim(folder, {"seed": 3})
    (folder / CONFIGURATION).write_text(content, encoding="latin-1")
    with pytest.raises(LocomotionError, match=r"configuration\.json: not a training's configuration"):
        claim(folder, {"seed": 3})


def test_a_file_in_the_place_of_the_folder_is_refused(tmp_path):
    (tmp_path / "walk.checkpoint").touch()
    with pytest.raises(LocomotionError, match=r"walk\.checkpoint: not a folder"):
        claim(tmp_path / "walk.checkpoint", {})
