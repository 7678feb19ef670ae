"""Trials of braking without rehearsals."""

from runtime.evaluation.braking import brake_residual_trials


def test_corrected_more_come_to_a_stand_than_as_planned():
    attempts = [trial() for trial in brake_residual_trials(5, 11)]
    held = {each.test: 0 for each in attempts}
    for each in attempts:
        assert each.status == ("stands" if each.held else "fallen")
        held[each.test] += each.held
    assert [*held] == [
        "as planned", "as planned, pushed with 200 N", "corrected", "corrected, pushed with 200 N"
    ]  # fmt: skip
    assert held["corrected"] >= 4
    assert sum(list(held.values())[2:]) > sum(list(held.values())[:2])


def test_only_the_correction_has_to_hold():
    compared = {trial().test: trial().compared for trial in brake_residual_trials(1, 12)}
    assert [*compared.values()] == [True, True, False, False]
