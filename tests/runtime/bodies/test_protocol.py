"""What a body need not say of itself, and what is read back of what it has saved."""

from collections import deque

import numpy as np
import pytest

from locomotion.errors import LocomotionError
from runtime.bodies.protocol import Driver, recall, saved_parts
from runtime.errors import RuntimeInputError
from runtime.planning.planning import NoWay, Plan


class Post(Driver):
    """Stands at a place, and has ``left`` [m] to go."""

    left = 1.0
    simulated, time, status, facing, goals_left = None, 0.0, "standing", 0.0, 1
    position = np.zeros(3)

    def __init__(self, *plans):
        self.plans = deque(plans)
        self.stopped = 0

    def transforms(self):
        return np.ones((1, 7))

    def stop(self):
        self.stopped += 1

    def nothing(self, *_):
        raise AssertionError("not asked for here")

    plan = go_to = way_holds = save = restore = state_hash = nothing


def straight(length):
    points = np.array([[0.0, 0.0, 0.0], [length, 0.0, 0.0]])
    return Plan(points, points, points, ())


def test_progress_is_what_is_behind_it_of_its_last_path():
    assert Post(straight(9.0), straight(4.0)).progress == pytest.approx(0.75)
    assert Post().progress == 1.0 == Post(straight(0.0)).progress


def test_one_that_knows_no_other_way_says_so_and_stops_where_it_gives_up():
    post, goals = Post(), np.zeros((1, 3))
    for other_way in (post.go_without, post.go_round):
        with pytest.raises(NoWay, match="it takes no other way"):
            other_way(goals, 1.0, ("crate",))
    assert not post.can_turn and not post.tries_other_ways and post.tag_ahead == ""
    post.give_up("a reason")
    assert post.stopped == 1


def test_one_that_is_drawn_as_it_is_does_not_move_between_ticks():
    assert np.array_equal(Post().transforms_between(0.3), Post().transforms())


def test_what_was_saved_comes_back():
    plans = (straight(1.0), straight(2.0))
    assert saved_parts((5, plans), int) == (5, plans)
    kept = deque([straight(3.0)], maxlen=2)
    recall(kept, plans)
    assert tuple(kept) == plans


@pytest.mark.parametrize(
    ("state", "says"),
    [
        (None, "no int is saved"),
        ((5,), "no int is saved"),
        (("5", ()), "no int is saved"),
        ((5, [straight(1.0)]), "no plans are saved"),
        ((5, (None,)), "no plans are saved"),
    ],
)
def test_anything_else_is_refused(state, says):
    with pytest.raises(RuntimeInputError, match=says):
        saved_parts(state, int)


@pytest.mark.parametrize("name", ["raw", "pulled", "points"])
def test_plans_whose_points_are_none_are_refused(name):
    points = {"raw": np.zeros((2, 3)), "pulled": np.zeros((2, 3)), "points": np.zeros((2, 3))}
    for wrong in (np.full((2, 3), np.nan), np.zeros((2, 2))):
        with pytest.raises(LocomotionError, match=f"the {name} points of a plan"):
            saved_parts((5, (Plan(**{**points, name: wrong}, obstacles=()),)), int)
