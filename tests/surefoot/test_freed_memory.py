"""What was freed does not count as the process's memory any more."""

import numpy as np
import psutil
import pytest

from surefoot import freed_memory
from surefoot.freed_memory import give_back


@pytest.mark.skipif(freed_memory._trim() is None, reason="this C library has no such call")
def test_freed_blocks_between_others_are_given_back():
    # of 60 kB each, less than what the C library hands out by the page: every second one stays
    blocks = dict(enumerate(np.ones((60_000,), np.uint8) for _ in range(4000)))
    for k in range(0, 4000, 2):
        del blocks[k]
    before = psutil.Process().memory_info().rss
    give_back()
    assert psutil.Process().memory_info().rss < before - 80e6
    assert all(block.all() for block in blocks.values())


def test_nothing_happens_where_there_is_no_such_call(monkeypatch):
    monkeypatch.setattr(freed_memory, "_trim", lambda: None)
    give_back()
