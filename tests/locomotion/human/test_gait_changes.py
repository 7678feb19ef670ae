"""When a person changes its gait, and what it does where no rehearsal goes well."""

import numpy as np
import pytest

from locomotion.gaits.brake import BRAKING
from locomotion.rehearsal.trials import ComesToRest
from tests.locomotion.gaits.runners import running


def test_one_whose_braking_does_not_go_well_runs_on_for_a_moment_and_slows_down(monkeypatch):
    def falls(self, body):
        yield
        return 0.0, []

    monkeypatch.setattr(ComesToRest, "__call__", falls)
    human = running(300)
    human.stop()
    gaits = []
    for _ in range(60):
        human.tick()
        gaits.append(human.gait_now)
    assert gaits[0] == "run" and gaits[-1] == "slow run" and not human.on_feet.brakes
    assert 35 <= gaits.count("run") <= 45


def test_one_that_has_to_wait_for_others_brakes():
    human = running(300)
    human.give_way(0.0, None)
    human.tick()
    assert human.on_feet.brakes and human.on_feet.slowing > 2.0
    assert human.prospect().braking == BRAKING
    for _ in range(350):
        human.tick()
    assert human.status == "walking" and np.linalg.norm(human.velocity[:2]) < 0.1
    human.give_way(1.0, None)
    while human.gait_now != "run":
        assert human.status == "walking" and human.time < 20.0
        human.tick()
    assert not human.on_feet.brakes


@pytest.mark.parametrize("ticks", [20, 40, 60])
def test_told_to_go_on_while_it_brakes_it_comes_to_a_stand_first(ticks):
    human, least = running(300), np.inf
    human.give_way(0.0, None)
    for _ in range(ticks):
        human.tick()
    assert human.on_feet.brakes
    human.give_way(1.0, None)
    while human.gait_now != "run" or human.on_feet.slowing > 0.0:
        assert human.status in ("running", "walking") and human.time < 20.0
        human.tick()
        least = min(least, float(np.linalg.norm(human.velocity[:2])))
    assert least < 0.25
