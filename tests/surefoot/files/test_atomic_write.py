"""Files appear whole or not at all, whatever happens while they are written."""

import os
import subprocess
import sys

import pytest

from surefoot.files.atomic_write import whole_file


def test_a_file_replaces_the_old_one_when_it_is_whole(tmp_path):
    target = tmp_path / "a.npz"
    target.write_text("old")
    with whole_file(target) as temporary:
        assert temporary.parent == tmp_path and temporary.suffix == ".npz" and temporary.name[0] == "."
        temporary.write_text("new")
        assert target.read_text() == "old"
    assert target.read_text() == "new"
    assert list(tmp_path.iterdir()) == [target]


@pytest.mark.parametrize("interruption", [OSError, KeyboardInterrupt, SystemExit])
def test_an_interruption_leaves_the_old_one_and_nothing_beside_it(tmp_path, interruption):
    target = tmp_path / "a.npz"
    target.write_text("old")
    with pytest.raises(interruption), whole_file(target) as temporary:
        temporary.write_text("half")
        raise interruption
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]


@pytest.mark.skipif(os.name != "posix", reason="files have no such rights there")
def test_others_may_read_it_as_far_as_the_user_allows(tmp_path):
    """The temporary file may be read by its user alone."""
    before = os.umask(0o027)
    try:
        with whole_file(tmp_path / "a.txt") as temporary:
            temporary.write_text("x")
    finally:
        os.umask(before)
    assert (tmp_path / "a.txt").stat().st_mode & 0o777 == 0o640


def test_what_a_killed_process_left_is_swept_up(tmp_path):
    gone = subprocess.Popen([sys.executable, "-S", "-c", ""])
    gone.wait()
    left, mine = tmp_path / f".a.npz.{gone.pid}.x.part.npz", tmp_path / f".a.npz.{os.getpid()}.x.part.npz"
    other = tmp_path / f".b.npz.{gone.pid}.x.part.npz"
    for each in (left, mine, other):
        each.write_text("half")
    with whole_file(tmp_path / "a.npz") as temporary:
        temporary.write_text("whole")
    assert {each.name for each in tmp_path.iterdir()} == {"a.npz", mine.name, other.name}


def test_names_with_signs_of_patterns_are_taken_as_they_are(tmp_path):
    """Brackets and stars in a name mean something to whoever looks for what was left."""
    kept = tmp_path / ".ab.npz.999999999.x.part.npz"
    kept.write_text("of another file")
    with whole_file(tmp_path / "a[b*].npz") as temporary:
        temporary.write_text("x")
    assert kept.exists() and (tmp_path / "a[b*].npz").read_text() == "x"
