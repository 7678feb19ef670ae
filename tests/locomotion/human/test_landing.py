"""The network that corrects landings: when it acts, and that its memory is saved."""

import numpy as np
import pytest

from locomotion import Ground, Human
from locomotion.gaits.residual.layout import CLEARS, CROSSING, DECIDED, LANDED, SINCE
from locomotion.human.human import BetweenGaits
from locomotion.human.landing import LASTS, NEVER
from locomotion.human.motion_start import moment_like, set_in_motion
from locomotion.skills.course import make_course
from navmesh.obstacles.kinds import CROSSINGS

COURSE = make_course([("jump", 0.35, 0.0)], [12.0])
GROUND = Ground.from_arrays(COURSE.vertices, COURSE.faces)


def on_its_way(**options):
    human = Human(GROUND, rehearsals=0, **options)
    human.reset(COURSE.path[0], 0.0)
    human.follow(COURSE.path, 3.5, COURSE.obstacles)
    return human


def landed(human, clears="jumping"):
    """Tick until it lands."""
    while not human.on_feet.landing.acts:
        human.tick()
        assert human.status in ("walking", "running", clears)
    return human


@pytest.fixture(scope="module")
def landing():
    """A state just behind a landing."""
    return landed(on_its_way()).save_state()


def test_it_acts_from_the_landing_on_until_it_fades():
    human, acted = on_its_way(), [False]
    while not any(acted) or acted[-1]:
        human.tick()
        assert human.status in ("walking", "running", "jumping")
        memory = human.on_feet.landing.memory
        acted.append(bool(memory[SINCE] > 0.0))
        if acted[-1] and not acted[-2]:
            assert human.com[0] > 11.5 and human.status == "jumping"  # it flew onto the stair
        assert acted[-1] == bool(memory[DECIDED].any())
    assert LASTS < sum(acted) < LASTS + 150


def test_it_sees_what_was_cleared_and_how_long_ago(landing):
    human = on_its_way()
    human.restore_state(landing)
    feet, seen = human.on_feet, human.on_feet.landing.observed
    feet.landing.observe(human.run_up, human.control, feet.walk, human.data)
    assert seen[CLEARS] == 1.0 and seen[LANDED] == human.on_feet.landing.memory[SINCE] / LASTS
    assert seen[CROSSING].tolist() == [each == "onto" for each in CROSSINGS]
    while human.status == "jumping":
        human.tick()
    feet.landing.observe(human.run_up, human.control, feet.walk, human.data)
    assert seen[CLEARS] == 0.0 and seen[CROSSING].tolist() == [each == "onto" for each in CROSSINGS]


def test_a_person_restored_while_it_lands_goes_on_bit_for_bit(landing):
    ends = []
    for _ in range(2):
        human = on_its_way()
        human.restore_state(landing)
        for _ in range(40):
            human.tick()
        ends.append(human.qpos)
    plain = on_its_way(between=BetweenGaits(landing=None))
    plain.restore_state(landing)
    for _ in range(40):
        plain.tick()
    assert np.array_equal(*ends) and not np.array_equal(ends[0], plain.qpos)


def test_it_leaves_skills_of_ones_own_alone():
    human = on_its_way()
    human.on_feet.landing.behind = lambda skill: False
    never = 0
    while human.status in ("walking", "running", "jumping"):
        human.tick()
        memory = human.on_feet.landing.memory
        assert not memory[DECIDED].any()
        never += memory[SINCE] == NEVER
    assert never > 50 and not memory.any()


def test_it_yields_to_braking(landing):
    human = on_its_way()
    human.restore_state(landing)
    while human.status == "jumping":
        human.tick()
    human.stop()
    human.brake(1.5)
    for _ in range(120):
        human.tick()
    assert human.on_feet.residual.acts and not human.on_feet.landing.acts


def test_whoever_is_put_elsewhere_forgets(landing):
    human = on_its_way()
    human.restore_state(landing)
    human.reset(COURSE.path[0], 0.0)
    assert not human.on_feet.landing.memory.any()


def test_whoever_falls_then_gets_up_without_it(landing):
    human = on_its_way(gets_up=True)
    human.restore_state(landing)
    while human.status != "getting up":
        human.data.xfrc_applied[human.index.chest, :2] = 0.0, 900.0
        human.tick()
    assert not human.on_feet.landing.memory.any()


def test_whoever_falls_for_good_is_no_longer_corrected(landing):
    human = on_its_way()
    human.restore_state(landing)
    while human.status != "fallen":
        human.data.xfrc_applied[human.index.chest, :2] = 0.0, 900.0
        human.tick()
    for _ in range(30):
        assert not human.on_feet.landing.memory.any()
        human.tick()


def test_whoever_rests_meanwhile_sets_off_without_it():
    course = make_course([("drop", 1.0, 0.0)], [12.0])
    human = Human(Ground.from_arrays(course.vertices, course.faces), rehearsals=0)
    human.reset(course.path[0], 0.0)
    human.follow(course.path, 3.5, course.obstacles)
    landed(human, "dropping")
    human.stop()
    while not human.held:
        human.tick()
    assert human.status == "standing" and human.on_feet.landing.acts
    human.tick()
    assert not human.on_feet.landing.memory.any()


@pytest.mark.parametrize("own", [False, True])
def test_sent_elsewhere_in_mid_air_it_waits_for_no_landing(own):
    human = on_its_way()
    human.on_feet.landing.behind = lambda skill: not own
    memory = human.on_feet.landing.memory
    while memory[SINCE] >= 0.0:
        human.tick()
    here = human.position
    human.follow([here, here + np.array([6.0, 0.0, 0.0])], 3.0)
    human.tick()
    assert not memory.any()


def test_whoever_goes_on_from_recorded_motion_forgets(landing):
    human = on_its_way()
    human.restore_state(landing)
    moment = moment_like(True, 3.0, human.qpos, human.data.qvel[6:45])
    assert moment is not None
    set_in_motion(human, moment, human.qpos[:2], float(human.position[2]), 0.0)
    assert not human.on_feet.landing.memory.any()


def test_it_rehearses_with_the_same_skills_left_alone():
    human = on_its_way()
    human.on_feet.landing.behind = lambda skill: False
    assert human._double().on_feet.landing.behind is human.on_feet.landing.behind
