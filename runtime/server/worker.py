"""Work that is done a piece at a time, while whoever waits for it does something else in between.

The work runs in a thread of its own, but never at the same time as the one that lets it go on: the two take
turns. So it may use whatever that one uses, and needs no locks.
"""

import threading
from collections.abc import Callable
from typing import Any

from surefoot.pausing import interruptible

__all__ = ["Abandoned", "Worker"]


class Abandoned(BaseException):
    """Nobody wants the work any more: raised where it was interrupted."""


class Worker:
    """Does one work after the other, each a piece at a time. `end` it when there is no more.

    ``result`` is what the last work returned, ``error`` what it raised.
    """

    def __init__(self) -> None:
        self.result: Any = None
        self.error: BaseException | None = None
        self._work: Callable[[], Any] | None = None
        self._abandoned = False
        self._turn, self._back = threading.Lock(), threading.Lock()
        self._turn.acquire()
        self._back.acquire()
        threading.Thread(target=self._live, name="surefoot work", daemon=True).start()

    def begin(self, work: Callable[[], Any]) -> None:
        """Take over a work; `go_on` does it."""
        self._work, self.result, self.error = work, None, None

    def go_on(self) -> bool:
        """Do the next piece. Returns whether there is more to do."""
        self._turn.release()
        self._back.acquire()
        return self._work is not None

    def abandon(self) -> None:
        """End the work where it is."""
        self._abandoned = True
        while self.go_on():  # what it still has to put in order
            pass
        self._abandoned = False

    def end(self) -> None:
        """End the thread; it must have no work."""
        self._turn.release()

    def _pause(self) -> None:
        self._back.release()
        self._turn.acquire()
        if self._abandoned:
            raise Abandoned

    def _live(self) -> None:
        with interruptible(self._pause):
            while True:
                self._turn.acquire()
                if self._work is None:
                    return
                try:
                    self.result = self._work()
                except BaseException as error:
                    self.error = error
                self._work = None
                self._back.release()
