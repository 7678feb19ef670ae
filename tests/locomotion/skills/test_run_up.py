"""Running up to obstacles and clearing them."""

import numpy as np
import pytest

from locomotion.body.hand_hold import holding
from locomotion.body_events import Arrived, Cleared, SetOff, TookOff
from locomotion.gaits.run.skill import load_run_skill
from locomotion.human.human import Human
from locomotion.human.state import MOVING
from locomotion.paths.follower import PathFollower
from locomotion.paths.gait_plan import RUN_UP, SET_OFF
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.paths.tracking import TrackingLimits, make_path
from locomotion.skills.run_up import RunUp
from locomotion.skills.run_up_layout import FARTHER, FASTER
from tests.locomotion.human.people import Recorder, finish


def test_run_up_ends_at_the_mark_and_the_skill_starts():
    skill = Recorder()
    human = Human(None, clearing=[skill], rehearsals=0)
    human.reset((0, 0, 0), 0.0)
    obstacle = ObstacleAhead(14.0, "jump", 0.4, np.array([14.0, 0, 0.4]), np.array([-1.0, 0, 0]))
    human.follow([[0, 0, 0], [25, 0, 0]], 3.0, [obstacle])
    finish(human)
    assert human.status == "arrived"
    kinds = [type(e) for e in human.events]
    assert kinds == [SetOff, TookOff, Cleared, Arrived]
    assert skill.distances == [pytest.approx(0.6, abs=0.25)]
    assert human.events[1].takeoff_error == pytest.approx(skill.distances[0] - 0.6)


def test_a_skill_says_when_the_body_has_fallen_and_its_hands_let_go():
    skill = Recorder(trips=True, holds=True)
    human = Human(None, clearing=[skill], rehearsals=0)  # else it would not try
    human.reset((0, 0, 0), 0.0)
    obstacle = ObstacleAhead(14.0, "jump", 0.4, np.array([14.0, 0, 0.4]), np.array([-1.0, 0, 0]))
    human.follow([[0, 0, 0], [25, 0, 0]], 3.0, [obstacle])
    held = False
    while human.status in MOVING:
        human.tick()
        held = held or holding(human.data, 1.0)
    assert held and human.status == "fallen"
    assert not holding(human.data, 1.0)


def at(arc, height=0.4):
    return ObstacleAhead(arc, "jump", height, np.array([arc, 0.0, height]), np.array([-1.0, 0.0, 0.0]))


@pytest.fixture
def run_up():
    made = RunUp([Recorder()], load_run_skill())
    made.begin([at(14.0), at(30.0)])
    return made


def test_obstacles_come_one_after_the_other(run_up):
    assert run_up.ahead.arc_length == 14.0 and run_up.passed == 0.0
    assert run_up.comes_within(10.0, 5.0) and not run_up.comes_within(10.0, 3.0)
    assert not run_up.comes_within(20.0, 5.0)  # the first is behind it
    assert run_up.ahead.arc_length == 30.0
    assert run_up.passed == pytest.approx(14.0 + 0.8)  # it could go back to just behind the first
    assert not run_up.comes_within(31.0, 99.0) and run_up.ahead is None


def test_one_that_breaks_off_goes_back_until_its_run_up_is_long_enough_at_most_eight_times(run_up):
    follower = PathFollower()
    follower.begin(make_path([[0, 0, 0], [40, 0, 0]], 3.0, TrackingLimits((2.0, 4.0)), 3.0), 0)
    assert run_up.turning_point(2.0, follower) is None  # far enough away
    to = run_up.turning_point(11.0, follower)
    assert to == pytest.approx(14.0 - SET_OFF)
    run_up.balk()
    assert run_up.balked and run_up.planned == 0.0
    assert run_up.turning_point(to + 1.0, follower) == pytest.approx(to)  # it has to set off anew
    assert run_up.turning_point(to + 0.5, follower) is None  # not worth it
    for _ in range(8):
        run_up.go_back()
        assert not run_up.balked
    assert run_up.turning_point(11.0, follower) is None
    run_up.begin([at(14.0)])
    assert run_up.turning_point(11.0, follower) == pytest.approx(to)


def test_a_run_up_goes_back_no_farther_than_the_last_bend(run_up):
    bent = PathFollower()
    path = make_path([[0, 8, 0], [0, 0, 0], [40, 0, 0]], 3.0, TrackingLimits((2.0, 4.0)), 3.0)
    bent.begin(path, 0)
    to = run_up.turning_point(13.0, bent)
    assert to == pytest.approx(8.0, abs=0.4)


def test_rehearsals_begin_in_time_and_end_with_what_went_well(run_up):
    near = 14.0 - RUN_UP
    assert not run_up.rehearses_within(near - 3.0, 2.0) and run_up.rehearses_within(near - 1.0, 2.0)
    run_up.set_off((0.1, 0.2), goes_well=True)
    assert run_up.rehearsed and run_up.plan[[FARTHER, FASTER]].tolist() == [0.1, 0.2]
    assert not run_up.rehearses_within(near, 2.0)  # it is known how it goes
    assert run_up.rehearses_within(13.5, 2.0)  # about to clear it, it looks at the next
    run_up.obstacles = (at(14.0), at(60.0))
    assert not run_up.rehearses_within(13.5, 2.0)  # which is far behind it
    run_up.obstacles = (at(14.0), at(30.0))
    run_up.disturb()
    assert not run_up.rehearsed and run_up.rehearses_within(near, 2.0)


def test_a_fall_ends_what_was_being_cleared(run_up):
    run_up.at_work = np.zeros(1)
    assert run_up.clearing
    run_up.give_up()
    assert not run_up.clearing and run_up.balked and run_up.ahead.arc_length == 14.0
    run_up.begin([])
    assert run_up.ahead is None and not run_up.balked
