"""A folder for results is checked before the work begins, and not made yet."""

import pytest

from surefoot import SurefootError
from surefoot.files.inputs import keep_inputs
from surefoot.files.outputs import check_output_folder


def test_files_are_named_and_nothing_is_made(tmp_path):
    folder = tmp_path / "new" / "deeper"
    assert check_output_folder(folder, ["a.json", "b.npz"]) == [folder / "a.json", folder / "b.npz"]
    assert not (tmp_path / "new").exists()


def test_a_file_in_the_place_of_a_folder_is_named(tmp_path):
    (tmp_path / "out").write_text("")
    for path in (tmp_path / "out", tmp_path / "out" / "deeper" / "still"):
        with pytest.raises(SurefootError, match=r"out' is not a folder; give one for the results"):
            check_output_folder(path, ["a.json"])


def test_a_folder_that_cannot_be_written_to_is_named(tmp_path, monkeypatch):
    """The first folder that exists counts. (The real `os.access` allows an administrator everything.)"""
    monkeypatch.setattr("os.access", lambda path, mode: path != tmp_path)
    with pytest.raises(SurefootError, match=f"deeper: '{tmp_path}' is not writable"):
        check_output_folder(tmp_path / "out" / "deeper", ["a.json"])


def test_inputs_in_it_are_not_written_over(tmp_path):
    (tmp_path / "b.npz").write_text("read")
    with keep_inputs([tmp_path / "b.npz"]):
        check_output_folder(tmp_path, ["a.json"])
        with pytest.raises(SurefootError, match=r"b\.npz: is an input of this command"):
            check_output_folder(tmp_path, ["a.json", "b.npz"])
