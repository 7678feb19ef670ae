"""Rehearsals: a person that tries out what it is about to do does what goes well, and as foreseen."""

from types import SimpleNamespace

import numpy as np
import pytest

from locomotion.body.person import CONTROL_DT
from locomotion.body_events import Arrived, Cleared, Fell, GotStuck, SetOff, TookOff, WentBack
from locomotion.human.human import Human
from locomotion.human.state import MOVING
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.rehearsal import trials
from locomotion.rehearsal.contact_report import ContactReport, Watcher
from locomotion.rehearsal.lookahead import Lookahead
from locomotion.rehearsal.trials import at_once, clears, walks_on
from locomotion.skills.interface import foot_distance
from runtime.evaluation.courses import make_course, run_course
from tests.enough import enough

MARK, ENTRY = 0.6, 3.0


class Picky:
    """A skill that falls unless it starts at least ``from_`` [m] before the edge, and else is over after
    0.3 s."""

    affordance, ends = "drop", "running"
    heights = (0.3, 0.5)
    stride = (0.25, 0.0, 0.25)

    def __init__(self, from_):
        self.from_, self.starts = from_, 0

    def approach(self, height, depth=0.0):
        return ENTRY, MARK

    def start(self, obstacle, state):
        self.starts += 1
        return np.array([0.0, foot_distance(state, obstacle)])

    def tick(self, obstacle, memory, state, data):
        memory[0] += 1
        return bool(memory[0] >= 30)

    def fell(self, memory, state):
        return bool(memory[0] > 20 and memory[1] < self.from_)


def about_to_run_up(skill, rehearsals):
    """A person on the plane on its way to an edge 14 m ahead."""
    human = Human(None, clearing=[skill], rehearsals=rehearsals)
    human.reset((0, 0, 0), 0.0)
    edge = ObstacleAhead(14.0, "drop", 0.4, np.array([14.0, 0, 0]), np.array([-1.0, 0, 0]))
    human.follow([[0, 0, 0], [30, 0, 0]], 3.0, [edge])
    return human


def run_on(human, seconds=20.0):
    while human.status in MOVING and human.time < seconds:
        human.tick()
    return [type(event) for event in human.events if not isinstance(event, WentBack)]


def distance_unrehearsed():
    skill = Picky(0.0)
    human = about_to_run_up(skill, 0)
    while not human.events or not isinstance(human.events[-1], TookOff):
        human.tick()
    return human.events[-1].takeoff_error + MARK


def test_it_takes_off_from_where_the_skill_works():
    needed = distance_unrehearsed() + 0.02
    assert Fell in run_on(about_to_run_up(Picky(needed), 0))
    happened = run_on(about_to_run_up(Picky(needed), 16))
    assert Cleared in happened and Fell not in happened


def test_a_choice_that_goes_well_is_not_rehearsed_again():
    skill = Picky(0.0)
    run_on(about_to_run_up(skill, 16))
    assert skill.starts == 1  # in rehearsal: what was seen of it comes true


def test_it_does_not_run_at_what_never_holds_and_keeps_its_budget(monkeypatch):
    monkeypatch.setattr(Lookahead, "go_on", lambda *_: None)  # each rehearsal in one tick
    skill = Picky(100.0)
    human = about_to_run_up(skill, 2)
    here, returns, most = 0.0, 0, 0
    while human.status in MOVING and human.time < 300.0:
        starts = skill.starts
        human.tick()
        most = max(most, skill.starts - starts)
        back = human.arc_length < here - 0.7
        returns, here = returns + back, human.arc_length if back else max(here, human.arc_length)
    assert human.status == "stuck" and human.arc_length < 14.0 and most == 2
    assert 1 <= returns <= 40
    assert [type(event) for event in human.events if not isinstance(event, WentBack)] == [SetOff, GotStuck]


def test_a_run_up_that_would_fail_now_is_broken_off_and_begun_again():
    skill = Picky(0.0)
    human = about_to_run_up(skill, 16)
    while human.arc_length < 7.0:
        human.tick()
    skill.from_ = 100.0
    human.give_way(1.0, np.zeros((2, 2)))  # something has changed
    while human.gait_now != "walk":
        human.tick()
        assert human.status in MOVING
    skill.from_ = 0.0
    assert run_on(human, 60.0) == [SetOff, TookOff, Cleared, Arrived]


def test_clearing_an_obstacle_without_a_way_on_behind_it_is_worth_less(monkeypatch):
    easy, never = Picky(0.0), Picky(100.0)
    never.heights = (0.6, 0.8)
    human = Human(None, clearing=[easy, never], rehearsals=0)
    edges = [
        ObstacleAhead(x, "drop", height, np.array([x, 0, 0]), np.array([-1.0, 0, 0]))
        for x, height in ((14.0, 0.4), (20.0, 0.7))
    ]
    human.reset((0, 0, 0), 0.0, speed=3.0)
    human.follow([[0, 0, 0], [30, 0, 0]], 3.0, edges)
    while not human.begins_run_up:
        human.tick()
    here = human.save_state()
    assert at_once(clears(human))[0] == 1.0 and never.starts > 0  # it can be broken off

    def never_walks_on(body):
        yield
        return 0.0, []

    monkeypatch.setattr(trials, "walks_on", never_walks_on)
    human.restore_state(here)
    assert 0.0 < at_once(clears(human))[0] < 1.0


def at_a_pair(from_):
    """A person in the run-up to an edge. Right behind it is a second one, so it takes off again at once. It
    falls there unless it begins at least ``from_`` [m] before the edge."""
    first, second = Picky(0.0), Picky(from_)
    second.heights = (0.6, 0.8)
    human = Human(None, clearing=[first, second], rehearsals=0)
    edges = [
        ObstacleAhead(x, "drop", height, np.array([x, 0, 0]), np.array([-1.0, 0, 0]))
        for x, height in ((14.0, 0.4), (15.0, 0.7))
    ]
    human.reset((0, 0, 0), 0.0, speed=3.0)
    human.follow([[0, 0, 0], [30, 0, 0]], 3.0, edges)
    while not human.begins_run_up:
        human.tick()
    human.vary_run_up((0.0, 0.0))
    return human, second


def test_a_rehearsal_goes_on_over_what_follows_at_once():
    human, second = at_a_pair(0.0)
    assert at_once(clears(human))[0] == 1.0 and second.starts == 1
    human, second = at_a_pair(100.0)  # it falls there
    assert at_once(clears(human))[0] == 0.0 and second.starts == 1


class Scripted:
    """A body that walks, ``happens`` (its tick: its event), begins to run at tick ``runs`` and falls at tick
    ``falls``. ``next_one``: the obstacle ahead from when it runs."""

    gait_now, held, begins_run_up, hemmed_in, status = "walk", False, False, False, "walking"
    follower = SimpleNamespace(arc_length=3.0)
    lateral_error = 0.0
    obstacle_ahead = ObstacleAhead(2.0, "jump", 0.4, np.zeros(3), np.array([-1.0, 0, 0]))

    def __init__(self, happens, falls, runs=9999, next_one=None):
        self.runs, self.next_one = runs, next_one
        self.happens, self.falls, self.ticks, self.events = happens, falls, 0, []
        self.decider = SimpleNamespace(undecided=False)

    def save_state(self):
        return None

    def tick(self):
        self.ticks += 1
        self.events += [event for at, event in self.happens.items() if at == self.ticks]
        if self.ticks == self.runs:
            self.gait_now, self.obstacle_ahead = "run", self.next_one
        if self.ticks == self.falls:
            self.status = "fallen"


CLEARED, BACK = Cleared(0.0, (0, 0, 0), "jump", 0.4), WentBack(0.0, (0, 0, 0), "jump", 0.4, 1.0)


def test_one_that_turns_round_behind_an_obstacle_is_watched_for_longer():
    assert at_once(clears(Scripted({100: CLEARED}, 600)))[0] == 1.0  # it walked steadily before
    assert at_once(clears(Scripted({100: CLEARED, 200: BACK}, 600)))[0] == 0.0
    assert at_once(clears(Scripted({100: CLEARED, 200: BACK}, 900)))[0] == 1.0


def test_one_that_turns_round_after_slowing_down_is_watched_for_longer():
    assert at_once(walks_on(Scripted({}, 600)))[0] == 1.0
    assert at_once(walks_on(Scripted({100: BACK}, 600)))[0] == 0.0
    assert at_once(walks_on(Scripted({100: BACK}, 900)))[0] == 1.0


def test_running_on_after_a_walk_is_rehearsed_unless_it_is_a_run_up():
    near, far = (ObstacleAhead(x, "jump", 0.4, np.zeros(3), np.array([-1.0, 0, 0])) for x in (13.0, 40.0))
    assert at_once(clears(Scripted({100: CLEARED}, 500, runs=450)))[0] == 0.0
    assert at_once(clears(Scripted({100: CLEARED}, 500, runs=450, next_one=far)))[0] == 0.0
    assert at_once(clears(Scripted({100: CLEARED}, 500, runs=450, next_one=near)))[0] == 1.0
    assert at_once(clears(Scripted({100: CLEARED}, 700, runs=450)))[0] == 1.0


def test_a_rehearsal_waits_16_seconds_for_what_is_to_happen():
    assert at_once(clears(Scripted({1100: CLEARED}, 9999)))[0] == 1.0
    assert at_once(clears(Scripted({1700: CLEARED}, 9999)))[0] == 0.0


class Walks:
    """A body that walks, ``drift`` [m] farther beside its path each second."""

    status, gait_now, held = "walking", "walk", False

    def __init__(self, drift):
        self.drift, self.lateral_error, self.events = drift, 0.0, []
        self.decider = SimpleNamespace(undecided=False)

    def tick(self):
        self.lateral_error += self.drift * CONTROL_DT


def test_slowing_down_goes_well_if_it_does_not_stagger_in_the_end():
    assert at_once(walks_on(Walks(0.02)))[0] == 1.0
    assert at_once(walks_on(Walks(-0.4)))[0] == at_once(walks_on(Walks(0.4)))[0] == 0.5


def test_a_push_in_the_run_up_makes_it_rehearse_anew():
    skill = Picky(0.0)
    human = about_to_run_up(skill, 16)
    while skill.starts == 0:
        human.tick()
    human.data.xfrc_applied[human.index.root, 1] = 30.0
    human.tick()
    human.data.xfrc_applied[:] = 0.0
    run_on(human)
    assert skill.starts == 2


def test_a_rehearsal_leaves_no_trace():
    alone, rehearsing = (about_to_run_up(Picky(0.0), n) for n in (0, 16))
    run_on(alone), run_on(rehearsing)
    assert rehearsing.state_hash() == alone.state_hash()
    assert rehearsing.events == alone.events


def test_a_person_saved_in_the_run_up_goes_on_bit_for_bit():
    needed = distance_unrehearsed() + 0.02
    human, twin = (about_to_run_up(Picky(needed), 16) for _ in range(2))
    while not human.run_up.planned:
        human.tick()
    run = human.run_up
    while run.planned and not run.clearing:
        twin.restore_state(human.save_state())
        human.tick()
    run_on(human), run_on(twin)
    assert human.state_hash() == twin.state_hash()


@pytest.mark.parametrize(
    ("affordance", "passage", "clean"),
    [
        ("jump", ContactReport(), True),
        ("jump", ContactReport(touched=True), False),
        ("drop", ContactReport(head=0.02), False),
        ("vault", ContactReport(), False),
        ("vault", ContactReport(held=0.1, planted=0.6), True),
        ("vault", ContactReport(held=0.1, planted=0.9), False),
    ],
)
def test_what_counts_as_clean(affordance, passage, clean):
    assert passage.clean(affordance) is clean


@pytest.mark.parametrize(("affordance", "height"), [("vault", 0.8), ("drop", 1.5), ("jump", 0.5)])
def test_a_rehearsal_sees_all_that_is_touched(affordance, height, monkeypatch):
    rehearsed = []

    class Recorder(Watcher):
        def look(self, data, obstacle, passage):
            super().look(data, obstacle, passage)
            rehearsed.append(passage)

    monkeypatch.setattr(trials, "Watcher", Recorder)
    (came,) = run_course(make_course([(affordance, height, 0.3)], [14.0])).reports
    assert came.cleared and came.peak > 1.0
    for name in ("touched", "held", "planted", "head", "peak"):
        np.testing.assert_equal(getattr(rehearsed[-1], name), getattr(came, name))


@pytest.mark.parametrize(("affordance", "height"), [("vault", 0.8), ("drop", 1.5), ("jump", 0.5)])
def test_skills_hold_from_any_distance(affordance, height):
    runs = (run_course(make_course([(affordance, height, 0.3)], [d])) for d in np.linspace(12.0, 17.0, 8))
    assert enough((run.ended == "arrived" and run.reports[0].clean(affordance) for run in runs), 7)


@pytest.mark.parametrize("room", [5.0, 6.0])
def test_who_has_little_room_tries_what_there_is_before_it_goes_back(room):
    run = run_course(make_course([("jump", 0.4, 0.0)], [room]))
    assert run.ended == "arrived" and run.seconds < 30.0
