"""Independent pieces of a tick, side by side."""

import threading

import pytest

from surefoot.workers.threads import Threads


@pytest.mark.parametrize("threads", [1, 2, 5])
@pytest.mark.parametrize("count", [0, 1, 3, 50])
def test_each_piece_is_done_once(threads, count):
    shared = Threads(threads)
    for _ in range(3):
        done = []
        shared.each(done.append, count)
        assert sorted(done) == list(range(count))


def test_pieces_run_side_by_side():
    both = threading.Barrier(2, timeout=60.0)
    Threads(2).each(lambda _: both.wait(), 2)  # breaks if one waits for the other to end


@pytest.mark.parametrize("wrong", [0, 3])
def test_an_error_ends_it_when_all_others_have_ended(wrong):
    done = []

    def work(number):
        if number == wrong:
            raise ValueError("as it should")
        done.append(number)

    with pytest.raises(ValueError, match="as it should"):
        Threads(3).each(work, 8)
    assert sorted(done) == [number for number in range(8) if number != wrong]
