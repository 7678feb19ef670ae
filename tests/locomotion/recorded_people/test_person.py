"""What one recorded person can be asked for."""

import numpy as np
import pytest

from locomotion import LocomotionError
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.nodes import can_hold, checked_node
from locomotion.recorded_people.people import person_postures
from tests.locomotion.recorded_people.test_people import crowd_of, played, steps


@pytest.mark.parametrize(
    ("asked", "says"),
    [
        (("fly", "", "stowed"), "posture 'fly': valid: stand, crouch"),
        (("stand", "spear", "in use"), "object 'spear': valid: rifle"),
        (("stand", "rifle", "broken"), "valid: stowed, deployed, in use"),
        (
            ("crouch", "rifle", "in use"),
            "in the posture 'crouch' a rifle cannot be in use; valid: stand, kneel",
        ),
    ],
)
def test_what_there_is_not_is_said(asked, says):
    with pytest.raises(LocomotionError, match=says):
        checked_node(person_postures(), *asked)


def test_what_cannot_be_held_in_a_posture_is_stowed():
    graph = person_postures()
    assert can_hold(graph, "kneel", ("rifle", "in use")) == ("rifle", "in use")
    assert can_hold(graph, "all-fours", ("rifle", "in use")) == ("", "stowed")


@pytest.mark.parametrize("speed", [0.0, 1.3, 3.2])
def test_it_goes_on_from_a_body_in_motion_in_step_with_it(speed):
    people, (ada, bob) = crowd_of(2)
    ada.go_to([(18.0, 5.0, 0.0)], max(speed, 0.1), None)
    if speed == 0.0:
        ada.stop()
    poses = played(people, ada, 2.6)
    pose, pose_rates = ada.qpos, ada.qpos_rates
    bob.walker.crowd.rows[bob.index, :7] = ada.walker.crowd.rows[ada.index, :7]
    bob.go_on_from(pose, pose_rates, ada.position, ada.walker.velocity)
    np.testing.assert_allclose(bob.qpos, pose, atol=1e-6)
    phases = people.rows[:, at.PHASE]
    assert speed == 0.0 or abs((phases[0] - phases[1] + 0.5) % 1.0 - 0.5) < 0.05
    assert steps(poses)[1] < 0.08
