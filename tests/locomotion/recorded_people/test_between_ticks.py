"""Whose turn it is among recorded people, and where they are between their bodies' ticks."""

import numpy as np

from locomotion.crowd import layout as body
from locomotion.recorded.skeletons import LOW
from locomotion.recorded_people.between_ticks import take_turns
from tests.locomotion.recorded_people.test_people import crowd_of


def test_bodies_move_in_turns_of_which_each_has_a_third_of_them():
    people, persons = crowd_of(8)
    for person in persons:
        person.go_to([(16.0 + 0.1 * person.index, 6.0, 0.0)], 1.3, None)
    people.remove(persons.pop(4))
    persons.append(people.add((2.0, 2.0, 0.0), 0.0, LOW, np.random.default_rng(9)))
    for _ in range(12):
        ages = people.crowd.rows[:, body.AGE].copy()
        for _ in range(3):
            before = people.crowd.rows[:, body.AGE].copy()
            people.tick()
            assert (people.crowd.rows[:, body.AGE] - before).sum() in (2.0, 3.0)
        assert (people.crowd.rows[:, body.AGE] == ages + 1.0).all()


def test_figures_go_evenly_between_their_bodies_ticks():
    people, persons = crowd_of(3, LOW)
    for person in persons:
        person.go_to([(16.0, 2.0 + 3.0 * person.index, 0.0)], 1.4, None)
    for _ in range(200):
        people.tick()
    places = []
    for _ in range(12):
        people.tick()
        places.append([person.position for person in persons])
    gone = np.linalg.norm(np.diff(places, axis=0), axis=2)
    assert (np.abs(gone - 0.014) < 5e-4).all()
    discs = people.discs()
    assert np.array_equal(discs[:, :3], places[-1]) and np.array_equal(discs[:, 3:5], people.crowd.velocities)
    assert (discs[:, 5] == people.crowd.radii).all()


def test_everybody_has_a_turn_in_so_many_ticks():
    people, persons = crowd_of(5)
    persons[3].take("kneel", "", "stowed")
    had, rows = np.zeros(5), people.rows.copy()
    turns, apart = np.empty(5, np.bool_), np.empty(5, np.bool_)
    for _ in range(6):
        take_turns(rows, people.crowd.rows, people.crowd.origin, 3, turns, apart)
        had += turns
        assert 1 <= turns.sum() <= 2
    assert (had == 2.0).all() and apart.tolist() == [False, False, False, True, False]
