"""What is kept of a recorded person."""

from dataclasses import fields, replace

import pytest

from locomotion import LocomotionError
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.person_state import Errand, digest
from locomotion.recorded_people.saved_state_check import check_recorded
from tests.locomotion.recorded_people.test_people import crowd_of, played


def test_a_saved_person_goes_on_the_same_way_and_a_damaged_one_is_refused():
    people, (ada, bob) = crowd_of(2)
    ada.go_to([(9.0, 5.0, 0.0)], 1.4, None)
    bob.take("kneel", "rifle", "deployed")
    played(people, ada, 1.3)
    saved = [person.save() for person in (ada, bob)]
    ends = set()
    for _ in range(2):
        played(people, ada, 1.0)
        ends.add((ada.state_hash(), bob.state_hash(), ada.qpos.tobytes(), bob.qpos.tobytes()))
        for person, state in zip((ada, bob), saved, strict=True):
            person.restore(state)
    assert len(ends) == 1
    for state in saved:
        check_recorded(state, people.graph, len(people.gaits), people.skills)
    row, late = saved[0].row.copy(), saved[0].row.copy()
    row[at.GAIT], late[at.LATE] = 7.0, -0.01
    playing = saved[1].playback
    for wrong in (
        replace(saved[0], row=row),
        replace(saved[0], row=late),
        replace(saved[0], wanted="fly"),
        replace(saved[1], playback=None, wanted=""),
        replace(saved[1], playback=replace(playing, arc=400)),
        replace(saved[1], playback=replace(playing, begun=float("nan"))),
    ):
        with pytest.raises(LocomotionError):
            check_recorded(wrong, people.graph, len(people.gaits), people.skills)


def test_the_digest_tells_of_everything_but_when_the_person_is_drawn():
    people, (ada,) = crowd_of(1)
    ada.take("kneel", "rifle", "deployed")
    played(people, ada, 1.0)
    state = ada.save()
    assert state.playback is not None
    row = state.row.copy()
    row[at.LATE] = 0.01
    others = {
        "row": row,
        "playback": replace(state.playback, begun=0.5),
        "wanted": "stand",
        "errand": Errand(((1.0, 2.0, 0.0),), 1.4, None),
    }
    digests = {name: digest(replace(state, **{name: value}), "") for name, value in others.items()}
    assert len({digest(state, ""), digest(state, "elsewhere"), *digests.values()}) == len(others) + 2
    assert digest(replace(state, turn=0.7), "") == digest(state, "")
    assert {field.name for field in fields(state)} == {*others, "body", "crossing", "turn"}
