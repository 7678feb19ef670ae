"""Trials of the learned walk."""

from runtime.evaluation.policies import evaluate_walk_policy
from surefoot.progress import Progress


def test_each_test_is_tried():
    attempts = evaluate_walk_policy(1, 3, Progress(shown=False))
    assert [each.test for each in attempts] == ["walk", "pushed with 300 N", "start, stop, turn"]
    assert all(each.status == ("walks" if each.held else "fallen") for each in attempts)
    assert attempts[0].held
