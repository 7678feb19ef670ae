"""A person that rehearses beforehand decides what one does that rehearses at the moment, in lighter ticks."""

import numpy as np
import pytest

from locomotion.body_events import Cleared
from locomotion.human import gait_changes
from locomotion.human.human import Human
from locomotion.human.state import MOVING
from locomotion.rehearsal.choices import BRAKINGS, SLOWINGS
from locomotion.rehearsal.deciding import RECONSIDERS
from locomotion.rehearsal.lookahead import PER_TICK, Lookahead
from locomotion.rehearsal.predicted import Predicted
from locomotion.rehearsal.trials import ComesToRest, Rehearsal
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
    human, made, inside, tick, run = enter(), [], [], Human._tick, Rehearsal.run

    def counted(each):
        if not inside:
            made.append(each is human)
        tick(each)

    def rehearses(self, double):
        steps = run(self, double)
        while True:
            inside.append(self)
            try:
                next(steps)
            except StopIteration as end:
                return end.value
            finally:
                inside.pop()
            yield

    monkeypatch.setattr(Human, "_tick", counted)
    monkeypatch.setattr(Rehearsal, "run", rehearses)
    hashes(human)
    assert human.status == "arrived"
    assert sum(made) < 0.5 * human.ticks  # its own; the double went through the others
    assert len(made) < human.ticks  # besides rehearsals nothing is simulated twice


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


FORGOTTEN = 450  # ticks after which nothing is left of what it knew: more than it is ever ahead


def budgeted(human, ticks, moments=(), most=6000):
    """Hashes of its states, until it ends or for ``most`` ticks, and its states at these ``moments``; it
    rehearses for so many ticks in each of its own."""
    seen, states = [], []
    while human.status in MOVING and len(seen) < most:
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
        goes_on = budgeted(other, ticks, most=FORGOTTEN)[0]
        assert goes_on == seen[state.ticks :][:FORGOTTEN]


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


# --- surprised within a budget: sent to a place so near that it has to slow down at once
NEAR = 8.0  # [m]


def surprised(speed=3.0, ticks=300):
    """A runner that does not wait, and has just been sent to a place near ahead."""
    human = running(ticks, speed)
    human.waits = False
    send(human, NEAR)
    return human


def send(human, ahead):
    """Give it another way, straight on."""
    here = human.position
    human.follow([here, here + np.array([ahead, 0.0, 0.0])], 3.5)


def goes_on(human, ticks=600):
    """What `budgeted` gives, for so many ticks."""
    for _ in range(ticks):
        human.tick()
        human.look_ahead(PER_TICK)
        yield human.state_hash()


def holds_if(holds):
    """A rehearsal that succeeds as ``holds`` says of the body."""

    def trial(body):
        yield
        return (1.0 if holds(body) else 0.0), [body.save_state()]

    return trial


def hold_if(monkeypatch, holds):
    """In rehearsal a way of slowing down holds as ``holds`` says of its deceleration [m/s²]."""
    monkeypatch.setattr(gait_changes, "_WALKS_ON", holds_if(lambda body: holds(body.on_feet.slowing)))


def test_a_surprised_runner_slows_down_at_once_and_otherwise_when_it_has_seen_itself_fall(monkeypatch):
    hold_if(monkeypatch, lambda slowing: slowing == SLOWINGS[2])
    human = surprised()
    slowing = [human.on_feet.slowing for _ in goes_on(human, 2 * RECONSIDERS + 3)]
    assert slowing[: 2 * RECONSIDERS] == [SLOWINGS[0]] * 2 * RECONSIDERS
    assert slowing[2 * RECONSIDERS :] == [SLOWINGS[2]] * 3
    assert human.follower.tried_to_slow == 0 and human.foresees is None  # it knows that this holds


def test_it_brakes_if_no_way_of_slowing_down_holds(monkeypatch):
    hold_if(monkeypatch, lambda _: False)
    human = surprised()
    brakes = [human.on_feet.brakes for _ in goes_on(human, 2 * RECONSIDERS + 1)]
    assert brakes == [False] * 2 * RECONSIDERS + [True]


def test_who_brakes_instead_without_having_rehearsed_that_looks_whether_it_holds(monkeypatch):
    hold_if(monkeypatch, lambda _: False)
    human = surprised()
    for _ in range(2 * RECONSIDERS + 1):
        assert not human.on_feet.brakes
        human.tick()
        human.look_ahead(2)  # enough to see that it falls, and not for a stop
    assert human.on_feet.brakes and human.follower.stops_since == human.ticks and human.decides_soon


def test_who_finds_no_way_of_slowing_down_slows_down_and_looks_again(monkeypatch):
    human, slowing = running(300, 3.0), []
    holds_from = human.ticks + 3 * RECONSIDERS
    later = holds_if(lambda body: body.ticks >= holds_from and body.on_feet.slowing == SLOWINGS[1])
    monkeypatch.setattr(gait_changes, "_WALKS_ON", later)
    monkeypatch.setattr(gait_changes, "ComesToRest", lambda: holds_if(lambda body: False))
    send(human, NEAR)
    for _ in range(5 * RECONSIDERS):
        human.tick()
        slowing.append(human.on_feet.slowing)
    assert SLOWINGS[0] in slowing[: 3 * RECONSIDERS] and slowing[-1] == SLOWINGS[1]


def test_sent_on_meanwhile_it_still_looks_whether_it_stays_up(monkeypatch):
    hold_if(monkeypatch, lambda slowing: slowing == SLOWINGS[2])
    human = surprised()
    for _ in goes_on(human, 10):
        pass
    send(human, NEAR + 1.0)
    slowing = [human.on_feet.slowing for _ in goes_on(human, 2 * RECONSIDERS)]
    assert slowing[0] == SLOWINGS[0] and slowing[-1] == SLOWINGS[2]


@pytest.mark.parametrize("speed", [2.8, 3.6, 4.4])
def test_surprised_runners_arrive(speed):
    """At eight moments of a stride."""
    human = running(260, speed)
    human.waits = False
    for _ in range(8):
        for _ in range(5):
            human.tick()
            human.look_ahead(PER_TICK)
        state = human.save_state()
        send(human, NEAR + 3.0)
        for _ in goes_on(human, 1000):
            if human.status not in MOVING:
                break
        assert human.status == "arrived"
        human.restore_state(state)


def test_a_surprised_runner_is_restored_with_what_it_knew():
    human, states = surprised(), {}
    seen = []
    for each in goes_on(human):
        seen.append(each)
        if len(seen) in (3, 17, 29, 60, 140):
            states[len(seen)] = human.save_state()
    assert any(state.foresight[0] > 0 for state in states.values())
    other = running(1)
    other.waits = False
    for made, state in states.items():
        other.restore_state(state)
        assert list(goes_on(other, 600 - made)) == seen[made:]


def test_at_the_end_of_its_way_it_has_had_time_for_several_ways_of_slowing_down(monkeypatch):
    """A trial takes as long as a real one, and only the third way holds."""

    def trial(body):
        for _ in range(400):
            yield
        return (1.0 if body.on_feet.slowing == SLOWINGS[2] else 0.0), [body.save_state()]

    monkeypatch.setattr(gait_changes, "_WALKS_ON", trial)
    human = running(200, 3.5)
    human.waits = False
    send(human, 30.0)
    slowing = [human.on_feet.slowing for _ in goes_on(human, 800)]
    assert next(filter(None, slowing)) == SLOWINGS[2]


def test_it_says_how_long_the_answer_to_what_it_rehearses_takes_at_least():
    human = hurried()
    assert human.needs == 0
    while not human.needs:
        human.tick()
        human.look_ahead(PER_TICK)
    needs = human.needs
    human.tick()
    assert human.look_ahead(7) == 7 and human.needs == needs - 7
    while human.needs:
        human.tick()
        human.look_ahead(PER_TICK)
        assert 0 <= human.needs <= needs + PER_TICK
    assert human.foresees is None or human.foresees > 0  # it knows, and looks further
