"""Trials of following a path."""

from dataclasses import replace

import numpy as np
import pytest

from locomotion import Human
from locomotion.training.gaits.path_trial import draw_path, draw_turns, follow_path
from locomotion.training.gaits.walk import KINDS as WALKS


def test_learning_counts_only_those_who_come_to_rest_at_their_goal(monkeypatch):
    way = draw_path(np.random.default_rng(1), **WALKS["level"])
    assert follow_path(way).figures["time"] == way.duration
    monkeypatch.setattr(Human, "held", False)
    assert follow_path(way).figures["time"] == pytest.approx(0.99 * way.duration)


def test_trials_of_sudden_turns_tell_it_elsewhere_until_their_end():
    trial = draw_turns(np.random.default_rng(2), (1.0, 1.0))
    times, angles = trial.turns.T
    assert (np.diff(times) > 0.0).all() and (np.abs(angles) <= 1.0).all() and times[-1] == trial.duration
    figures = follow_path(trial).figures
    straight = follow_path(replace(trial, turns=np.array([[trial.duration, 0.0]]))).figures
    assert figures["time"] == straight["time"] == trial.duration
    assert figures["speed"] < straight["speed"] - 0.05  # it slows down for turns
