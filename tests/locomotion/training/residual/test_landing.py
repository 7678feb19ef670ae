"""People who learn to land."""

import numpy as np
import pytest

from locomotion.gaits.residual.layout import ACTIONS, LANDED, LANDING_INPUTS
from locomotion.human.landing import LASTS
from locomotion.human.state import MOVING
from locomotion.training.residual.landing import LandingPeople, LandingStage, on_course

STAGE = LandingStage("land", 1, noise=(0.2, 0.1), pushed=1.0, push=900.0, shaken=0.05)


@pytest.fixture(scope="module")
def people():
    return LandingPeople(2, np.random.default_rng(4))


def test_starts_are_landings(people):
    for human, starts in zip(people.people, people.starts, strict=True):
        assert len(starts) >= 4
        for start in starts:
            human.restore_state(start)
            assert human.on_feet.landing.decides and human.status in MOVING
            edges = [each.position[0] for each in human.run_up.obstacles]
            assert min(abs(human.com[0] - edge) for edge in edges) < 8.0


def test_who_is_pushed_hard_falls_and_begins_anew(people):
    people.begin(STAGE, 3)
    fell = 0
    for _ in range(LASTS // 2 + 1):
        outcome = people.step(np.zeros((2, ACTIONS)))
        done = outcome.fell | outcome.over
        assert (outcome.reward[outcome.fell] < -2.0).all()
        assert (outcome.reward[~outcome.fell] > -1.0).all()
        fell += int(outcome.fell.sum())
        people.reset(done)
        assert (people.observe()[done, LANDED] == 1.0 / LASTS).all()
    assert fell
    assert people.observe().shape == (2, LANDING_INPUTS)


def test_the_same_seed_does_the_same(people):
    seen = []
    for _ in range(2):
        people.begin(STAGE, 5)
        people.observe()  # what is decided belongs to the sides that were observed last
        for _ in range(4):
            people.step(np.full((2, ACTIONS), 0.1))
        seen.append(people.observe())
    assert np.array_equal(*seen)


def test_what_is_decided_changes_the_landing(people):
    ends = []
    for decided in (0.0, 0.4):
        people.begin(STAGE, 5)
        for _ in range(8):
            people.step(np.full((2, ACTIONS), decided))
        ends.append(people.observe())
    assert np.abs(ends[0] - ends[1]).max() > 0.1


def test_courses_are_drawn_from_the_generator():
    _, one = on_course(np.random.default_rng(9), None)
    _, other = on_course(np.random.default_rng(9), None)
    assert len(one) == len(other)
    assert all(a.numbers.tobytes() == b.numbers.tobytes() for a, b in zip(one, other, strict=True))
