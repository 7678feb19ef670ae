"""Groups of people who learn do the same on any number of processes."""

import multiprocessing
import os
from functools import partial

import numpy as np
import pytest

from locomotion.errors import LocomotionError
from locomotion.training.policies.environment import Outcome
from locomotion.training.policies.groups import Groups


class Walkers:
    """Three numbers that are moved at random, and fall below -1."""

    count, inputs, actions = 3, 2, 1

    def __init__(self, factor: float, number: int) -> None:
        self.factor = factor + number

    def begin(self, stage: float, seed: int) -> None:
        self.rng, self.stage = np.random.default_rng(seed), stage
        self.x = np.zeros(self.count)

    def reset(self, who: np.ndarray) -> None:
        self.x[who] = 0.0

    def observe(self) -> np.ndarray:
        return np.stack([self.x, np.full(self.count, self.factor)], axis=1)

    def step(self, decided: np.ndarray) -> Outcome:
        self.x += self.stage * self.rng.normal(size=self.count) + decided[:, 0]
        fell, nobody = self.x < -1.0, np.zeros(self.count, bool)
        return Outcome(-self.x, fell, nobody, nobody, np.zeros(0), {"x": float(self.x.mean())})


def run(processes: int) -> list[np.ndarray]:
    people = Groups(partial(Walkers, 0.5), 3, processes, 0.4, seed=7)
    assert (people.count, people.inputs, people.actions) == (9, 2, 1)
    seen, rng = [people.observe()], np.random.default_rng(1)
    for k in range(12):
        if k == 6:
            people.begin(0.8)
            seen.append(people.observe())
        outcome = people.step(0.1 * rng.normal(size=(9, 1)))
        assert outcome.terms["x"] == pytest.approx(-outcome.reward.mean())
        assert np.array_equal(people.observe()[:, 0], -outcome.reward)  # before anybody begins anew
        people.reset(outcome.fell | outcome.over)
        seen += [outcome.reward, outcome.fell, people.observe()]
        assert np.array_equal(people.observe()[:, 0] == 0.0, outcome.fell)
    people.end()
    return seen


def test_the_number_of_processes_changes_nothing():
    here, there = run(1), run(2)
    assert any(each.any() for each in here if each.dtype == bool)
    assert all(np.array_equal(a, b) for a, b in zip(here, there, strict=True))


class Doomed(Walkers):
    """The last group's process dies in its first step. They are so many that a pipe does not take their
    answers at once."""

    count = 40_000

    def step(self, decided: np.ndarray) -> Outcome:
        if self.factor > 2.0:
            os._exit(3)
        return super().step(decided)


def refused(number: int) -> Walkers:
    if number == 2:
        raise LocomotionError("group 2 has no ground")
    return Walkers(0.5, number)


def test_a_process_that_dies_is_an_error_and_the_others_end():
    people = Groups(partial(Doomed, 0.5), 3, 2, 0.4, seed=7)
    for _ in range(2):
        with pytest.raises(LocomotionError, match=r"ended by itself \(exit code 3\).* fewer workers"):
            people.step(np.zeros((people.count, 1)))
    people.end()
    assert not multiprocessing.active_children()


def test_what_a_group_refuses_is_told_and_no_process_is_left():
    with pytest.raises(LocomotionError, match="group 2 has no ground"):
        Groups(refused, 3, 2, 0.4, seed=7)
    assert not multiprocessing.active_children()
