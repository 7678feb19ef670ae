"""When a path ends: arrived, lost or stuck."""

from types import SimpleNamespace

import numpy as np
import pytest

from locomotion.body_events import Arrived, GotStuck, MissedGoal, StrayedFromPath
from locomotion.gaits.run.layout import COM, new_state
from locomotion.human.arrived_or_stuck import STUCK_TIME, notice
from locomotion.human.on_feet import RUN_GAINS
from locomotion.paths.follower import PathFollower
from locomotion.paths.tracking import TrackingLimits, make_path

WALK = TrackingLimits((0.3, 1.25))


class Somebody:
    """A person of whom only its progress is known, at (x, y) on a path of 10 m along x."""

    def __init__(self, x, y=0.0, status="walking", speed=0.5, tick=100, on_fours=False):
        self.follower, self.control = PathFollower(), new_state()
        self.status, self.ticks, self.events = status, tick, []
        self.velocity = np.array([speed, 0.0, 0.0])
        self.fours, self.on_feet = SimpleNamespace(active=on_fours), SimpleNamespace(runs=status == "running")
        self.follower.begin(make_path([[0, 0, 0], [10, 0, 0]], 1.25, WALK, 1.25), 0)
        self.come_to(x, y)

    def come_to(self, x, y=0.0):
        for at in np.arange(self.follower.arc, x + 0.05, 0.1):
            self.follower.track(RUN_GAINS, float(at), y, 1.25, self.ticks, np.zeros(4))
        self.follower.track(RUN_GAINS, x, y, 1.25, self.ticks, np.zeros(4))
        self.control[COM] = x, y, 0.9

    @property
    def time(self):
        return 0.01 * self.ticks

    @property
    def point(self):
        return tuple(self.control[COM] * [1, 1, 0])

    def end(self, status, event):
        self.status = status
        self.events.append(event)


def noticed(body):
    notice(body)
    return body.status, [type(event) for event in body.events]


def test_one_that_walks_has_arrived_at_the_end_of_its_path():
    assert noticed(Somebody(9.8)) == ("walking", [])
    body = Somebody(9.9, 0.2)
    assert noticed(body) == ("arrived", [Arrived])
    assert body.events[0].distance == pytest.approx(np.hypot(0.1, 0.2)) and body.events[0].time == 1.0


@pytest.mark.parametrize("status", ["running", "jumping"])
def test_one_that_runs_past_its_goal_has_not_arrived_yet(status):
    assert noticed(Somebody(9.95, status=status)) == (status, [])


def test_one_that_is_too_fast_to_stay_goes_on_until_it_is_slow():
    body = Somebody(9.95, speed=1.1)
    assert noticed(body) == ("walking", [])
    body.velocity[0] = 0.9
    assert noticed(body) == ("arrived", [Arrived])


def test_one_that_ends_beside_its_goal_has_missed_it():
    body = Somebody(10.0, 0.7)
    assert noticed(body) == ("lost", [MissedGoal])
    assert body.events[0].distance == pytest.approx(0.7)
    assert noticed(Somebody(10.0, 0.7, status="scrambling")) == ("scrambling", [])


@pytest.mark.parametrize(
    ("changes", "most"), [({"status": "running"}, 2.0), ({}, 3.5), ({"on_fours": True}, 6.0)]
)
def test_how_far_it_may_stray_depends_on_how_it_moves(changes, most):
    assert noticed(Somebody(5.0, most - 0.1, **changes))[1] == []
    body = Somebody(5.0, -most - 0.1, **changes)
    assert noticed(body) == ("lost", [StrayedFromPath])
    assert body.events[0].distance == pytest.approx(most + 0.1)


def test_one_without_headway_is_stuck_unless_it_gives_way():
    body = Somebody(5.0)
    body.ticks += round(100 * STUCK_TIME)
    assert noticed(body) == ("walking", [])
    body.follower.pace = 0.0
    for _ in range(200):
        notice(body)  # waiting for others
        body.ticks += 1
    body.follower.pace = 1.0
    assert noticed(body) == ("walking", [])
    body.ticks += 1
    assert noticed(body) == ("stuck", [GotStuck])


def test_one_that_has_gone_back_turns_round():
    body = Somebody(8.0)
    body.follower.go_back(3.0, WALK, body.ticks)
    body.follower.track(RUN_GAINS, 3.1, 0.0, 1.0, body.ticks, np.zeros(4))
    for x in np.arange(8.0, 3.0, -0.1):
        body.follower.track(RUN_GAINS, float(x), 0.0, 1.0, body.ticks, np.zeros(4))
    assert noticed(body) == ("walking", [])
    assert body.follower.interrupted is None and body.follower.arc == pytest.approx(3.0)
