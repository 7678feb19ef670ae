"""Postures that a recorded person is told to take: from one to the next, on the way, and for good."""

import numpy as np
import pytest

from locomotion import LocomotionError
from locomotion.body_events import PostureReached
from locomotion.recorded.skeletons import skeleton
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.posture_orders import PostureOrders
from tests.locomotion.recorded_people.test_people import NATURAL, crowd_of, played, steps


def test_postures_follow_on_each_other_without_a_jump():
    people, (ada,) = crowd_of(1)
    rng = np.random.default_rng(2)
    asked = ["kneel", "prone", "stand", "sit", "crouch", "prone", "stand", "dead"]
    for posture in asked:
        ada.take(posture, *(("rifle", "deployed") if posture in ("kneel", "prone") else ("", "stowed")))
        poses = played(people, ada, float(rng.uniform(0.3, 4.0)))  # some change their mind on the way
        assert steps(poses)[0] < 6.0 and steps(poses)[1] < 0.05
    played(people, ada, 4.0)
    assert ada.posture == "dead" and ada.events[-1].posture == "dead"
    with pytest.raises(LocomotionError, match="no way from 'dead'"):
        ada.go_to([(9.0, 5.0, 0.0)], 1.4, None)


def test_dying_on_the_run_is_no_jump_either():
    people, (ada,) = crowd_of(1)
    ada.go_to([(18.0, 5.0, 0.0)], 3.5, None)
    before = played(people, ada, 2.0)
    ada.take("dead", "", "stowed")
    after = played(people, ada, 2.5)
    np.testing.assert_allclose(after[0], before[-1], atol=1e-9)
    assert steps(after)[0] < NATURAL and steps(after)[1] < 0.08
    assert after[-1, 2] < 0.2 and ada.walker.velocity.max() == 0.0


@pytest.mark.parametrize("speed", [1.3, 3.0])
def test_who_is_told_to_kneel_on_the_way_walks_until_it_stands(speed):
    people, (ada,) = crowd_of(1)
    ada.go_to([(18.0, 5.0, 0.0)], speed, None)
    played(people, ada, 2.0)
    ada.take("kneel", "", "stowed")
    poses = [ada.qpos]
    while np.hypot(*ada.walker.velocity) > 0.1:
        people.tick()
        assert people.rows[0, at.GAIT] >= 0.0 and people.rows[0, at.LAID] > 0.0
        poses.append(ada.qpos)
    knees = [7 + skeleton("full").channels.index(f"{side}_knee_flexion") for side in ("right", "left")]
    assert np.ptp(np.array(poses)[:, knees], axis=0).max() > 0.5
    poses = np.concatenate([poses, played(people, ada, 4.0)[1:]])
    assert steps(poses)[0] < NATURAL and ada.events[-1].posture == "kneel"
    assert people.rows[0, at.GAIT] == -1.0


def test_what_it_holds_it_holds_on_the_way_and_who_kneels_first_gets_up():
    people, (ada,) = crowd_of(1)
    ada.take("kneel", "rifle", "in use")
    played(people, ada, 6.0)
    assert ada.held == ("rifle", "in use")
    ada.go_to([(9.0, 5.0, 0.0)], 1.4, None)
    assert ada.status == "walking" and ada.walker.status == "standing"
    played(people, ada, 3.0)
    assert ada.walker.status == "walking" and ada.held == ("rifle", "in use")
    elbow = 7 + skeleton("full").channels.index("right_elbow_flexion")
    assert np.degrees(ada.qpos[elbow]) == pytest.approx(122, abs=1)
    reached = [event for event in ada.events if isinstance(event, PostureReached)]
    assert [(event.posture, event.held) for event in reached] == [
        ("kneel", "rifle in use"),
        ("stand", "rifle in use"),
    ]


def test_to_where_no_way_leads_nobody_is_sent():
    people, (ada,) = crowd_of(1)
    ada.take("dead", "", "stowed")
    played(people, ada, 3.0)
    before = ada.state_hash()
    for told in ("stand", "kneel"):
        with pytest.raises(LocomotionError, match=f"no way from 'dead' to '{told}'"):
            PostureOrders(ada, people).check_way(told)
        with pytest.raises(LocomotionError, match=f"no way from 'dead' to '{told}'"):
            ada.take(told, "", "stowed")
    assert ada.state_hash() == before
