"""A person without rehearsals takes off where its odds are good enough, and says so where it turns away."""

import zipfile
from copy import copy
from dataclasses import replace

import numpy as np
import pytest

from locomotion import MOVING, Ground, Human, LocomotionError
from locomotion.body_events import Cleared, GotStuck, TookOff, TurnedAway, WentBack
from locomotion.gaits.run.skill import load_run_skill
from locomotion.human import composition
from locomotion.human.composition import HOPELESS
from locomotion.preconditions.changes import SLOW_DOWN
from locomotion.preconditions.precondition import load_preconditions
from locomotion.rehearsal.choices import BALKINGS, RUN_UPS
from locomotion.rehearsal.trials import Rehearsal
from locomotion.skills.course import make_course
from locomotion.skills.learned_skill import LearnedSkill
from locomotion.training.preconditions.sampling import WiderSkill


def jump_of(human):
    """Its skill to jump."""
    return next(skill for skill in human.clearing if skill.affordance == "jump")


def always(odds, known, before=None):
    """A precondition that always says ``odds``."""

    def constant(machine, value):
        numbers = np.array([1.0, 0.0, 0.0, np.log(value / (1.0 - value))])
        return machine._replace(weights=np.zeros_like(machine.weights), numbers=numbers)

    at_first = known.before and constant(known.before, odds if before is None else before)
    return replace(known, run_up=constant(known.run_up, odds), before=at_first)


def goes(odds, bravery, before=None, seconds=20.0, rehearsals=0, waits=True, speed=0.0):
    """One that comes to a jump 12 m ahead, from a stand or running at ``speed``."""
    course = make_course([("jump", 0.4, 0.0)], [12.0])
    human = Human(Ground.from_arrays(course.vertices, course.faces), rehearsals=rehearsals)
    if rehearsals:
        human.waits = waits
    known = load_preconditions()
    human.composition.preconditions = {
        "jump": always(odds, known["jump"], before), SLOW_DOWN: known[SLOW_DOWN],
    }  # fmt: skip
    human.bravery = bravery
    human.reset(course.path[0], 0.0, speed)
    human.follow(course.path, 3.5, course.obstacles)
    while human.status in MOVING and human.time < seconds:
        human.tick()
        if isinstance(human.events[-1], Cleared | WentBack):
            break
    return human


def of(kind, human):
    return [event for event in human.events if isinstance(event, kind)]


def test_bad_odds_before_the_run_up_end_the_way_in_good_time():
    human = goes(0.1, 0.5)
    (away,), (stuck,) = of(TurnedAway, human), of(GotStuck, human)
    assert away.odds == pytest.approx(0.1) and (away.affordance, away.size) == ("jump", 0.4)
    assert stuck.reason == "its odds of clearing the jump of 0.40 m are 10 %"
    assert human.status == "stuck" and not of(TookOff, human) and human.com[0] < 6.0


def test_bad_odds_in_the_run_up_break_it_off_for_another_one():
    human = goes(0.2, 0.5, before=0.9)
    assert of(TurnedAway, human)[0].odds == pytest.approx(0.2) and not of(TookOff, human)
    assert len(of(WentBack, human)) == 1


@pytest.mark.parametrize(("odds", "bravery"), [(0.9, 0.5), (0.1, 1.0), (0.1, None)])
def test_who_dares_takes_off(odds, bravery):
    human = goes(odds, bravery)
    assert of(TookOff, human) and of(Cleared, human) and not of(TurnedAway, human)


def test_who_rehearses_sets_off_where_that_holds_whatever_its_odds_are():
    human = goes(0.01, None, before=0.01, rehearsals=16)
    assert of(TookOff, human) and of(Cleared, human) and not of(TurnedAway, human)


def test_a_hopeless_run_up_is_broken_off_as_rehearsed(monkeypatch):
    asked, run = [], Rehearsal.run

    def counted(rehearsal, understudy):
        asked.append(rehearsal.question.choices)
        return run(rehearsal, understudy)

    monkeypatch.setattr(Rehearsal, "run", counted)
    human = goes(0.9 * HOPELESS, None, rehearsals=16, speed=3.5)
    assert of(TurnedAway, human)[0].odds == pytest.approx(0.9 * HOPELESS) and not of(TookOff, human)
    assert human.status == "walking" and BALKINGS in asked and RUN_UPS not in asked


def test_odds_decide_where_there_is_no_time_to_rehearse():
    away = goes(0.9 * HOPELESS, None, rehearsals=16, waits=False, speed=3.5)  # nobody looks ahead
    assert of(TurnedAway, away)[0].odds == pytest.approx(0.9 * HOPELESS) and not of(TookOff, away)
    dares = goes(1.1 * HOPELESS, None, rehearsals=16, waits=False, speed=3.5, seconds=5.0)
    assert of(TookOff, dares) and not of(TurnedAway, dares)


def test_without_odds_rehearsals_decide_alone(monkeypatch):
    def outdated():
        raise LocomotionError("the jump has changed since")

    monkeypatch.setattr(composition, "load_preconditions", outdated)
    human = Human(rehearsals=16)
    assert human.composition.precondition(jump_of(human)) is None


@pytest.mark.parametrize("running", [0.0, 3.0])
def test_nobody_takes_a_drop_that_is_higher_than_what_was_learned(running):
    course = make_course([("drop", 2.5, 0.0)], [10.0])
    ground = Ground.from_arrays(course.vertices, course.faces)
    wider = [WiderSkill(each) for each in Human(ground, rehearsals=0).clearing]
    human, known = Human(ground, clearing=wider, rehearsals=0), load_preconditions()
    human.composition.preconditions = {**known, "drop": always(0.99, known["drop"])}
    human.bravery = 0.9
    human.reset(course.path[0], 0.0, running)
    human.follow(course.path, 3.5, course.obstacles)
    assert human.composition.odds(course.obstacles[0], 10.0) == 0.0
    while human.status in MOVING and human.time < 20.0:
        human.tick()
    assert of(TurnedAway, human)[0].odds == 0.0 and not of(TookOff, human)
    if not running:
        reason = "the drop of 2.50 m is beyond the 0.90 to 2.00 m that it has learned"
        assert of(GotStuck, human)[0].reason == reason


def test_bravery_is_a_share():
    human = Human(rehearsals=0)
    for wrong in (1.5, -0.1, "brave", float("nan")):
        with pytest.raises(LocomotionError, match="bravery must be a number from 0 to 1, or None"):
            human.bravery = wrong
    assert human.bravery is None


def test_a_skill_of_ones_own_with_the_packages_range_has_no_odds_of_it():
    own = copy(jump_of(Human()))
    human = Human(rehearsals=0)
    assert human.composition.precondition(jump_of(human)) is load_preconditions()["jump"]
    law = own._law
    own._tables, own._law = {}, lambda size: replace(law(size), parameters=1.001 * law(size).parameters)
    human = Human(rehearsals=0, clearing=[own])
    assert own.heights == load_preconditions()["jump"].heights
    assert human.composition.precondition(own) is None


def test_skills_on_a_run_of_ones_own_have_no_odds():
    run = load_run_skill()
    human = Human(skill=run, rehearsals=0)
    assert human.composition.precondition(jump_of(human)) is not None
    other = Human(skill=replace(run, max_lateral=0.9 * run.max_lateral), rehearsals=0)
    assert other.composition.precondition(jump_of(other)) is None


def test_whose_skills_they_are_is_known_without_working_out_a_law_or_loading_any(monkeypatch):
    """Else the first step of somebody brave would take a second."""
    human, known = Human(rehearsals=0), load_preconditions()["jump"]
    monkeypatch.setattr(LearnedSkill, "tables", None)
    monkeypatch.setattr(zipfile, "ZipFile", None)
    assert human.composition.precondition(jump_of(human)) is known
