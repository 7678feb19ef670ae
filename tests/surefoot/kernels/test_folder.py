"""Where compiled kernels lie, who may write there, and when they go."""

import os
import sys
import time

import numba
import pytest

from surefoot.kernels import folder


@pytest.fixture
def chosen(monkeypatch, tmp_path):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "chosen"))
    return tmp_path / "chosen" / "surefoot"


def test_the_chosen_folder_wins(monkeypatch, tmp_path, chosen):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "caches"))
    assert folder.cache_folder() == chosen
    monkeypatch.setattr(numba.config, "CACHE_DIR", "")
    folder._folder.cache_clear()
    assert folder.cache_folder() == tmp_path / "caches" / "surefoot"
    folder._folder.cache_clear()


@pytest.mark.skipif(sys.platform == "win32", reason="who may write is told elsewhere there")
def test_a_folder_that_others_can_write_to_is_not_used(chosen):
    chosen.mkdir(parents=True)
    chosen.chmod(0o777)
    assert folder.cache_folder() is None


def test_what_has_not_been_used_for_long_is_forgotten(chosen):
    folder.cache_folder()
    old, used, new = (chosen / f"{name}.kernel" for name in ("old", "used", "new"))
    for file, days in ((old, 61), (used, 59), (new, 0)):
        file.write_bytes(b"1234")
        os.utime(file, (time.time() - 86400 * days,) * 2)
    assert folder.note_use(used) and not folder.note_use(used)
    assert time.time() - used.stat().st_mtime < 60.0
    folder.forget_old()
    assert set(chosen.iterdir()) == {used, new}
    assert folder.size_of_cache() == 8
    folder.clear()
    assert folder.size_of_cache() == 0 and not list(chosen.iterdir())
