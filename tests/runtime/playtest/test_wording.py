"""The sentences of a report say where, what and how much, and what the body can do."""

import numpy as np
import pytest
import trimesh

from runtime.playtest.character import character_of
from runtime.playtest.openings import Barrier
from runtime.playtest.wording import Wording, place, triple
from tests.runtime.playtest.levels import box, unreached


def test_what_is_too_low_for_a_skill_is_said_with_its_range():
    low = trimesh.util.concatenate([box(0, 20, 0, 12, -1, 0), box(12, 20, 0, 12, 0, 0.45)])
    (fault,) = (each for each in unreached(low, body="human") if each.kind == "one_way")
    least, most = character_of("human").skills["drop"]
    assert f"0.45 m down; a person drops {least:.2f} to {most:.2f} m" in fault.text


AT = np.array([1.04, -0.04, 2.0])


def test_places_are_rounded_and_have_no_negative_zero():
    assert place(AT) == "(1.0, 0.0, 2.0)"
    assert triple([1.006, -0.001, 2]) == (1.01, 0.0, 2.0)


@pytest.mark.parametrize(
    ("kind", "size", "sentence"),
    [
        ("narrow", 0.5, "the passage at (1.0, 0.0, 2.0) is 0.50 m wide; a person needs 0.60 m"),
        ("low", 1.7, "the passage at (1.0, 0.0, 2.0) is 1.70 m high; a person needs 1.90 m"),
        ("steep", 50.0, "the slope at (1.0, 0.0, 2.0) is 50° steep; a person walks up to 20°"),
        ("wall", 0.3, "a wall stands between it and the floor beside it at (1.0, 0.0, 2.0)"),
        ("passes", np.inf, "the passage at (1.0, 0.0, 2.0) is wide enough, and a person needs 0.60 m, "
                           "but the graph has lost it"),
    ],
)  # fmt: skip
def test_what_is_in_the_way_is_told_with_what_the_body_needs(kind, size, sentence):
    assert Wording(character_of("walker")).barrier(Barrier(kind, size, AT, np.array([AT, AT]))) == sentence


def test_a_gap_that_the_body_can_leap_lacks_room_for_it():
    person, dog = Wording(character_of("human")), Wording(character_of("dog"))
    assert person.leaps(1.0) == "a person leaps that only where there is room to run up and to land"
    assert person.leaps(9.0).startswith("a person leaps 0.") and dog.leaps(1.0) == "a dog does not leap gaps"


def test_a_ledge_is_told_from_the_side_that_one_stands_on():
    words = Wording(character_of("walker"))
    up, down = (words.barrier(Barrier("rise", size, AT, np.array([AT, AT]))) for size in (2.5, -2.5))
    assert up.startswith(
        "its lowest edge, at (1.0, 0.0, 2.0), is 2.50 m above the floor beside it; a person steps"
    )
    assert down.startswith("its edge at (1.0, 0.0, 2.0) is 2.50 m below the floor beside it; a person ")


def test_a_part_near_nothing_is_told_so():
    said = Wording(character_of("walker")).unreachable(AT, 12.4, None)
    assert said.startswith("the part of 12 m² around (1.0, 0.0, 2.0) cannot be reached: nothing ")
