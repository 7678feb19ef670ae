"""Tell the user when kernels are compiled, which takes minutes, once per machine."""

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from numba.core import event as events

from surefoot.kernels.dependencies import PACKAGES

__all__ = ["TIME", "announce", "counted"]

TIME = "1 to 4 minutes"
"""How long compiling all kernels takes."""

_log = logging.getLogger("surefoot")


class _Listener(events.Listener):
    """Calls ``told`` whenever one of our kernels is about to be compiled."""

    def __init__(self, told: Callable[[], None]) -> None:
        self._told = told

    def on_start(self, event: events.Event) -> None:
        assert event.data is not None
        kernel = event.data["dispatcher"].py_func
        if kernel.__module__.partition(".")[0] in PACKAGES:
            self._told()

    def on_end(self, event: events.Event) -> None:
        pass


class _Announcer:
    """Logs one line to "surefoot" before the first kernel of the process is compiled. The log goes to
    standard error unless the host redirects it."""

    def __init__(self) -> None:
        self.silent = False
        self._listener = _Listener(self._say)
        events.register("numba:compile", self._listener)

    def _say(self) -> None:
        if not self.silent:
            self.silent = True
            _log.warning(
                "surefoot: compiling kernels, once on this machine: up to %s; runtime.prepare() does it "
                "ahead of time", TIME,
            )  # fmt: skip


_announcer: list[_Announcer] = []


def announce() -> None:
    """Announce the first kernel that this process compiles. Called by the packages."""
    if not _announcer:
        _announcer.append(_Announcer())


@contextmanager
def counted(told: Callable[[int], object]) -> Iterator[None]:
    """Within the block, call ``told(n)`` before the n-th kernel (from 1) is compiled, and log nothing."""
    count = 0

    def one() -> None:
        nonlocal count
        count += 1
        told(count)

    before = [each.silent for each in _announcer]
    for each in _announcer:
        each.silent = True
    listener = _Listener(one)
    events.register("numba:compile", listener)
    try:
        yield
    finally:
        events.unregister("numba:compile", listener)
        for each, silent in zip(_announcer, before, strict=True):
            each.silent = silent
