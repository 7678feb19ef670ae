"""A command cannot write over what it has read; a program that uses the library may."""

import os

import pytest

from surefoot import SurefootError
from surefoot.files.archive import check_target, write_archive
from surefoot.files.atomic_write import whole_file
from surefoot.files.inputs import keep_inputs, note_input, refuse_input


@pytest.fixture
def read(tmp_path):
    file = tmp_path / "level.obj"
    file.write_text("v 0 0 0\n")
    return file


def test_a_program_may_save_what_it_has_loaded(read):
    note_input(read)
    refuse_input(read)
    check_target(read)


def test_a_command_may_not(read):
    with keep_inputs():
        refuse_input(read)
        note_input(read)
        with pytest.raises(SurefootError, match=r"level\.obj: is an input of this command; choose another"):
            refuse_input(read)
        with pytest.raises(SurefootError, match="an input"):
            check_target(read)
        with pytest.raises(SurefootError, match="an input"), whole_file(read):
            raise AssertionError("nothing is to be written")
        with pytest.raises(SurefootError, match="an input"):
            write_archive(read, "test", 1, {}, {})
    refuse_input(read)
    assert read.read_text() == "v 0 0 0\n"


def test_other_names_of_an_input_are_told_with_the_first(read):
    hard, soft = read.parent / "hard.obj", read.parent / "soft.obj"
    os.link(read, hard)
    soft.symlink_to(read)
    with keep_inputs([read]):
        for other in (hard, soft):
            with pytest.raises(SurefootError, match=r"obj: is the same file as .*level\.obj, an input"):
                refuse_input(other)


def test_inputs_of_a_command_within_a_command_are_its_own(read):
    """As when a playtest is replayed by a command that has inputs."""
    with keep_inputs([read]):
        with keep_inputs():
            refuse_input(read)
        with pytest.raises(SurefootError):
            refuse_input(read)


def test_files_that_do_not_exist_are_left_to_their_readers(read):
    with keep_inputs([read.parent / "nowhere.obj"]):
        refuse_input(read.parent / "nowhere.obj")
        refuse_input(read)
