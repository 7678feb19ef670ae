"""Long work that can be interrupted between its pieces, none of which takes long.

What does much at once calls `pause` between the pieces. That does nothing, unless the host has said what
is to be done there::

    with interruptible(serve_others):
        world.step(1.0)

What it does must not touch the world that is at work: that is in the middle of something.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

__all__ = ["interruptible", "pause"]


def _nothing() -> None:
    pass


_meanwhile: ContextVar[Callable[[], None]] = ContextVar("meanwhile", default=_nothing)


def pause() -> None:
    """Let the host do something else."""
    _meanwhile.get()()


@contextmanager
def interruptible(meanwhile: Callable[[], None]) -> Iterator[None]:
    """Within the block call ``meanwhile`` between the pieces of long work; an error that it raises ends the
    work where it is."""
    token = _meanwhile.set(meanwhile)
    try:
        yield
    finally:
        _meanwhile.reset(token)
