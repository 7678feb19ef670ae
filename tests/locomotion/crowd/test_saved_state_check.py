"""A saved walker that cannot be is refused, and says why."""

from dataclasses import replace

import numpy as np
import pytest

from locomotion.crowd import Crowd
from locomotion.crowd import layout as at
from locomotion.crowd.saved_state_check import check_walker
from locomotion.errors import LocomotionError
from tests.locomotion.crowd.levels import graph_of, hall


def walking():
    crowd = Crowd(hall())
    walker = crowd.add((2.0, 5.0, 0.0))
    walker.go_to([(6.0, 5.0, 0.0), (6.0, 8.0, 0.0)])
    for _ in range(50):
        crowd.tick()
    return walker.save()


def changed(column, value):
    state = walking()
    row = state.row.copy()
    row[column] = value
    return replace(state, row=row)


def test_every_state_of_a_run_is_accepted():
    crowd = Crowd(hall())
    walker = crowd.add((2.0, 5.0, 0.0))
    check_walker(walker.save(), hall())
    walker.go_to([(4.0, 5.0, 0.0)], facing=1.0)
    while walker.status == "walking":
        crowd.tick()
        check_walker(walker.save(), hall())
    walker.lose_ground()
    check_walker(walker.save(), hall())


@pytest.mark.parametrize(
    ("column", "value", "says"),
    [
        (at.CELL, -1.0, "is in cell -1 of .* in mode 1"),
        (at.CELL, 1e6, "is in cell 1000000 of"),
        (at.MODE, at.LED, "is in cell .* in mode 2"),
        (at.X, 9.0, "the distance of a walker from its cell is 6"),
        (at.ROUTE_COUNT, 9.0, "the route of a walker has 3 corners; its row says 9"),
        (at.NEXT, 3.0, "heads for corner 3 of 3"),
        (at.NEXT, 0.0, "heads for corner 0 of 3"),
        (at.FACING, np.inf, "facing"),
        (at.BEST, np.nan, "least length left"),
        (at.RIGHT_UNTIL, np.nan, "right of way"),
        (at.WISH, 0.0, r"number 8 is 0, expected a number from 1e-06"),
    ],
)
def test_a_number_that_cannot_be_is_refused(column, value, says):
    with pytest.raises(LocomotionError, match=says):
        check_walker(changed(column, value), hall())


def test_a_route_without_kinds_or_goals_is_refused():
    state = walking()
    route = state.route.copy()
    route[1, at.VIA] = 0.5
    for wrong, says in (
        (replace(state, route=route), "corners that are neither visited nor cut"),
        (replace(state, route=state.route[:, :-1]), "expected .*, 5"),
        (replace(state, goals=()), "walks without a goal"),
        (replace(state, goals=((0.0, np.inf, 0.0),)), "a goal of a walker is not finite"),
        (replace(state, replans=-1), "replans"),
    ):
        with pytest.raises(LocomotionError, match=says):
            check_walker(wrong, hall())


def test_a_state_of_another_level_is_refused():
    with pytest.raises(LocomotionError, match="in cell"):
        check_walker(walking(), graph_of((0.0, 0.0, 2.0, 2.0, 0.0)))
