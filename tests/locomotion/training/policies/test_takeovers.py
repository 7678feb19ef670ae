"""States of planned walks and runs from which the learned ones take over."""

import numpy as np
import pytest

from locomotion.gaits.policy import law
from locomotion.gaits.policy import layout as at
from locomotion.training.policies import takeovers as takeovers_module
from locomotion.training.policies.curriculum import Stage
from locomotion.training.policies.environment import Environment
from locomotion.training.policies.takeovers import out_of_runs, takeovers


@pytest.fixture(scope="module")
def found():
    return takeovers(40, 5)


def test_a_foot_has_just_come_down_and_the_body_walks_where_it_faces(found):
    memory = found.memory
    assert set(memory[:, at.PHASE]) == {0.0, 0.5}
    assert (memory[:, at.RUNNING] == 1.0).all()
    qpos, qvel = found.physics[:, 1:8], found.physics[:, -30:]
    _, yaw = law.up_and_yaw(qpos)
    off = np.abs(law.wrap(yaw - memory[:, at.HEADING]))
    assert np.median(off) < 0.1
    ahead = law.along(memory[:, at.HEADING], qvel[:, :3])[:, 0]
    walks = memory[:, at.SPEED] > 0.5
    np.testing.assert_allclose(memory[walks, at.SPEED], ahead[walks])
    soles = found.sensed[:, at.SOLES].reshape(-1, 2, 3, 3)
    right = memory[:, at.PHASE] == 0.0
    lands = np.where(right[:, None], soles[:, 0, :, 2], soles[:, 1, :, 2])
    assert lands.min(axis=1).max() < 0.02


def test_runs_have_just_put_a_foot_down(monkeypatch):
    monkeypatch.setattr(takeovers_module, "_RUNS", 10)
    found = out_of_runs(60, 5)
    memory, qvel = found.memory, found.physics[:, -30:]
    assert set(memory[:, at.PHASE]) == {0.0, 0.5}
    assert (memory[:, [at.RUNNING, at.FAST]] == 1.0).all()
    ahead = law.along(memory[:, at.HEADING], qvel[:, :3])[:, 0]
    np.testing.assert_allclose(memory[:, at.SPEED], ahead)
    assert ahead.min() > 1.5
    assert np.ptp(ahead) > 1.5
    right = memory[:, at.PHASE] == 0.0
    soles = found.sensed[:, at.SOLES].reshape(-1, 2, 3, 3)
    lands = np.where(right[:, None], soles[:, 0, :, 2], soles[:, 1, :, 2])
    assert lands.min(axis=1).max() < 0.03
    again, other = out_of_runs(15, 5), out_of_runs(15, 6)
    np.testing.assert_array_equal(again.physics, found.physics[:15])
    assert not np.array_equal(other.physics, again.physics)


def test_they_are_others_for_another_seed(found):
    again, other = takeovers(40, 5), takeovers(40, 6)
    np.testing.assert_array_equal(again.physics, found.physics)
    assert not np.array_equal(other.physics, found.physics)


def test_people_of_an_environment_go_on_from_there(found, reference):
    stage = Stage("on", 1, (0.5, 1.5), from_starts=1.0)
    people = Environment(reference, stage, 30, 1, starts=found)
    feet = people.soles.reshape(30, 2, 3, 3)[:, :, :2].mean(axis=2)
    people.step(np.zeros((30, at.ACTIONS)))
    moved = people.soles.reshape(30, 2, 3, 3)[:, :, :2].mean(axis=2) - feet
    assert np.linalg.norm(moved, axis=2).max() < 0.15, "feet are where they were"
