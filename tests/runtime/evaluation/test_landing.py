"""Trials of landings without rehearsals."""

from runtime.evaluation import landing
from runtime.evaluation.landing import landing_residual_trials


def test_corrected_more_stay_up_than_as_planned():
    attempts = [trial() for trial in landing_residual_trials(2, 13)]
    held = {False: 0, True: 0}
    for each in attempts:
        assert each.status == "stays up" if each.held else each.status.startswith("fallen")
        assert each.compared == ("as planned" in each.test)
        held[not each.compared] += each.held
    assert held[True] > held[False]
    assert len({each.test for each in attempts}) == 16


def test_who_does_not_get_there_in_time_has_not_fallen(monkeypatch):
    monkeypatch.setattr(landing, "_LONGEST", 20)
    attempt = landing_residual_trials(1, 13)[0]()
    assert not attempt.held and attempt.status == "walking before"
