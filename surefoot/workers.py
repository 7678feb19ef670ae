"""Pools of processes for long work."""

import multiprocessing
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing.pool import Pool
from typing import Any

__all__ = ["worker_pool"]


@contextmanager
def worker_pool(count: int, begin: Callable[..., None], arguments: tuple[Any, ...]) -> Iterator[Pool]:
    """``count`` fresh processes, each after ``begin(*arguments)``, until the block ends.

    They leave Ctrl-C, which reaches all processes of a terminal, to this one, which ends them. From their
    very start: they inherit that the signal is ignored.
    """
    is_main = threading.current_thread() is threading.main_thread()
    before = signal.signal(signal.SIGINT, signal.SIG_IGN) if is_main else None
    try:
        pool = multiprocessing.get_context("spawn").Pool(count, begin, arguments)
    finally:
        if is_main:
            signal.signal(signal.SIGINT, before or signal.SIG_DFL)
    with pool:
        yield pool
