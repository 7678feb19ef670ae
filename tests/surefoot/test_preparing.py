"""Kernels are compiled once, by whoever has said that they can."""

import numba
import pytest

from surefoot import preparing
from surefoot.preparing import Preparing, mark_of_kernels, prepare_once, prepare_with


@pytest.fixture
def done(monkeypatch, tmp_path):
    """How often somebody who can was asked to, with a cache in which nothing is kept."""
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(preparing, "_preparers", [])
    return []


def test_whoever_can_is_asked_until_all_kernels_are_kept(done, caplog):
    prepare_once()
    prepare_with(lambda: done.append("nobody"))
    prepare_with(lambda: done.append("all"))
    assert done == [] and not caplog.messages
    prepare_once()
    prepare_once()
    assert done == ["all", "all"] and "once on this machine" in caplog.messages[0]
    mark_of_kernels().touch()
    prepare_once()
    assert len(done) == 2


def test_nobody_is_asked_while_it_is_going_on(done, monkeypatch):
    prepare_with(lambda: done.append("again"))
    monkeypatch.setattr(Preparing, "going_on", True)
    prepare_once()
    assert done == []
