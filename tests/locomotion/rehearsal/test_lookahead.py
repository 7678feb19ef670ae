"""A person that rehearses beforehand decides what one does that rehearses at the moment, in lighter ticks."""

import pytest

from locomotion.human.human import Human
from locomotion.human.state import MOVING
from locomotion.rehearsal.lookahead import Lookahead
from locomotion.rehearsal.predicted import Predicted
from runtime.evaluation.courses import enter_course, make_course

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
    monkeypatch.setattr(Lookahead, "go_on", lambda *_: None)
    assert foreseeing == hashes(enter(), disturb)
    monkeypatch.setattr(Predicted, "comes_true", lambda *_: False)
    assert foreseeing == hashes(enter(), disturb)


def test_what_the_double_went_through_is_not_simulated_again(monkeypatch):
    human, made, tick = enter(), [], Human._tick
    monkeypatch.setattr(Human, "_tick", lambda each: (made.append(each is human), tick(each)))
    hashes(human)
    assert human.status == "arrived" and sum(made) < 0.5 * human.ticks and len(made) < 2.5 * human.ticks


def test_no_tick_bears_a_whole_rehearsal(monkeypatch):
    made = [0]
    tick = Human._tick

    def counted(human):
        made[0] += 1
        tick(human)

    monkeypatch.setattr(Human, "_tick", counted)

    def most(human):
        result = 0
        while human.status in MOVING and human.time < 60.0:
            made[0] = 0
            human.tick()
            result = max(result, made[0])
        assert human.status == "arrived"
        return result

    beforehand = most(enter())
    monkeypatch.setattr(Lookahead, "go_on", lambda *_: None)
    assert beforehand <= 50 and most(enter()) > 300


def test_a_restored_person_goes_on_as_before():
    human = enter()
    for _ in range(230):
        human.tick()
    state = human.save_state()
    first = hashes(human)
    human.restore_state(state)
    assert first == hashes(human)
