"""From a walk to a run in a few steps, and going back for a longer run-up."""

import numpy as np
import pytest

from locomotion import Ground, Human, LocomotionError
from locomotion.body_events import Cleared, SetOff, TookOff, WentBack
from locomotion.gaits.run import controller
from locomotion.gaits.run.skill import load_run_skill
from locomotion.gaits.speed_up import SPEED_UP_SKILL, load_speed_up_skill
from locomotion.human.human import BetweenGaits
from locomotion.human.state import MOVING
from locomotion.training.gaits.speed_up import speed_up_of
from runtime.evaluation.courses import enter_course, make_course

COURSE = make_course([("jump", 0.4, 0.0)], [14.5])
GROUND = Ground.from_arrays(COURSE.vertices, COURSE.faces)


def slow_starter():
    """A person whose run begins with the ordinary run's parameters."""
    skill = load_speed_up_skill()
    return Human(GROUND, between=BetweenGaits(speed_up=speed_up_of(np.zeros(2 * skill.change.shape[1]))))


def way_to(human, speed, seed):
    """[m] from standing until a step is as fast as ``speed`` [m/s]; infinite if it falls."""
    human.reset((0, 0, 0), 0.0)
    human.data.qvel[:] += 0.02 * np.random.default_rng(seed).normal(size=human.model.nv)
    human.follow(COURSE.path, 3.5, COURSE.obstacles)
    while human.status in MOVING and human.com[0] < 11.0:
        human.tick()
        if human.control[controller.STEP_SPEED] >= speed:
            return float(human.com[0])
    return np.inf


def test_it_is_fast_earlier_than_by_the_run_alone():
    quick, slow = Human(GROUND), slow_starter()
    ways = np.array([[way_to(human, 3.0, seed) for human in (quick, slow)] for seed in range(4)])
    assert np.median(ways[:, 0]) < 0.75 * np.median(ways[:, 1])


def test_tables_differ_from_the_runs_by_the_change():
    run, skill = load_run_skill(), load_speed_up_skill()
    knots, table, *rest = skill.run_tables(run)
    part = controller.parameter_slices()["a_hat"]
    for speed, change in zip(skill.knots, skill.change, strict=True):
        row = table[np.flatnonzero(knots == speed)[0], part]
        plain = [np.interp(speed, run.knots, column) for column in run.table[:, part].T]
        assert np.allclose(row - plain, change[part])
    assert all(a is b for a, b in zip(rest, run.tables[2:], strict=True))


@pytest.mark.parametrize("spoil", ["cut", "width", "nan", "order"])
def test_damaged_files_are_refused(tmp_path, spoil):
    file, skill = tmp_path / "speed_up.npz", load_speed_up_skill()
    if spoil == "cut":
        file.write_bytes(SPEED_UP_SKILL.read_bytes()[:500])
    else:
        knots, change = skill.knots.copy(), skill.change.copy()
        if spoil == "width":
            change = change[:, 1:]
        elif spoil == "nan":
            change[0, 3] = np.nan
        else:
            knots = knots[::-1]
        type(skill)(knots, change).save(file)
    with pytest.raises(LocomotionError, match=str(file)):
        load_speed_up_skill(file)


def test_it_goes_back_for_a_run_up_that_is_too_short():
    course = make_course([("drop", 1.2, 0.0), ("jump", 0.4, 0.0)], [12.0, 8.5])
    human = enter_course(course)
    back, here, cleared = 0.0, 0.0, 0
    while human.status in MOVING and human.time < 60.0:
        human.tick()
        cleared = sum(isinstance(event, Cleared) for event in human.events)
        if cleared == 1:
            here = max(here, human.position[0])
            back = max(back, here - human.position[0])
            assert human.path[-1] == pytest.approx(course.path[-1]) and human.arc_length > 12.0
    assert back > 0.7 and human.status == "arrived"
    kinds = [type(event) for event in human.events if not isinstance(event, WentBack)][:5]
    assert kinds == [SetOff, TookOff, Cleared, TookOff, Cleared]


def test_a_person_that_goes_back_is_saved_and_goes_on_bit_for_bit():
    course = make_course([("drop", 1.2, 0.0), ("jump", 0.4, 0.0)], [12.0, 8.5])
    human, twin = enter_course(course), enter_course(course)
    while human.save_state().interrupted is None:
        human.tick()
        assert human.status in MOVING
    for _ in range(100):
        human.tick()
    twin.restore_state(human.save_state())
    assert twin.arc_length == human.arc_length and np.array_equal(twin.path, human.path)
    for _ in range(600):
        human.tick(), twin.tick()
    assert human.state_hash() == twin.state_hash()
