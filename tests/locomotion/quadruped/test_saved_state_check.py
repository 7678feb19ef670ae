"""A saved animal that cannot be is refused, and says why."""

from dataclasses import replace

import numpy as np
import pytest

from locomotion import LocomotionError
from locomotion.quadruped import layout as at
from locomotion.quadruped import load_body
from locomotion.quadruped.orders import Errand
from locomotion.quadruped.saved_state_check import check_animal
from tests.locomotion.quadruped.scenes import animal_on, plane, run

DOG = load_body("dog")


@pytest.fixture(scope="module")
def running():
    animal = animal_on(plane())
    animal.go_to([(3.0, 0.3, 0.0), (5.0, 0.5, 0.0)], 1.2, facing=0.5)
    for _ in range(150):
        animal.herd.tick()
        animal.tick()
    return animal.save()


def with_herd(memory, **changes):
    return replace(memory, herd=replace(memory.herd, **changes))


def with_row(memory, column, value):
    row = memory.herd.row.copy()
    row[column] = value
    return with_herd(memory, row=row)


def test_its_orders_are_kept_with_what_became_of_them(running):
    assert running.errand == Errand(((3.0, 0.3, 0.0), (5.0, 0.5, 0.0)), 1.2, 0.5)
    assert (running.phase, running.status, running.ticks) == ("following", "running", 150)
    assert len(running.ways) == 2


def test_every_state_of_a_run_with_a_turn_and_a_short_move_is_accepted():
    animal = animal_on(plane(), yaw=2.5)
    check_animal(animal.save(), DOG)
    for goal in ((3.0, 0.5, 0.0), (3.3, 0.7, 0.0)):
        animal.go_to(goal, 1.2)
        phases = set()

        def look(seen=phases):
            if animal.herd.state[animal.index, at.FIRST_TICK] == 0.0:
                memory = animal.save()
                seen.add(memory.phase)
                check_animal(memory, DOG)

        run(animal, each=look)
        assert phases & {"turning", "flexing", "following", "moving"}


@pytest.mark.parametrize(
    ("column", "value", "says"),
    [
        (at.MODE, 3.0, r"number 0 is 3, expected a whole number from 0 to 2"),
        (at.GAIT_NOW, 99.0, "the row of an animal: number 15 is 99"),
        (at.CRUMBS, 513.0, "number 66 is 513, expected a whole number from 0 to 512"),
        (at.YAW, np.nan, "number 29 is nan"),
        (at.ROW_COUNT, 7.0, "the motion of an animal has .* rows"),
        (at.ROW_STEP, 0.0, "an animal moves by .* rows, 0 apart"),
        (at.WAY, 0.0, "an animal moves by"),
        (at.MODE, at.STANDING, "follows a trail that it is not on"),
    ],
)
def test_a_number_that_cannot_be_is_refused(running, column, value, says):
    with pytest.raises(LocomotionError, match=says):
        check_animal(with_row(running, column, value), DOG)


def test_parts_that_do_not_fit_are_refused(running):
    feet = running.herd.feet.copy()
    swings, tempo = feet.copy(), feet.copy()
    swings[1, at.IN_SWING], tempo[2, at.TEMPO] = 0.5, 0.0
    goal = replace(running.errand, goals=((0.0, np.nan, 0.0),))
    for wrong, says in (
        (with_herd(running, body="cat"), "belongs to a cat, not to a dog"),
        (with_herd(running, feet=feet[:3]), "the feet of an animal"),
        (with_herd(running, feet=swings), "neither stands nor swings"),
        (with_herd(running, feet=tempo), "at no place in its stride"),
        (with_herd(running, crumbs=running.herd.crumbs[1:]), "the crumbs of an animal"),
        (replace(running, errand=goal), "a goal of an animal is not finite"),
        (
            replace(running, errand=replace(running.errand, speed=0.0)),
            "the speed that an animal was told is 0",
        ),
        (replace(running, errand=replace(running.errand, gait="crawl")), "valid: walk"),
        (replace(running, errand=replace(running.errand, backed=-1)), "a count of an animal is -1"),
        (replace(running, trail=None), "an animal follows no trail"),
        (replace(running, ways=()), "an animal follows no trail"),
        (replace(running, errand=Errand()), "on more ways than it has goals"),
        (replace(running, trail=replace(running.trail, step=0.0)), "the spacing of a trail is 0"),
    ):
        with pytest.raises(LocomotionError, match=says):
            check_animal(wrong, DOG)
