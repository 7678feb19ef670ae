import threading

import pytest

from runtime.world.upcoming import Upcoming


def divided(number, by):
    return number / by


def test_each_goes_on_from_what_the_one_before_gave():
    upcoming = Upcoming(divided)
    for by in (2.0, 4.0, 5.0):
        upcoming.begin(80.0, by)
    assert [upcoming.end() for _ in range(3)] == [40.0, 10.0, 2.0]
    upcoming.begin(9.0, 3.0)
    assert upcoming.end() == 3.0


def test_one_that_fails_is_told_when_it_is_taken_and_left_out():
    upcoming = Upcoming(divided)
    for by in (2.0, 0.0, 5.0):
        upcoming.begin(80.0, by)
    assert upcoming.end() == 40.0
    with pytest.raises(ZeroDivisionError):
        upcoming.end()
    assert upcoming.end() == 8.0


def test_work_is_done_in_another_thread_and_what_is_dropped_is_not_taken():
    entered, go_on, threads = threading.Event(), threading.Event(), []

    def make(number, more):
        threads.append(threading.get_ident())
        entered.set()
        assert go_on.wait(60.0)
        return number + more

    upcoming = Upcoming(make)
    upcoming.begin(1, 1)
    upcoming.begin(1, 2)
    assert entered.wait(60.0)  # while this thread goes on
    upcoming.drop()
    upcoming.begin(5, 5)
    go_on.set()
    assert upcoming.end() == 10
    assert len(threads) == 2 and threading.get_ident() not in threads
