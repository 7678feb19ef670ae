"""From a run to a walk and to a stand."""

import numpy as np
import pytest

from locomotion import Human, LocomotionError
from locomotion.body_events import Arrived, SetOff
from locomotion.gaits.run.skill import load_run_skill
from locomotion.gaits.slow_down import SLOW_DOWN_SKILL, load_slow_down_skill
from locomotion.human.state import MOVING


def come_to_rest(human, limit=40.0):
    """Tick until it rests; the gaits and the kinds of status on the way."""
    gaits, seen, end = [human.gait_now], [human.status], human.time + limit
    while not human.held and human.time < end:
        human.tick()
        gaits += [human.gait_now] if human.gait_now != gaits[-1] else []
        seen += [human.status] if human.status != seen[-1] else []
    return gaits, seen


def upright(human):
    return human.status != "fallen" and human.data.xmat[human.index.root, 8] > 0.97


def test_runs_walks_and_stands_at_its_goal():
    human, stood = Human(None, clearing=()), 0
    for k in range(6):
        end = [17.0 + 0.62 * k, 0.0, 0.0]
        human.events.clear()
        human.reset((0, 0, 0), 0.0)
        human.follow([[0, 0, 0], end], 2.3 + 0.2 * k)
        gaits, seen = come_to_rest(human)
        if upright(human):
            stood += 1
            assert gaits == ["walk", "run", "slow run", "walk"]
            assert seen == ["walking", "running", "walking", "arrived"]
            assert [type(event) for event in human.events] == [SetOff, Arrived]
            assert np.linalg.norm(human.position[:2] - end[:2]) < 0.5
    assert stood == 6


def test_told_to_stop_it_stands_within_a_few_metres_and_goes_on_when_told_again():
    human, stood = Human(None, clearing=()), 0
    for k in range(4):
        human.reset((0, 0, 0), 0.0)
        human.follow([[0, 0, 0], [60, 0, 0]], 3.0)
        for _ in range(400 + 23 * k):
            human.tick()
        assert human.gait_now == "run"
        begun = human.position
        human.stop()
        come_to_rest(human)
        if not upright(human):
            continue
        assert human.status == "standing" and np.linalg.norm(human.position - begun) < 9.0
        human.follow(human.position + np.outer([0.0, 20.0], [1, 0, 0]), 3.0)
        gaits, _ = come_to_rest(human)
        stood += upright(human) and gaits == ["walk", "run", "slow run", "walk"]
    assert stood == 4


def test_told_of_a_goal_behind_it_while_it_runs_it_comes_to_a_stand_turns_and_goes_there():
    human, arrived = Human(None, clearing=()), 0
    for k in range(5):
        human.reset((0, 0, 0), 0.0)
        human.follow([[0, 0, 0], [40, 0, 0]], 2.5 + 0.2 * k)
        while human.position[0] < 9.0:
            human.tick()
        way = [[0, 0, 0], [9, 0, 0], [9.5, 0.5, 0], [9, 1, 0], [0, 1, 0]]
        human.follow(human.position + np.array(way), 3.0)
        while human.status in MOVING and human.time < 60.0 * (k + 1):
            human.tick()
        arrived += human.status == "arrived"
    assert arrived == 5


@pytest.mark.parametrize("after", [1, 60])
def test_saved_while_it_slows_down_it_goes_on_bit_for_bit(after):
    human, twin = Human(None, clearing=()), Human(None, clearing=())
    human.reset((0, 0, 0), 0.0, 3.0)
    human.follow([[0, 0, 0], [12, 0, 0]], 3.0)
    while human.gait_now != "slow run":
        human.tick()
    for _ in range(after):
        human.tick()
    twin.restore_state(human.save_state())
    for each in (human, twin):
        for _ in range(400):
            each.tick()
    assert twin.state_hash() == human.state_hash()


def test_faster_than_its_highest_knot_it_slows_down_as_it_runs():
    run, slow_down = load_run_skill(), load_slow_down_skill()
    knots, table = slow_down.run_tables(run)[:2]
    for speed in (2.8, 3.0, 3.3, 4.2):
        for column in range(0, table.shape[1], 7):
            expected = np.interp(speed, run.knots, run.table[:, column])
            assert np.interp(speed, knots, table[:, column]) == pytest.approx(expected, abs=1e-12)


def test_file_that_is_cut_off_or_of_something_else_is_refused(tmp_path):
    file, whole = tmp_path / "slow_down.npz", SLOW_DOWN_SKILL.read_bytes()
    for content in (whole[:100], b"", b"something else", whole[:-20]):
        file.write_bytes(content)
        with pytest.raises(LocomotionError, match=r"slow_down\.npz"):
            load_slow_down_skill(file)
    skill = load_slow_down_skill()
    for broken in (skill.change[:, :-1], np.full_like(skill.change, np.nan)):
        type(skill)(skill.knots, broken, skill.gains).save(file)
        with pytest.raises(LocomotionError, match=r"slow_down\.npz"):
            load_slow_down_skill(file)
