"""Trials that begin in a walk."""

import numpy as np
import pytest

from locomotion.gaits.run.layout import COM_VELOCITY, SPEED
from locomotion.gaits.run.skill import load_run_skill
from locomotion.training.gaits.rollout import Simulator, stays_up
from locomotion.training.gaits.run_trials import TrialKind, draw_scenario


def test_trials_of_setting_off_begin_in_a_walk_from_which_people_run() -> None:
    scenario = draw_scenario(np.random.default_rng(2), TrialKind(3.0, speeds=(3.2, 3.2), walking=1.0))
    simulator, skill = Simulator(), load_run_skill()
    simulator.start(skill, scenario)
    walked, (pace, *_) = simulator.state[SPEED], simulator.state[COM_VELOCITY]
    assert 1.0 < walked < 1.5 and pace == pytest.approx(walked, abs=0.1)
    assert stays_up(simulator.run(skill, scenario), scenario.duration)
    assert simulator.state[COM_VELOCITY][0] > 2.5
