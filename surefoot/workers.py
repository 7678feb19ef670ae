"""Process pools for long work."""

import multiprocessing
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Any, Protocol

__all__ = ["Workers", "worker_pool"]


class Workers(Protocol):
    """The methods of `multiprocessing.pool.Pool` that we use."""

    def map(self, func: Callable[[Any], Any], iterable: Iterable[Any], chunksize: int | None = None) -> list:
        """Results of ``func`` for each item."""
        ...

    def imap(self, func: Callable[[Any], Any], iterable: Iterable[Any]) -> Iterator[Any]:
        """Like `map`, one item after the other."""
        ...


class _ThisProcess:
    def map(self, func: Callable[[Any], Any], iterable: Iterable[Any], chunksize: int | None = None) -> list:
        return list(map(func, iterable))

    def imap(self, func: Callable[[Any], Any], iterable: Iterable[Any]) -> Iterator[Any]:
        return map(func, iterable)


@contextmanager
def worker_pool(count: int, begin: Callable[..., None], arguments: tuple[Any, ...]) -> Iterator[Workers]:
    """``count`` new processes, each initialised by ``begin(*arguments)``, until the block ends. A single
    worker is this process, since a new one takes seconds to import everything.

    New processes ignore Ctrl-C, which a terminal sends to all processes; this one ends them. They inherit
    that from the start.
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
