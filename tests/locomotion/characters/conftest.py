"""Characters made of capsules, and what a person does, shared by these tests."""

import pytest

from examples.make_characters import CHARACTERS, write_character
from locomotion import Rig


@pytest.fixture(scope="session")
def files(tmp_path_factory):
    """The files of the characters of `examples/make_characters.py`, by name."""
    folder = tmp_path_factory.mktemp("characters")
    for who in CHARACTERS:
        write_character(who, folder / f"{who.name}.glb")
    return {who.name: folder / f"{who.name}.glb" for who in CHARACTERS}


@pytest.fixture(scope="session")
def rigs(files):
    return {name: Rig.load(file) for name, file in files.items()}
