"""Skills on levels of triangles: the person runs up, clears the obstacle and goes on."""

import numpy as np
import pytest

from locomotion import MOVING, Ground, Human, LocomotionError
from locomotion.body.person import CONTROL_DT, MASS
from locomotion.body_events import Cleared, Fell, TookOff
from locomotion.skills.vault import kernel as vault
from locomotion.skills.vault.skill import Vault
from runtime.evaluation.courses import Push, enter_course, make_course, run_course


def one(affordance, height, distance):
    return make_course([(affordance, height, 0.3)], [distance])


def on_the_top(human):
    """Whether a vaulting hand touches the wall."""
    return human.run_up.clearing and human.run_up.at_work[vault.HOLD] == 1.0


@pytest.mark.parametrize(
    ("affordance", "heights", "least"), [("jump", (0.1, 0.3, 0.5, 0.7), 7), ("vault", (0.6, 0.7), 3)]
)
def test_clears_obstacles_and_goes_on(affordance, heights, least):
    arrived = 0
    for height in heights:
        for distance in (11.3, 18.2):
            run = run_course(one(affordance, height, distance))
            assert run.reports
            passage = run.reports[0]
            by_hand = affordance != "vault" or 0.0 <= passage.planted <= 1.0
            arrived += run.ended == "arrived" and passage.cleared and by_hand
    assert arrived >= least


def test_a_push_comes_where_it_is_told_and_moves_the_person_so_much():
    course = one("jump", 0.4, 14.0)
    left, right = (
        run_course(course, push=Push(6.0, np.array([0.0, side]), 10), keep_frames=True)
        for side in (150.0, -150.0)
    )
    sideways = (np.array(left.frames[:600]) - np.array(right.frames[:600]))[:, 1]
    begun = int(np.flatnonzero(sideways)[0])
    assert left.frames[begun][0] == pytest.approx(6.0, abs=0.2)
    after = (sideways[begun + 20] - sideways[begun + 10]) / (10 * CONTROL_DT)  # [m/s], of the pelvis
    assert 0.5 < after / (2.0 * 150.0 * 0.1 / MASS) < 2.5
    assert left.reports[0].cleared and right.reports[0].cleared


def test_several_obstacles_one_after_another():
    course = make_course([("jump", 0.4, 0.0), ("jump", 0.3, 0.0)], [12.0, 12.0])
    human = enter_course(course)
    while human.status in MOVING and human.time < 30.0:
        human.tick()
    kinds = [type(event) for event in human.events if isinstance(event, TookOff | Cleared)]
    assert kinds == [TookOff, Cleared, TookOff, Cleared]
    assert human.status == "arrived"


@pytest.mark.parametrize(
    ("affordance", "height", "status"),
    [("jump", 0.4, "jumping"), ("vault", 0.7, "vaulting"), ("drop", 1.2, "dropping")],
)
def test_a_skill_repeats_and_is_restored_bit_for_bit(affordance, height, status):
    course = one(affordance, height, 11.0)
    first, second = enter_course(course), enter_course(course)
    while first.status != status or (affordance == "vault" and not on_the_top(first)):
        first.tick()
        assert first.status in MOVING
    for _ in range(10):
        first.tick()
    saved = first.save_state()
    for _ in range(120):
        first.tick()
    while second.time < first.time:
        second.tick()
    third = Human(Ground.from_arrays(course.vertices, course.faces))
    third.restore_state(saved)
    while third.time < first.time:
        third.tick()
    assert first.state_hash() == second.state_hash() == third.state_hash()


def test_a_palm_bears_on_the_top_and_pulls_only_with_the_joint():
    for joint in (False, True):
        human = enter_course(one("vault", 0.7, 13.0), rehearsals=0)
        skill = next(each for each in human.clearing if isinstance(each, Vault))
        skill.joint, bears, held = joint, False, False
        while human.status in MOVING and human.position[0] < 16.0:
            human.tick()
            bears = bears or on_the_top(human)
            held = held or human.data.eq_active.any()
            assert human.status == "vaulting" or not human.data.eq_active.any()
        assert bears and held == joint and human.position[0] >= 16.0


@pytest.mark.parametrize(
    ("affordance", "height"), [("jump", 0.9), ("vault", 0.4), ("vault", 1.3), ("drop", 2.5), ("gap", 2.4)]
)
def test_an_obstacle_out_of_range_is_refused_before_the_run_up(affordance, height):
    course = one(affordance, height, 12.0)
    with pytest.raises(LocomotionError, match=f"no skill clears {affordance} {height:.2f} m; there are"):
        enter_course(course)


def test_noise_changes_the_start_only():
    course = one("jump", 0.4, 11.0)
    quiet, noisy = enter_course(course), enter_course(course, noise=np.full(45, 0.01))
    assert quiet.qpos.tolist() == noisy.qpos.tolist()
    assert (noisy.data.qvel == quiet.data.qvel + 0.01).all()


def test_who_falls_in_the_run_up_gets_up_goes_back_and_clears_it():
    course = make_course([("jump", 0.4, 0.3)], [12.0])
    ground, cleared = Ground.from_arrays(course.vertices, course.faces), 0
    for k in range(3):
        human = Human(ground, gets_up=True)
        human.reset(course.path[0], 0.0)
        human.follow(course.path, 3.5, course.obstacles)
        while human.arc_length < 6.0 + 0.8 * k:
            human.tick()
        while human.status == "running":
            human.data.xfrc_applied[human.index.root, :2] = -500.0, 60.0 * (-1.0) ** k
            human.tick()
        human.data.xfrc_applied[:] = 0.0
        while human.status in MOVING and human.time < 100.0:
            human.tick()
        assert any(isinstance(event, Fell) for event in human.events)
        cleared += human.status == "arrived" and any(isinstance(event, Cleared) for event in human.events)
    assert cleared == 3
