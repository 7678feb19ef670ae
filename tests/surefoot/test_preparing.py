"""Kernels are compiled once, by whoever has said that they can."""

import numba
import pytest

from surefoot import preparing
from surefoot.preparing import Preparing, prepare_once, prepare_with


@pytest.fixture
def done(monkeypatch, tmp_path):
    """How often somebody who can was asked to, with a cache in which nothing is kept."""
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(preparing, "_preparers", [])
    return []


def test_whoever_can_is_asked_until_all_kernels_are_kept(done, caplog):
    prepare_once()
    prepare_with(lambda: done.append("nobody"), lambda: False)
    prepare_with(lambda: done.append("all"), lambda: len(done) == 2)
    assert done == [] and not caplog.messages
    for _ in range(3):
        prepare_once()
    assert done == ["all", "all"] and "once on this machine" in caplog.messages[0]


def test_without_a_cache_nobody_is_asked(done, monkeypatch):
    prepare_with(lambda: done.append("in vain"), lambda: False)
    monkeypatch.setattr(preparing, "mark_of_kernels", lambda: None)
    prepare_once()
    assert done == []


def test_nobody_is_asked_while_it_is_going_on(done, monkeypatch):
    prepare_with(lambda: done.append("again"), lambda: False)
    monkeypatch.setattr(Preparing, "going_on", True)
    prepare_once()
    assert done == []
