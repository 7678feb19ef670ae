"""The network that corrects braking: when it acts, and that its memory is saved."""

import numpy as np

from locomotion.gaits.residual.layout import DECIDED, SINCE
from locomotion.human.human import BetweenGaits, Human
from tests.locomotion.gaits.runners import WAY, running


def test_it_acts_only_while_the_person_brakes():
    human = running(300, rehearsals=0)
    memory = human.on_feet.residual.memory
    assert not memory.any()
    human.stop()
    human.brake(2.5)
    for _ in range(10):
        human.tick()
    assert memory[SINCE] == 10.0 and memory[DECIDED].any()
    for _ in range(500):
        human.tick()
    assert human.status == "standing" and human.held and not human.on_feet.brakes
    here = human.position
    human.follow(here + np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0]]), 1.0)
    for _ in range(100):
        human.tick()
    assert human.status == "walking" and not memory.any()


def test_a_person_restored_while_it_brakes_goes_on_bit_for_bit():
    human = running(300, rehearsals=0)
    human.stop()
    human.brake(2.5)
    for _ in range(13):
        human.tick()
    other = Human(None, clearing=(), rehearsals=0)
    other.restore_state(human.save_state())
    for _ in range(60):
        human.tick()
        other.tick()
    assert np.array_equal(human.data.qpos, other.data.qpos)


def test_without_a_network_it_brakes_as_planned():
    human = Human(None, clearing=(), rehearsals=0, between=BetweenGaits(residual=None))
    human.reset(WAY[0], 0.0, 3.0)
    human.brake(1.0)
    for _ in range(5):
        human.tick()
    assert human.on_feet.brakes and not human.on_feet.residual.memory[DECIDED].any()


def test_whoever_is_put_elsewhere_forgets():
    human = running(300, rehearsals=0)
    human.stop()
    human.brake(2.5)
    human.tick()
    human.reset(WAY[0], 0.0)
    assert not human.on_feet.residual.memory.any()


def test_whoever_falls_while_it_brakes_gets_up_without_it():
    human = Human(None, clearing=(), rehearsals=0, gets_up=True)
    human.reset(WAY[0], 0.0, 3.0)
    human.follow(WAY, 3.0)
    for _ in range(100):
        human.tick()
    human.stop()
    human.brake(2.5)
    for _ in range(200):
        human.data.xfrc_applied[human.index.chest, :2] = 0.0, 700.0
        human.tick()
        if human.status == "getting up":
            break
    assert human.status == "getting up"
    assert not human.on_feet.brakes and not human.on_feet.residual.memory.any()
