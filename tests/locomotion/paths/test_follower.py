"""Progress along a path, going back on it and on again."""

import numpy as np
import pytest

from locomotion.human.on_feet import RUN_GAINS
from locomotion.paths.command import COMMAND_SIZE, HEADING_ASKED
from locomotion.paths.follower import PathFollower
from locomotion.paths.tracking import TrackingLimits, make_path
from tests.locomotion.recovery.falling import WAY

WALK = TrackingLimits((0.3, 1.25))
LENGTH = 20.0


def follower(points=((0, 0, 0), (LENGTH, 0, 0)), tick=0):
    made = PathFollower()
    made.begin(make_path(points, 1.25, WALK, 1.25), tick)
    return made


def move(made, x, tick, y=0.0):
    command = np.zeros(COMMAND_SIZE)
    made.track(RUN_GAINS, x, y, 1.25, tick, command)
    return command


def walk(made, start, to, tick, step=0.2):
    """Move along the x axis, so many ticks on."""
    for x in np.arange(start, to + 0.5 * step * np.sign(to - start), step * np.sign(to - start)):
        tick += 1
        move(made, float(x), tick)
    return tick


def test_without_a_path_there_is_nothing_to_follow():
    made = PathFollower()
    assert made.points.shape == (0, 3) and not (made.runs or made.brakes or made.walks_fast)
    assert made.way_back(0.0) is None
    made.go_on_from(np.zeros(3), 5)  # a fall before it was sent anywhere
    assert made.arc == 0.0


def test_it_knows_where_on_its_path_it_is():
    made = follower()
    assert (made.arc, made.remaining, made.ended) == (0.0, LENGTH, False)
    walk(made, 0.0, 7.0, 0)
    command = move(made, 7.0, 40, y=0.3)
    assert made.arc == made.arc_length == pytest.approx(7.0)
    assert made.remaining == pytest.approx(13.0) and made.lateral == pytest.approx(0.3)
    assert command[HEADING_ASKED] < 0.0  # back to it, to the right
    walk(made, 7.0, 20.4, 40)
    assert made.ended
    made.begin(make_path([[0, 0, 0], [0, 5, 0]], 1.25, WALK, 1.25), 99)
    assert made.arc == 0.0 and made.remaining == 5.0 and made.without_headway(99) == 0.0


def test_one_that_slows_down_as_it_has_not_rehearsed_knows_so_on_another_path():
    made, other = follower(), make_path([[0, 0, 0], [0, 5, 0]], 1.25, WALK, 1.25)
    made.tried_to_slow, made.stops_since = 7, 9
    made.begin(other, 20, slows=True)
    assert (made.tried_to_slow, made.stops_since, made.arc) == (7, 9, 0.0)
    made.begin(other, 30)
    assert (made.tried_to_slow, made.stops_since) == (0, 0)


def test_time_without_headway_does_not_count_giving_way():
    made = follower(tick=100)
    tick = walk(made, 0.0, 2.0, 100)
    for x in (2.02, 2.04):
        tick += 50
        move(made, x, tick)  # too little to count
    assert made.without_headway(tick) == pytest.approx(1.0)
    for _ in range(30):
        made.wait()
    assert made.without_headway(tick) == pytest.approx(0.7) and made.waited == pytest.approx(0.3)
    made.make_headway(tick)
    assert made.without_headway(tick + 20) == pytest.approx(0.2)
    walk(made, 2.0, 4.0, tick)
    assert made.waited == 0.0


def test_it_goes_back_along_its_path_and_then_on_to_the_goal():
    made = follower()
    tick = walk(made, 0.0, 8.0, 0)
    made.pace = 0.5
    made.go_back(3.0, WALK, tick)
    assert made.path.goal[:2] == pytest.approx([3.0, 0.0], abs=0.05)
    assert made.remaining == pytest.approx(5.0, abs=0.05) and made.arc_length == pytest.approx(8.0, abs=0.05)
    assert made.points[-1, 0] == LENGTH  # the whole path is still its own
    tick = walk(made, 8.0, 5.0, tick)
    assert made.arc_length == pytest.approx(5.0, abs=0.05)
    tick = walk(made, 5.0, 2.8, tick)
    assert made.ended
    made.turn_again(tick)
    assert (made.arc, made.remaining, made.pace) == (3.0, LENGTH - 3.0, 0.5)
    assert made.interrupted is None and made.without_headway(tick) == 0.0


def test_it_makes_room_for_others_twice_and_farther_the_second_time():
    made = follower()
    tick = walk(made, 0.0, 8.0, 0)
    backs = []
    for _ in range(2):
        assert made.way_back(0.0) is not None
        backs.append(made.backs)
        made.make_room(made.backs, WALK, tick)
        assert made.way_back(0.0) is None  # it goes back already
        made.turn_again(tick)
        tick = walk(made, made.back_to, 8.0, tick)
    assert backs == [2.5, 5.0] and made.way_back(0.0) is None


def test_the_way_back_is_its_own_path_backwards():
    made = follower(((0, 0, 0), (5, 0, 0), (5, 15, 3)))
    walk(made, 0.0, 4.0, 0)
    way = made.way_back(1.0)
    assert way[0] == pytest.approx([4.0, 0.0, 0.0], abs=0.01)
    assert way[-1, 0] == pytest.approx(1.0, abs=0.11) and not way[:, 1].any()
    assert np.diff(way[:, 0]) == pytest.approx(np.full(len(way) - 1, -0.1))
    assert made.way_back(3.6) is None  # hardly any


def test_after_a_fall_it_goes_on_from_the_nearest_point():
    made = follower()
    walk(made, 0.0, 3.0, 0)
    made.go_on_from(np.array([6.2, 1.0, 0.0]), 500)
    assert made.arc == pytest.approx(6.2, abs=0.05) and made.without_headway(500) == 0.0


def test_a_run_up_is_straight_from_the_last_bend_on():
    made = follower(((0, 0, 0), (8, 0, 0), (8, 12, 0)))
    assert made.straight_before(7.0) == 0.0
    assert made.straight_before(18.0) == pytest.approx(8.0, abs=0.35)


def test_a_shift_moves_the_path_ahead_of_it_alone():
    made = follower()
    walk(made, 0.0, 5.0, 0)
    shift = np.zeros((60, 2))
    shift[10:40, 1] = 0.4
    made.shift(shift, WALK, None)
    y = made.points[:, 1]
    at = np.linspace(0.0, LENGTH, len(y))
    assert not y[at < 5.9].any() and y[(at > 6.1) & (at < 8.8)] == pytest.approx(0.4)
    assert made.remaining == pytest.approx(15.0)


def test_who_was_carried_back_along_its_way_has_its_time_to_make_headway():
    way = PathFollower()
    limits = TrackingLimits((0.3, 1.2))
    way.begin(make_path(WAY, 1.0, limits, 0.0), 0)
    for tick in range(2000):
        way.track(np.zeros(6), 0.01 * tick, 0.0, 1.0, tick, np.zeros(4))
    assert way.arc == pytest.approx(19.99)
    way.go_on_from(np.array([6.0, 0.3, 0.0]), 3000)
    assert way.arc == pytest.approx(6.0, abs=0.06)
    for tick in range(3000, 4200):
        way.track(np.zeros(6), 6.0 + 0.01 * (tick - 3000), 0.3, 1.0, tick, np.zeros(4))
        assert way.without_headway(tick) < 0.5
