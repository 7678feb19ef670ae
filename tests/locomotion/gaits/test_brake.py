"""From a run to a stand, as short as it goes."""

from dataclasses import replace

import numpy as np
import pytest

from locomotion import Human, LocomotionError
from locomotion.body.person import MASS
from locomotion.gaits.brake import BRAKE_SKILL, FIRST_STEPS, load_brake_skill
from locomotion.gaits.run import controller
from locomotion.paths.gait_plan import braking_length
from locomotion.rehearsal.choices import BRAKINGS
from locomotion.rehearsal.trials import ComesToRest, at_once, first_good
from tests.locomotion.gaits.runners import running, way_of_stop


def test_told_to_stop_at_any_moment_it_stands_within_a_few_steps():
    ways = []
    for k in range(8):
        human = running(300 + 7 * k)
        ways.append(way_of_stop(human))
        assert human.status == "standing" and human.data.xmat[human.index.root, 8] > 0.97
    assert max(ways) < 2.4 and np.median(ways) < 1.9  # 4 m where it slows down


def test_stopped_it_goes_on_when_told_again():
    for k in range(4):
        human = running(320 + 9 * k)
        way_of_stop(human)
        human.follow(human.position + np.outer([0.0, 12.0], [1, 0, 0]), 3.0)
        while human.status != "arrived":
            assert human.status in ("walking", "running") and human.time < 40.0
            human.tick()


def test_one_that_does_not_rehearse_slows_down_and_walks():
    human = running(300, rehearsals=0)
    human.stop()
    human.tick()
    assert human.gait_now == "slow run" and not human.on_feet.brakes
    assert human.on_feet.slowing == 1.0


def test_of_all_that_end_in_a_stand_it_does_the_first_that_is_short_enough():
    human, understudy = running(310), running(0, rehearsals=0)
    decide, decided = human.decider.answer, []
    assert decide is not None
    human.decider.answer = lambda question: decided.append((question, decide(question))) or decided[-1][1]
    begun, speed, way = human.com[0], float(human.velocity[0]), way_of_stop(human)
    ((question, outcome),) = decided
    each = [
        at_once(first_good(question.state, understudy, [harder], Human.brake, ComesToRest())).went
        for harder in BRAKINGS
    ]
    assert sum(went > 0.0 for went in each) > 1
    assert outcome.went == max(each) and outcome.choice == BRAKINGS[int(np.argmax(each))]
    room = way + begun + way - human.com[0]
    assert outcome.went == (
        1.0 if room <= braking_length(speed) else pytest.approx(1.0 / (1.0 + room), abs=0.02)
    )


def test_what_falls_does_not_come_to_rest():
    human = running(300)
    human.stop()
    human.data.qvel[:2] = 0.0, 6.0
    assert at_once(ComesToRest()(human))[0] == 0.0


@pytest.mark.parametrize("after", [1, 40, 90])
def test_saved_while_it_brakes_it_goes_on_bit_for_bit(after):
    human, twin = running(310), Human(None, clearing=())
    human.stop()
    while not human.on_feet.brakes:
        human.tick()
    for _ in range(after):
        human.tick()
    twin.restore_state(human.save_state())
    for each in (human, twin):
        for _ in range(200):
            each.tick()
    assert twin.state_hash() == human.state_hash()


def test_the_walk_takes_over_on_a_foot_that_bears_the_body_within_its_reach():
    skill, state = replace(load_brake_skill(), reach=0.4, hold=0.0), controller.new_state()
    state[controller.COM] = 0.0, 0.0, 0.9
    state[controller.COM_VELOCITY] = 2.31, 0.0, 0.0  # the capture point is 0.7 m ahead
    state[controller.STANCE] = 1.0
    state[controller.CONTACT] = 0.0, 9.81 * MASS
    state[controller.FEET] = np.array([[-0.4, -0.1, 0.3], [0.35, 0.1, 0.06]]).ravel()
    assert skill.can_walk_on(state)
    assert not replace(skill, reach=0.3).can_walk_on(state)
    state[controller.CONTACT] = 9.81 * MASS, 0.0
    assert not skill.can_walk_on(state)


def test_file_that_is_cut_off_or_of_something_else_is_refused(tmp_path):
    file, whole = tmp_path / "brake.npz", BRAKE_SKILL.read_bytes()
    for content in (whole[:100], b"", b"something else", whole[:-20]):
        file.write_bytes(content)
        with pytest.raises(LocomotionError, match=r"brake\.npz"):
            load_brake_skill(file)
    skill = load_brake_skill()
    assert len(skill.gains) == FIRST_STEPS
    for broken in (
        replace(skill, change=skill.change[:, :-1]),
        replace(skill, gains=np.full_like(skill.gains, np.nan)),
        replace(skill, reach=float("nan")),
    ):
        broken.save(file)
        with pytest.raises(LocomotionError, match=r"brake\.npz"):
            load_brake_skill(file)
