"""Work done in pieces, while its caller does other things in between.

The work runs in its own thread, but never at the same time as the thread that resumes it: the two alternate.
So it may use the same data and needs no locks.
"""

import threading
from collections.abc import Callable
from typing import Any

from surefoot.pausing import interruptible

__all__ = ["Abandoned", "Worker"]


class Abandoned(BaseException):
    """The work is no longer wanted; raised where it was interrupted."""


class Worker:
    """Does one job after another, each in pieces. Call `end` when there are no more.

    ``result`` is what the last job returned, ``error`` what it raised.
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
        """Accept a job; `go_on` runs it."""
        self._work, self.result, self.error = work, None, None

    def go_on(self) -> bool:
        """Do the next piece. Returns whether there is more to do."""
        self._turn.release()
        self._back.acquire()
        return self._work is not None

    def abandon(self) -> None:
        """Stop the job where it is."""
        self._abandoned = True
        while self.go_on():  # its clean-up may have more pieces
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
