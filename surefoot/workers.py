"""Pools of processes for long work."""

import multiprocessing
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Any, Protocol

__all__ = ["Workers", "worker_pool"]


class Workers(Protocol):
    """What is used of `multiprocessing.pool.Pool`."""

    def map(self, func: Callable[[Any], Any], iterable: Iterable[Any], chunksize: int | None = None) -> list:
        """What ``func`` returns for each."""
        ...

    def imap(self, func: Callable[[Any], Any], iterable: Iterable[Any]) -> Iterator[Any]:
        """The same, one after the other."""
        ...


class _ThisProcess:
    def map(self, func: Callable[[Any], Any], iterable: Iterable[Any], chunksize: int | None = None) -> list:
        return list(map(func, iterable))

    def imap(self, func: Callable[[Any], Any], iterable: Iterable[Any]) -> Iterator[Any]:
        return map(func, iterable)


@contextmanager
def worker_pool(count: int, begin: Callable[..., None], arguments: tuple[Any, ...]) -> Iterator[Workers]:
    """``count`` fresh processes, each after ``begin(*arguments)``, until the block ends. One worker is this
    process: a fresh one takes seconds to import everything.

    Fresh processes leave Ctrl-C, which reaches all processes of a terminal, to this one, which ends them.
    From their very start: they inherit that the signal is ignored.
    """
    if count == 1:
        begin(*arguments)
        yield _ThisProcess()
        return
    is_main = threading.current_thread() is threading.main_thread()
    before = signal.signal(signal.SIGINT, signal.SIG_IGN) if is_main else None
    try:
        pool = multiprocessing.get_context("spawn").Pool(count, begin, arguments)
    finally:
        if is_main:
            signal.signal(signal.SIGINT, before or signal.SIG_DFL)
    with pool:
        yield pool
