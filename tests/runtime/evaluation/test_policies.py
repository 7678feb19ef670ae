"""Trials of the learned walk."""

from runtime.evaluation.policies import walk_policy_trials


def test_each_test_is_tried():
    attempts = [trial() for trial in walk_policy_trials(1, 3)]
    names = ["walk", "pushed with 300 N", "start, stop, turn"]
    names += ["run", "run, pushed with 300 N", "run, walk, stop, turn", "the same, anybody"]
    assert [each.test for each in attempts] == names
    assert all(each.status == ("walks" if each.held else "fallen") for each in attempts)
    assert attempts[0].held
    assert attempts[3].held
