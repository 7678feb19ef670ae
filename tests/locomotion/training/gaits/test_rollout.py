"""One trial of running."""

import numpy as np
import pytest

from locomotion.body.person import MASS
from locomotion.gaits.run.layout import CONTACT, STEP_TIME
from locomotion.gaits.run.skill import load_run_skill
from locomotion.training.gaits.rollout import Scenario, Simulator, Trial
from locomotion.training.gaits.run_genes import first_state_reference, skill_of
from locomotion.training.gaits.run_trials import TrialKind, cost, draw_scenario
from tests.locomotion.training.tiny import tiny_problem


def test_fewer_physics_steps_a_tick_simulate_as_long_a_run() -> None:
    skill, scenario = load_run_skill(), Scenario(2.0, np.array([[0.0, 3.5]]))
    simulators = Simulator(), Simulator(3)
    runs = [simulator.run(skill, scenario) for simulator in simulators]
    assert [simulator.data.time for simulator in simulators] == pytest.approx([2.0, 2.0])
    assert runs[0].figures["speed"] == pytest.approx(runs[1].figures["speed"], abs=0.1)
    assert not np.array_equal(runs[0].state, runs[1].state)


def test_hard_landings_cost_what_the_stage_says() -> None:
    peaks = [0.0]

    def note(simulator: Simulator) -> None:
        if simulator.state[STEP_TIME] == 0.0:
            peaks.append(0.0)
        peaks[-1] = max(peaks[-1], float(simulator.state[CONTACT].sum()) / (MASS * 9.81))

    scenario = Scenario(3.0, np.array([[0.0, 5.0]]), np.array([[0.0, 0.5]]))
    trial = Simulator().run(load_run_skill(), scenario, note)
    hard = np.maximum(np.array(peaks[:-1]) - 2.8, 0.0)  # the last step is not over
    assert trial.figures["landing"] == pytest.approx(np.sqrt((hard**2).mean())) and hard.max() > 0.3
    softly = Trial(trial.figures | {"landing": 0.0}, np.zeros(0))
    more = cost(trial, 3.0, 0.3, soft=2.0) - cost(softly, 3.0, 0.3, soft=2.0)
    assert more == pytest.approx(2.0 * trial.figures["landing"])
    assert cost(trial, 3.0, 0.3) == cost(softly, 3.0, 0.3)


def test_same_trial_same_outcome() -> None:
    skill = skill_of(tiny_problem().start(), first_state_reference())
    scenario = draw_scenario(
        np.random.default_rng(1), TrialKind(1.0, noise=0.5, push=50.0, tilt=0.05, lateral=1.0)
    )
    first, second = (Simulator().run(skill, scenario) for _ in range(2))
    assert first.figures == second.figures
    np.testing.assert_array_equal(first.state, second.state)
