"""Recorded people on their way over obstacles: interrupted, in turn, saved."""

from dataclasses import replace

import numpy as np
import pytest

from locomotion import LocomotionError
from locomotion.recorded.skeletons import LOW
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.saved_state_check import check_recorded
from tests.locomotion.recorded_people.test_clearing import EDGE, THICK, over


def test_one_who_changes_its_mind_on_the_way_first_lands():
    people, ada = over("vault", 0.8)
    while people.rows[0, at.CROSSES] != at.CLEARS:
        people.tick()
    ada.go_to([(9.0, 2.0, 0.0)], 1.4, None)
    ada.take("kneel", "", "stowed")
    for _ in range(400):
        people.tick()
    assert ada.posture == "kneel" and ada.position[0] > EDGE + THICK and ada.crossing is None


def test_two_take_turns():
    people, ada = over("vault", 0.8)
    bob = people.add((1.0, 0.7, 0.0), 0.0, LOW, np.random.default_rng(4))
    bob.go_to([(9.0, 0.0, 0.0)], 1.4, None)
    both = 0
    for _ in range(1500):
        people.tick()
        both += int((people.rows[:, at.CROSSES] == at.CLEARS).sum() == 2)
    assert ada.status == bob.status == "arrived" and both == 0


def test_a_person_saved_over_an_obstacle_goes_on_the_same_way():
    people, ada = over("jump", 0.5)
    for crosses in (at.APPROACHES, at.RUNS_UP, at.CLEARS):
        while people.rows[0, at.CROSSES] != crosses:
            people.tick()
        for _ in range(7):
            people.tick()
        saved = ada.save()
        check_recorded(saved, people.graph, len(people.gaits), people.skills)
        ends = set()
        for _ in range(2):
            for _ in range(40):
                people.tick()
            ends.add((ada.state_hash(), ada.qpos.tobytes()))
            ada.restore(saved)
        assert len(ends) == 1
    for wrong in (
        replace(saved, crossing=None),
        replace(saved, crossing=replace(saved.crossing, size=float("nan"))),
        replace(saved, crossing=replace(saved.crossing, affordance="fly")),
        replace(saved, crossing=replace(saved.crossing, begun=float("nan"))),
    ):
        with pytest.raises(LocomotionError):
            check_recorded(wrong, people.graph, len(people.gaits), people.skills)
