"""Trials of the drop-roll on slippery ground."""

from runtime.evaluation import slippery
from runtime.evaluation.slippery import slippery_roll_trials


def test_who_rehearses_is_judged_and_who_does_not_compared():
    without, rehearsed = (trial() for trial in slippery_roll_trials(1, 5))
    assert without.compared and not rehearsed.compared
    assert without.what == rehearsed.what and "friction 0.45" in rehearsed.test
    assert rehearsed.held and rehearsed.status == "arrived"


def test_who_does_not_get_there_in_time_does_not_hold(monkeypatch):
    monkeypatch.setattr(slippery, "_LONGEST", 20)
    attempt = slippery_roll_trials(1, 5)[0]()
    assert not attempt.held and attempt.status == "walking"
