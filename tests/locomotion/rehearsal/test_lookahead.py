"""A person that rehearses beforehand decides what one does that rehearses at the moment, in lighter ticks."""

import pytest

from locomotion.body_events import Cleared
from locomotion.human.human import Human
from locomotion.human.state import MOVING
from locomotion.rehearsal.deciding import RECONSIDERS
from locomotion.rehearsal.lookahead import PER_TICK, Lookahead
from locomotion.rehearsal.predicted import Predicted
from locomotion.rehearsal.trials import BRAKINGS, ComesToRest
from runtime.evaluation.courses import enter_course, make_course
from tests.locomotion.gaits.runners import running

COURSE = [("jump", 0.4, 0.3), ("vault", 0.7, 0.3)], [14.0, 9.0]


def enter(rehearsals=16):
    return enter_course(make_course(*COURSE), rehearsals=rehearsals)


def hashes(human, disturb=None):
    """Of its states, until it ends."""
    seen = []
    while human.status in MOVING and human.time < 60.0:
        human.tick()
        if disturb is not None:
            disturb(human)
        seen.append(human.state_hash())
    return seen


def push(human):
    """A push in its second second and another at a time of its own, and two changes of pace."""
    human.data.xfrc_applied[1, 1] = (
        60.0 if human.ticks in range(150, 160) or human.ticks in range(412, 420) else 0.0
    )
    if human.ticks in (200, 1000):
        human.give_way(0.9, None)
    if human.ticks in (230, 1050):
        human.give_way(1.0, None)


@pytest.mark.parametrize("disturb", [None, push])
def test_it_decides_as_if_it_rehearsed_at_the_moment(monkeypatch, disturb):
    foreseeing = hashes(enter(), disturb)
    monkeypatch.setattr(Lookahead, "go_on", lambda *_: 0)
    assert foreseeing == hashes(enter(), disturb)
    monkeypatch.setattr(Predicted, "comes_true", lambda *_: False)
    assert foreseeing == hashes(enter(), disturb)


def test_what_the_double_went_through_is_not_simulated_again(monkeypatch):
    human, made, tick = enter(), [], Human._tick
    monkeypatch.setattr(Human, "_tick", lambda each: (made.append(each is human), tick(each)))
    hashes(human)
    assert human.status == "arrived" and sum(made) < 0.5 * human.ticks and len(made) < 2.5 * human.ticks


@pytest.fixture
def made(monkeypatch):
    """[count] of ticks that were simulated."""
    count, tick = [0], Human._tick

    def counted(human):
        count[0] += 1
        tick(human)

    monkeypatch.setattr(Human, "_tick", counted)
    return count


def test_no_tick_bears_a_whole_rehearsal(monkeypatch, made):

    def most(human):
        result = 0
        while human.status in MOVING and human.time < 60.0:
            made[0] = 0
            human.tick()
            result = max(result, made[0])
        assert human.status == "arrived"
        return result

    beforehand = most(enter())
    monkeypatch.setattr(Lookahead, "go_on", lambda *_: 0)
    assert beforehand <= 50 and most(enter()) > 300


def test_a_restored_person_goes_on_as_before():
    human = enter()
    for _ in range(230):
        human.tick()
    state = human.save_state()
    first = hashes(human)
    human.restore_state(state)
    assert first == hashes(human)


# --- within a budget
def hurried():
    """A person that does not wait for what it has not rehearsed."""
    human = enter()
    human.waits = False
    return human


def budgeted(human, ticks, moments=()):
    """Hashes of its states, until it ends, and its states at these ``moments``; it rehearses for so many
    ticks in each of its own."""
    seen, states = [], []
    while human.status in MOVING and human.time < 60.0:
        human.tick()
        human.look_ahead(ticks)
        push(human)
        if human.ticks in moments:
            states.append(human.save_state())
        seen.append(human.state_hash())
    return seen, states


@pytest.mark.parametrize("ticks", [1, 7, PER_TICK])
def test_one_that_does_not_wait_never_takes_more_than_its_budget(made, ticks):
    human, most, unfinished = hurried(), 0, 0
    while human.status in MOVING and human.time < 30.0:
        made[0] = 0
        human.tick()
        own, taken = made[0], human.look_ahead(ticks)
        assert own <= 1 and taken <= ticks
        most = max(most, made[0])
        unfinished += taken == ticks
        push(human)
    assert unfinished > 100  # it had more to rehearse
    assert most <= 2 * ticks + 1  # a decision is met once before it is rehearsed, and once after


@pytest.mark.parametrize("ticks", [3, PER_TICK])
def test_one_that_does_not_wait_is_restored_with_what_it_knew(ticks):
    seen, states = budgeted(hurried(), ticks, (211, 260, 333, 418, 700, 1040))
    assert sum(state.foresight[0] > 0 for state in states) >= 3
    other = hurried()
    for state in states:
        other.restore_state(state)
        assert other.save_state().foresight == state.foresight
        assert budgeted(other, ticks)[0] == seen[state.ticks :]


def through(human, ticks):
    """What is to be the same after a saved state, for so many ticks."""
    seen = []
    for _ in range(ticks):
        human.tick()
        human.look_ahead(PER_TICK)
        seen.append((human.state_hash(), human.save_state().foresight))
    return seen


def test_it_goes_on_alike_after_any_state_in_which_it_was_saved():
    """Also while it knows ticks in which there is nothing to decide, behind an obstacle."""
    human, other = hurried(), hurried()
    states = []
    for _ in range(820):
        states.append(human.save_state())
        human.tick()
        human.look_ahead(PER_TICK)
    assert any(isinstance(event, Cleared) for event in human.events)
    for before, after in zip(states[9::57], states[24::57], strict=False):
        other.restore_state(before)
        through(other, after.ticks - before.ticks)
        assert other.save_state().foresight == after.foresight


@pytest.mark.parametrize("foreseen", [True, False])
@pytest.mark.parametrize("restored", [True, False])
@pytest.mark.parametrize("tick", [45, 150])  # in the middle of a rehearsal, and after it
def test_one_disturbed_just_after_it_was_saved_or_before_goes_on_alike(foreseen, restored, tick):
    """Before, it asks how many ticks ahead it is or not, as a world does."""

    def slower(human):
        human.give_way(0.9, None)

    def goes_on(human):
        assert foreseen is False or human.foresees is None  # for some ticks
        return through(human, 30)

    human, other = hurried(), hurried()
    through(human, tick)
    before = human.save_state()
    assert before.foresight[0] > 100
    if restored:
        human.restore_state(before)
    slower(human)
    after = human.save_state()
    expected = goes_on(human)
    other.restore_state(before)
    slower(other)
    assert goes_on(other) == expected
    other.restore_state(after)
    assert goes_on(other) == expected


def test_who_knows_that_it_will_hold_sets_off_and_who_does_not_know_walks_on():
    human, states = hurried(), []
    while human.gait_now == "walk":
        states.append(human.save_state())
        human.tick()
        human.look_ahead(PER_TICK)
    knowing = states[-3]

    def sets_off(state):
        human.restore_state(state)
        for _ in range(3):
            human.tick()
        return human.gait_now == "run"

    assert sets_off(knowing) and not sets_off(knowing._replace(foresight=(0, 0)))


def test_told_to_stop_it_brakes_at_once_and_better_when_it_has_seen_itself_fall(monkeypatch):
    """In rehearsal only the third way of braking holds, from a moment later on."""

    def holds(self, body):
        yield
        state = body.save_state()
        good = body.on_feet.slowing == pytest.approx(BRAKINGS[2] * body.on_feet.brake_skill.deceleration)
        return (1.0 if good else 0.0), [state]

    monkeypatch.setattr(ComesToRest, "__call__", holds)
    human = running(300)
    human.waits = False
    learned = human.on_feet.brake_skill.deceleration
    human.stop()
    slowing = []
    for _ in range(RECONSIDERS + 2):
        human.tick()
        human.look_ahead(PER_TICK)
        slowing.append(human.on_feet.slowing / learned)
    assert slowing[:RECONSIDERS] == pytest.approx([BRAKINGS[0]] * RECONSIDERS)
    assert slowing[RECONSIDERS:] == pytest.approx([BRAKINGS[2]] * 2)


def test_told_to_stop_it_comes_to_a_stand_within_a_budget():
    human = running(300)
    human.waits = False
    human.stop()
    for _ in range(500):
        human.tick()
        human.look_ahead(PER_TICK)
    assert human.held and human.status == "standing"
