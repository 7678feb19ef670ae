"""Arrays in memory that others have had before."""

import threading

import numpy as np
import pytest

from surefoot import reused_memory
from surefoot.reused_memory import empty

MANY = 3_000_000


@pytest.mark.parametrize(
    ("shape", "dtype"), [(MANY, np.int32), ((MANY, 4), np.uint8), (7, np.float64), (0, "u1")]
)
def test_arrays_are_as_numpy_makes_them(shape, dtype):
    made, expected = empty(shape, dtype), np.empty(shape, dtype)
    assert made.shape == expected.shape and made.dtype == expected.dtype
    assert made.flags.c_contiguous and made.flags.aligned and made.flags.writeable


def test_memory_is_used_again_when_nobody_looks_at_it_any_longer():
    kept, one = empty(MANY), empty(MANY)
    where, view = one.ctypes.data, one[5:]
    del one
    view[:] = 1.0
    other = empty(MANY)
    other[:] = 2.0
    assert other.ctypes.data != where and (view == 1.0).all()
    del view
    assert empty((MANY - 9,), np.int64).ctypes.data == where
    assert len(kept) == MANY


def test_no_more_memory_waits_than_is_in_use():
    kept = [empty(MANY) for _ in range(2)]
    others = [empty(MANY) for _ in range(5)]
    addresses = {array.ctypes.data for array in others}
    del others
    assert sum(empty(MANY).ctypes.data in addresses for _ in range(1)) == 1
    assert sum(map(len, reused_memory._waiting.values())) <= len(kept)
    del kept
    assert not reused_memory._waiting


def test_several_threads_never_share_memory():
    def work(number):
        for turn in range(50):
            array = empty(200_000 + number)
            array[:] = number + turn
            wrong.append(not (array == number + turn).all())

    wrong = []
    kept = empty(MANY)
    threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(wrong) == 200 and not any(wrong) and len(kept) == MANY
