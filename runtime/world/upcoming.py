"""Changes that are worked out in a thread of their own, and taken when it is their turn.

Whoever takes one waits until it is done, so what is taken, and when, does not depend on how fast the machine
is.
"""

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Generic, NamedTuple, TypeVar

__all__ = ["Upcoming"]

_State = TypeVar("_State")
_Change = TypeVar("_Change")


class _Made(NamedTuple, Generic[_State]):
    """What a change gave; or what there was before, and the ``error`` that it raised."""

    state: _State
    error: Exception | None = None


class Upcoming(Generic[_State, _Change]):
    """Changes that have begun, in their order: ``make(state, change)`` gives the state after one, from that
    which the one before gave. It is called in the thread, and must not touch what others change meanwhile."""

    def __init__(self, make: Callable[[_State, _Change], _State]) -> None:
        self._make = make
        self._work: deque[Future[_Made[_State]]] = deque()
        self._pool: ThreadPoolExecutor | None = None

    def begin(self, now: _State, change: _Change) -> None:
        """Work out a ``change`` of what there is ``now``, after all others that have begun."""
        if self._pool is None:
            self._pool = ThreadPoolExecutor(1, "upcoming changes")
        before = self._work[-1] if self._work else None
        self._work.append(self._pool.submit(self._made, now, before, change))

    def end(self) -> _State:
        """What the first of them gives, as soon as it is done. Raises what working it out raised; those after
        it then go on from what was before it."""
        made = self._work.popleft().result()
        if made.error is not None:
            raise made.error
        return made.state

    def drop(self) -> None:
        """Forget all of them."""
        for work in self._work:
            work.cancel()
        self._work.clear()

    def _made(self, now: _State, before: Future[_Made[_State]] | None, change: _Change) -> _Made[_State]:
        state = now if before is None else before.result().state
        try:
            return _Made(self._make(state, change))
        except Exception as error:  # told when it is taken
            return _Made(state, error)
