"""Pushes: who stands wakes, gives way and stands again; a push ends by itself, and is saved with the rest."""

import math

import numpy as np
import pytest

from locomotion import Human, LocomotionError
from locomotion.gaits.policy.skill import load_policy
from locomotion.human.sized_human import SizedHuman


def standing(policy: bool = True) -> Human:
    human = Human(rehearsals=0, policy=load_policy() if policy else None)
    human.reset((0.0, 0.0, 0.0), 0.4)
    human.tick()
    assert human.held
    return human


def go(human: Human, ticks: int) -> np.ndarray:
    way = []
    for _ in range(ticks):
        human.tick()
        way.append(human.com[:2].copy())
    return np.array(way)


@pytest.mark.parametrize("policy", [True, False])
@pytest.mark.parametrize("side", [0.0, 1.7, 3.0, 4.4])
def test_who_stands_gives_way_and_stands_again(policy, side):
    human = standing(policy)
    before = human.com[:2].copy()
    human.push(200.0 * np.array([math.cos(side), math.sin(side), 0.0]))
    assert not human.held
    way = go(human, 600) - before
    assert human.held and human.status == "standing"
    along = way @ [math.cos(side), math.sin(side)]
    assert 0.1 < along.max() < 1.2


@pytest.mark.parametrize("side", range(6))
def test_who_is_pushed_hard_catches_itself_in_learned_steps(side):
    human = standing()
    angle = 0.4 + math.pi / 3.0 * side
    human.push(300.0 * np.array([math.cos(angle), math.sin(angle), 0.0]))
    learned = [human.on_feet.walks_as_learned]
    for _ in range(600):
        human.tick()
        learned.append(human.on_feet.walks_as_learned)
    assert human.status == "standing"
    ahead = math.cos(math.pi / 3.0 * side)
    if abs(ahead) > 0.6:  # backwards it steps as planned, which holds more often
        assert all(learned) == (ahead > 0.0)


def test_a_gentle_push_moves_nobody_off_its_feet():
    human = standing()
    feet = human.observed.copy()
    human.push((40.0, 0.0, 0.0), 0.2)
    way = go(human, 300)
    assert 0.002 < np.ptp(way, axis=0).max() < 0.1 and human.held
    assert human.on_feet.walks_as_learned and len(feet) == len(human.observed)


def test_a_push_lasts_as_long_as_it_is_told_to():
    human = standing()
    waist = human.index.bodies["waist"]
    human.push((0.0, 30.0, 0.0), 0.05)
    forces = []
    for _ in range(8):
        forces.append(float(human.data.xfrc_applied[waist, 1]))
        human.tick()
    assert forces == [30.0] * 5 + [0.0] * 3
    human.push((0.0, 30.0, 0.0), 1.0)
    human.push((10.0, 0.0, 0.0), 0.02)
    go(human, 2)
    assert not human.data.xfrc_applied.any()


def test_a_pushed_person_goes_on_from_a_saved_state_as_it_did():
    one, other = standing(), standing()
    one.push((150.0, 100.0, 0.0), 0.2)
    go(one, 7)
    other.restore_state(one.save_state())
    go(one, 120), go(other, 120)
    assert one.state_hash() == other.state_hash()
    assert not other.data.xfrc_applied.any()


def test_a_body_that_lies_is_moved():
    human = standing()
    human.push((0.0, 900.0, 0.0), 0.3)
    go(human, 500)
    assert human.status == "fallen" and human.held
    before = human.com[:2].copy()
    human.push((0.0, 400.0, 0.0), 0.3)
    go(human, 100)
    assert human.com[1] - before[1] > 0.05


def test_what_weighs_less_is_moved_more():
    moved = []
    for size in (0.9, 1.1):
        body = SizedHuman(Human(rehearsals=0), size)
        body.reset(np.zeros(3), 0.0)
        body.push(np.array([60.0, 0.0, 0.0]), 0.1)
        for _ in range(12):
            body.tick(since_foresees=False)
        moved.append(body.velocity[0])
    assert moved[0] > 1.4 * moved[1] > 0.0


@pytest.mark.parametrize(
    ("force", "seconds", "says"),
    [((1.0, 2.0), 0.1, "three finite numbers"), ((1.0, 2.0, np.nan), 0.1, "three finite"),
     ("hard", 0.1, "three finite"),
     ((1.0, 0.0, 0.0), 0.0, "0.01 s or more"), ((1.0, 0.0, 0.0), "long", "0.01 s or more")],
)  # fmt: skip
def test_what_is_no_push_is_refused(force, seconds, says):
    human = standing()
    state = human.state_hash()
    with pytest.raises(LocomotionError, match=says):
        human.push(force, seconds)
    assert human.state_hash() == state and human.held
