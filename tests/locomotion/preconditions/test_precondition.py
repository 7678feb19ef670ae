"""Preconditions on disk, and what the package's say."""

from dataclasses import replace

import numpy as np
import pytest

from locomotion import LocomotionError
from locomotion.preconditions.changes import BRAKE, CHANGE_FEATURES, CHANGES, SLOW_DOWN, WALK_TO_RUN
from locomotion.preconditions.features import FEATURES, SITE, before_run_up
from locomotion.preconditions.precondition import load_precondition, load_preconditions, precondition_file


def site(size, depth=0.3):
    told = dict.fromkeys(SITE, 0.0) | {"size": size, "depth": depth, "grip": 0.9}
    return np.array(list(told.values()))


def test_a_file_holds_the_whole_precondition(tmp_path):
    first = load_precondition(precondition_file("vault"))
    first.save(tmp_path / "vault.npz")
    again = load_precondition(tmp_path / "vault.npz")
    asked = np.random.default_rng(0).normal(size=(4, len(FEATURES)))
    assert (first.odds(asked) == again.odds(asked)).all()
    before = before_run_up(site(0.8), 12.0)[None]
    assert (first.odds_before(before) == again.odds_before(before)).all()


@pytest.mark.parametrize("change", CHANGES)
def test_changes_are_asked_of_features_of_their_own(tmp_path, change):
    first = load_preconditions()[change]
    first.save(tmp_path / "change.npz")
    again = load_precondition(tmp_path / "change.npz")
    asked = np.random.default_rng(0).normal(size=(4, len(CHANGE_FEATURES)))
    chosen = {WALK_TO_RUN: {0, 1}, SLOW_DOWN: {0}, BRAKE: {0}}.get(change, set())
    assert first.before is None and set(first.run_up.columns[: len(chosen)].tolist()) == chosen
    assert (first.odds(asked) == again.odds(asked)).all()


def test_one_of_another_skill_is_refused(tmp_path):
    replace(load_precondition(precondition_file("jump")), digest="0" * 32).save(tmp_path / "jump.npz")
    with pytest.raises(LocomotionError, match=r"jump or the run under it has changed .*train preconditions"):
        load_precondition(tmp_path / "jump.npz")
    with pytest.raises(LocomotionError, match="no such file"):
        load_precondition(tmp_path / "none.npz")


def test_only_what_was_learned_is_covered():
    known = load_preconditions()["drop"]
    assert [known.covers(size) for size in (0.8, 0.9, 2.0, 2.1)] == [False, True, True, False]


@pytest.mark.parametrize("affordance", ["jump", "vault", "gap"])
def test_what_is_far_beyond_a_skill_is_nearly_hopeless(affordance):
    known = load_preconditions()[affordance]
    low, high = known.heights
    sites = [site(size, size if affordance == "gap" else 0.3) for size in (low, high + (high - low))]
    odds = known.odds_before(np.array([before_run_up(each, 12.0) for each in sites]))
    assert odds[0] > 0.5 and odds[1] < 0.2
