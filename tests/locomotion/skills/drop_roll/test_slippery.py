"""The drop-roll on slippery ground."""

from dataclasses import replace

import numpy as np
import pytest

from locomotion import MOVING, LocomotionError
from locomotion.body_events import Cleared, TookOff
from locomotion.gaits.run import controller
from locomotion.gaits.walk.skill import load_walk_skill
from locomotion.ground.ground import FRICTION
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.preconditions.moments import make_slippery
from locomotion.skills.course import make_course
from locomotion.skills.drop_roll import kernel as drop_roll
from locomotion.skills.drop_roll.kind import DROP_ROLL
from locomotion.skills.drop_roll.slippery import SLIPPERY_ROLL, load_slippery_roll
from runtime.evaluation.courses import enter_course


def test_usual_ground_has_no_share_in_it_and_the_most_slippery_all():
    skill = load_slippery_roll()
    assert skill.share(FRICTION) == skill.share(2.0) == 0.0
    assert skill.share(skill.friction) == skill.share(0.1) == 1.0
    assert skill.share(0.5 * (FRICTION + skill.friction)) == pytest.approx(0.5)


def test_roll_and_walk_change_by_the_share():
    skill, walk, usual = load_slippery_roll(), load_walk_skill(), np.zeros(drop_roll_parameters())
    assert np.array_equal(skill.parameters(usual, 0.0), usual)
    assert np.allclose(skill.parameters(usual, 0.5), 0.5 * skill.roll)
    assert np.allclose(skill.parameters(usual, 1.0), skill.roll)
    assert np.array_equal(skill.walk_tables(walk, 0.0), walk.tables)
    assert np.allclose(skill.walk_tables(walk, 1.0), skill.gains)


def drop_roll_parameters():
    return sum(drop_roll.PARAMETERS.values())


def test_a_roll_remembers_how_slippery_the_ground_was_where_it_began():
    skill, state = DROP_ROLL.load(None), controller.new_state()
    drop = ObstacleAhead(0.0, "drop", 1.2, np.zeros(3), np.array([-1.0, 0.0, 0.0]))
    assert skill.start(drop, state)[drop_roll.SLIPPERY] == 0.0
    memory = skill.start(replace(drop, friction=0.45), state)
    assert memory[drop_roll.SLIPPERY] == 1.0
    skill.check(memory, 0.0)
    memory[drop_roll.SLIPPERY] = 1.5
    with pytest.raises(LocomotionError, match="the roll of a person"):
        skill.check(memory, 0.0)


def dropping(height, friction, rehearsals):
    course = make_course([("drop", height, 0.0)], [11.0])
    human = enter_course(course, rehearsals=rehearsals)
    human.ground.friction = friction
    make_slippery(human.model, friction)
    return human


@pytest.mark.parametrize("height", [1.1, 1.7])
def test_people_who_rehearse_roll_off_drops_on_slippery_ground_and_go_on(height):
    human, cleared = dropping(height, 0.45, 16), 0
    while human.status in MOVING and human.time < 40.0:
        human.tick()
        cleared += sum(isinstance(event, Cleared) for event in human.events)
        human.events.clear()
    assert human.status == "arrived" and cleared == 1


def test_saved_while_it_comes_up_it_goes_on_bit_for_bit():
    human, twin = dropping(1.2, 0.45, 0), dropping(1.2, 0.45, 0)
    while not any(isinstance(event, Cleared) for event in human.events):
        assert human.status in MOVING
        human.tick()
    state = human.save_state()
    twin.restore_state(state)
    for each in (human, twin):
        for _ in range(60):
            each.tick()
    assert twin.state_hash() == human.state_hash()


def test_nobody_who_sets_off_on_slippery_ground_falls_before_the_edge():
    human = dropping(1.2, 0.45, 0)
    while not any(isinstance(event, TookOff) for event in human.events):
        assert human.status in ("walking", "running")
        human.tick()


def test_file_that_is_cut_off_or_of_something_else_is_refused(tmp_path):
    file, whole = tmp_path / "roll.npz", SLIPPERY_ROLL.read_bytes()
    for content in (whole[:100], b"", b"something else"):
        file.write_bytes(content)
        with pytest.raises(LocomotionError, match=r"roll\.npz"):
            load_slippery_roll(file)
    skill = load_slippery_roll()
    for broken in (
        replace(skill, roll=skill.roll[:-1]),
        replace(skill, gains=np.full_like(skill.gains, np.nan)),
        replace(skill, friction=FRICTION),
    ):
        broken.save(file)
        with pytest.raises(LocomotionError, match=r"roll\.npz"):
            load_slippery_roll(file)
    skill.save(file)
    assert np.array_equal(load_slippery_roll(file).roll, skill.roll)
