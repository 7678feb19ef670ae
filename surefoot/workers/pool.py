"""Workers for long work, wherever they are."""

import multiprocessing
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Any, Protocol

__all__ = ["Place", "Workers", "spared_ctrl_c", "worker_pool"]

Place = int | str
"""Where the workers are: a number of processes on this machine, or the address of a Dask scheduler, see
`surefoot.workers.cluster`."""


class Workers(Protocol):
    """What workers do. Results come in the order of the items, whoever worked on them."""

    def map(self, func: Callable[[Any], Any], iterable: Iterable[Any], chunksize: int | None = None) -> list:
        """Results of ``func`` for each item. ``chunksize``: items that a process takes at once."""
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
def worker_pool(place: Place, begin: Callable[..., None], arguments: tuple[Any, ...]) -> Iterator[Workers]:
    """Workers at ``place``, each process initialised by ``begin(*arguments)``, until the block ends.

    A single one is this process, since a new one takes seconds to import everything. Raises
    `surefoot.workers.cluster.ClusterError` for a cluster that cannot be used.
    """
    if isinstance(place, str):
        from surefoot.workers.cluster import cluster_pool

        with cluster_pool(place, begin, arguments) as workers:
            yield workers
    elif place == 1:
        begin(*arguments)
        yield _ThisProcess()
    else:
        with _processes(place, begin, arguments) as pool:
            yield pool


def _processes(count: int, begin: Callable[..., None], arguments: tuple[Any, ...]) -> Any:
    with spared_ctrl_c():
        return multiprocessing.get_context("spawn").Pool(count, begin, arguments)


@contextmanager
def spared_ctrl_c() -> Iterator[None]:
    """Processes that are started in this block ignore Ctrl-C, which a terminal sends to all processes; who
    started them ends them. They inherit that from the start."""
    is_main = threading.current_thread() is threading.main_thread()
    before = signal.signal(signal.SIGINT, signal.SIG_IGN) if is_main else None
    try:
        yield
    finally:
        if is_main:
            signal.signal(signal.SIGINT, before or signal.SIG_DFL)
