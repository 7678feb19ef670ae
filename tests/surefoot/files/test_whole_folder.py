"""Folders appear whole or not at all, whatever happens while they are written."""

import os
import subprocess
import sys

import pytest

from surefoot.errors import SurefootError
from surefoot.files.whole_folder import check_folder_target, whole_folder


def fill(path, text):
    with whole_folder(path, "index") as temporary:
        (temporary / "index").write_text(text)
        (temporary / text).write_text(text)


def test_a_folder_replaces_the_old_one_when_it_is_whole(tmp_path):
    target = tmp_path / "world"
    fill(target, "old")
    fill(target, "new")
    assert {each.name for each in target.iterdir()} == {"index", "new"}
    assert list(tmp_path.iterdir()) == [target]


@pytest.mark.parametrize("interruption", [OSError, KeyboardInterrupt, SystemExit])
def test_an_interruption_leaves_the_old_one_and_nothing_beside_it(tmp_path, interruption):
    target = tmp_path / "world"
    for before in ([], [target]):
        with pytest.raises(interruption), whole_folder(target, "index") as temporary:
            (temporary / "index").write_text("half")
            raise interruption
        assert list(tmp_path.iterdir()) == before
        fill(target, "old")
    assert (target / "index").read_text() == "old"


def test_what_a_killed_process_left_is_swept_up(tmp_path):
    gone = subprocess.Popen([sys.executable, "-S", "-c", ""])
    gone.wait()
    left, mine = tmp_path / f".world.{gone.pid}.x.part", tmp_path / f".world.{os.getpid()}.x.part"
    other = tmp_path / f".worlds.{gone.pid}.x.part"
    for each in (left, mine, other):
        each.mkdir()
        (each / "index").write_text("half")
    fill(tmp_path / "world", "whole")
    assert {each.name for each in tmp_path.iterdir()} == {"world", mine.name, other.name}


@pytest.mark.skipif(os.name != "posix", reason="files have no such rights there")
def test_others_may_read_it_as_far_as_the_user_allows(tmp_path):
    before = os.umask(0o027)
    try:
        fill(tmp_path / "world", "x")
    finally:
        os.umask(before)
    assert (tmp_path / "world").stat().st_mode & 0o777 == 0o750


def test_what_cannot_be_written_is_told_before(tmp_path):
    (tmp_path / "file").write_text("x")
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "other").write_text("x")
    (tmp_path / "empty").mkdir()
    for path, message in (
        (tmp_path / "no" / "world", "no folder"),
        (tmp_path / "file", "is a file; give a folder"),
        (tmp_path / "full", "holds other files"),
    ):
        with pytest.raises(SurefootError, match=message):
            check_folder_target(path, "index")
    check_folder_target(tmp_path / "empty", "index")
    fill(tmp_path / "empty", "x")
    assert (tmp_path / "empty" / "index").is_file()
