"""One `except SurefootError` catches whatever is wrong with a caller's input."""

from importlib import import_module

import pytest

from surefoot.errors import SurefootError
from surefoot.files.archive import ArchiveError
from surefoot.files.yamlfile import FileError


@pytest.mark.parametrize("package", ["navmesh", "pathsmooth", "locomotion", "runtime", "surefoot"])
def test_all_public_errors_derive_from_one(package):
    module = import_module(package)
    public = [getattr(module, name) for name in module.__all__]
    errors = [each for each in public if isinstance(each, type) and issubclass(each, Exception)]
    assert errors and all(issubclass(each, SurefootError) for each in errors)


def test_it_is_a_value_error_and_so_are_those_of_files():
    assert all(issubclass(each, SurefootError) for each in (ArchiveError, FileError))
    assert issubclass(SurefootError, ValueError)
