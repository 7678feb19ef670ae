"""Long work on several processors, or in this process if there is one worker."""

import os
import signal

import pytest

from surefoot.workers.pool import worker_pool

BASE = {"of": 0}


def begin(base):
    BASE["of"] = base


def shifted(number):
    return BASE["of"] + number


def who_and_interrupts(_):
    return os.getpid(), signal.getsignal(signal.SIGINT) is signal.SIG_IGN


def fail(_):
    raise OSError("full")


def test_one_worker_is_this_process():
    with worker_pool(1, begin, (10,)) as workers:
        assert workers.map(shifted, [1, 2]) == [11, 12]
        assert list(workers.imap(shifted, (3, 4))) == [13, 14]
        assert workers.map(who_and_interrupts, [0]) == [(os.getpid(), False)]
    begin(0)


def test_several_are_begun_each_and_leave_interrupts_to_this_process():
    before = signal.getsignal(signal.SIGINT)
    with worker_pool(2, begin, (10,)) as workers:
        assert signal.getsignal(signal.SIGINT) is before
        assert workers.map(shifted, range(6)) == [10, 11, 12, 13, 14, 15]
        assert list(workers.imap(shifted, (3, 4))) == [13, 14]
        for process, ignored in workers.map(who_and_interrupts, range(4)):
            assert process != os.getpid() and ignored
        with pytest.raises(OSError, match="full"):
            workers.map(fail, [0])
    assert BASE["of"] == 0
