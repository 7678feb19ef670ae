"""The learned walk that ships, on the whole figure: it stands, walks like people, takes a push and stops."""

import numpy as np
import pytest

from benchmarks.gait_measures import SAMPLES, compare_curves, figures
from benchmarks.gait_record import learned_walk
from benchmarks.human_walk import human_cadence, human_curves
from locomotion.gaits.policy.layout import HEADING, RUNNING
from locomotion.gaits.policy.skill import load_policy
from locomotion.training.policies.trial import PolicyTrial


def test_it_walks_as_people_do():
    record = learned_walk(load_policy(), 1.25, 6.0)
    assert not record.fell
    found = figures(record)
    assert found["speed"] == pytest.approx(1.25, rel=0.1)
    assert found["cadence"] == pytest.approx(human_cadence(1.25), rel=0.1)
    assert 70.0 < found["step width"] < 165.0, "people: 80 to 150"
    assert 25.0 < found["rise"] < 55.0
    assert found["knee at midstance"] < 20.0
    assert found["heel first"] >= 95.0
    for off, alike in compare_curves(record, human_curves(SAMPLES)).values():
        assert off < 12.0
        assert alike > 0.85


@pytest.mark.parametrize("speed", [1.7, 2.0])
def test_it_walks_fast_with_as_many_steps_as_people(speed):
    record = learned_walk(load_policy(), speed, 8.0)
    assert not record.fell
    found = figures(record)
    assert found["speed"] == pytest.approx(speed, rel=0.07)
    assert found["cadence"] == pytest.approx(human_cadence(speed), rel=0.1)


def test_it_stands_sets_off_turns_and_takes_a_push():
    trial = PolicyTrial(load_policy())
    place = trial.place()
    assert trial.go(6.0)
    assert trial.memory[RUNNING] == 0.0
    assert np.linalg.norm(trial.place() - place) < 0.1
    trial.asked[:] = 1.25, 0.4
    assert trial.go(4.0)
    assert trial.memory[HEADING] == pytest.approx(0.4 * 4.0, abs=0.4)
    trial.push(200.0, 1.0)
    assert trial.go(4.0)


def test_the_same_again_to_the_bit():
    ends = []
    for _ in range(2):
        trial = PolicyTrial(load_policy())
        trial.asked[0] = 0.9
        trial.go(3.0)
        ends.append(trial.data.qpos.copy())
    np.testing.assert_array_equal(*ends)
