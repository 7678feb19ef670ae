"""Long work that can be interrupted between short pieces.

Long functions call `pause` between pieces. It does nothing, unless the host has registered a callback::

    with interruptible(serve_others):
        world.step(1.0)

The callback must not touch the world that is being stepped, which is in the middle of its work.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

__all__ = ["interruptible", "pause"]


def _nothing() -> None:
    pass


_meanwhile: ContextVar[Callable[[], None]] = ContextVar("meanwhile", default=_nothing)


def pause() -> None:
    """Let the host run its callback, if any."""
    _meanwhile.get()()


@contextmanager
def interruptible(meanwhile: Callable[[], None]) -> Iterator[None]:
    """Within the block, call ``meanwhile`` between pieces of long work; an error that it raises stops the
    work there."""
    token = _meanwhile.set(meanwhile)
    try:
        yield
    finally:
        _meanwhile.reset(token)
