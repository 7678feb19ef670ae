"""How often a skill holds: what is drawn, pushed and counted."""

from dataclasses import replace

import numpy as np
import pytest

from locomotion.skills.jump.kind import JUMP
from runtime.evaluation import evaluation
from runtime.evaluation.courses import CourseRun
from runtime.evaluation.evaluation import clearing_trials, start_noise


def test_noise_and_pushes_depend_on_seed_and_distance_only():
    for draw in (start_noise, lambda *given: evaluation._push_at(*given).force):
        assert np.array_equal(draw(3, 12.5), draw(3, 12.5))
        assert not np.array_equal(draw(3, 12.5), draw(3, 12.6))
        assert not np.array_equal(draw(3, 12.5), draw(4, 12.5))
    noise = np.array([start_noise(seed, 10.0) for seed in range(200)])
    assert noise.shape == (200, 45) and noise.std() == pytest.approx(0.02, rel=0.05)


def test_a_push_comes_near_the_obstacle_from_any_side():
    pushes = [evaluation._push_at(seed, 20.0) for seed in range(60)]
    assert all(10.0 <= push.at <= 24.0 and push.ticks == 10 for push in pushes)
    assert [np.linalg.norm(push.force) for push in pushes] == pytest.approx([200.0] * 60)
    assert len({tuple(np.sign(push.force)) for push in pushes}) == 4


def test_pushes_of_a_run_come_once_in_each_five_seconds():
    forces = evaluation._pushes(np.random.default_rng(2))
    pushed = np.array([np.linalg.norm(next(forces)) > 0.0 for _ in range(2000)]).reshape(4, 500)
    assert pushed.sum(axis=1).tolist() == [10] * 4
    assert not pushed[:, :250].any()  # the first half of each is for finding its stride again


def test_three_tests_of_as_many_trials_over_the_sizes_of_the_kind(monkeypatch):
    seen = []

    def run(course, clearing, noise, push=None):
        seen.append((course.obstacles[0].size, course.obstacles[0].arc_length, push is not None))
        return CourseRun("fallen")

    monkeypatch.setattr(evaluation, "run_course", run)
    kind = replace(JUMP, sizes=(0.2, 0.5), usual=0.4)
    attempts = [trial() for trial in clearing_trials(kind, 4, 1)]
    assert len(attempts) == len(seen) == 12 and not any(each.held for each in attempts)
    usual, drawn, pushed = seen[:4], seen[4:8], seen[8:]
    assert [size for size, *_ in usual] == [0.4] * 4
    assert [far for _, far, _ in usual] == pytest.approx(np.linspace(30.0, 100.0, 4))
    assert all(0.2 <= size <= 0.5 and 10.0 <= far <= 30.0 for size, far, _ in drawn)
    assert [each[:2] for each in drawn] == [each[:2] for each in pushed]
    assert [push for *_, push in seen] == [False] * 8 + [True] * 4
    assert attempts[0].what == "0.40 m from 30.0 m" and attempts[0].at == {
        "run-up [m]": 30.0,
        "height [m]": 0.4,
    }
