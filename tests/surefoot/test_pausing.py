"""Between the pieces of long work the host may do something else, or stop it."""

import threading

import pytest

from surefoot.pausing import interruptible, pause


def test_nothing_happens_without_a_host():
    pause()


def test_the_innermost_host_is_called_until_its_block_ends():
    called = []
    with interruptible(lambda: called.append("outer")):
        pause()
        with interruptible(lambda: called.append("inner")):
            pause()
        pause()
    pause()
    assert called == ["outer", "inner", "outer"]


def test_an_error_of_the_host_stops_the_work_there():
    done = []

    def stop():
        raise TimeoutError

    with pytest.raises(TimeoutError), interruptible(stop):
        done.append("first piece")
        pause()
        done.append("second piece")
    pause()
    assert done == ["first piece"]


def test_another_thread_has_its_own_host():
    called = []
    with interruptible(lambda: called.append("mine")):
        other = threading.Thread(target=pause)
        other.start()
        other.join()
    assert called == []
