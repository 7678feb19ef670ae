"""One process compiles a kernel; others that want it wait and read it."""

import gc
from pathlib import Path
from typing import Any

from numba.core import event as events

from surefoot.kernels.folder import LOCKS

__all__ = ["Turns"]

_PATIENCE = 600.0  # [s] after which a process compiles what another one has not finished


class Turns(events.Listener):
    """The files that this process writes at present, each locked. The lock is the operating system's: it ends
    with the process."""

    def __init__(self) -> None:
        self._locks: dict[Path, Any] = {}
        self._files: dict[Any, list[Path]] = {}
        self._depth, self._collects = 0, False
        events.register("numba:compile", self)

    def take(self, file: Path, kernel: Any) -> None:
        """Wait until nobody else compiles what ``file`` will hold; do not where files cannot be locked."""
        if file in self._locks:
            return
        from filelock import FileLock, Timeout

        # what is locked stays: one that waits for a file that is removed has waited for nothing
        lock = FileLock(file.parent / LOCKS / file.stem)
        try:
            (file.parent / LOCKS).mkdir(exist_ok=True)
            lock.acquire(timeout=_PATIENCE)
        except (OSError, NotImplementedError, Timeout):
            return
        self._locks[file] = lock
        self._files.setdefault(kernel, []).append(file)

    def give_back(self, file: Path) -> None:
        """Whoever waits for ``file`` goes on."""
        lock = self._locks.pop(file, None)
        if lock is not None:
            lock.release()

    def on_start(self, event: events.Event) -> None:
        """Little of what compiling makes is garbage, but the whole program would be searched for it, again
        and again."""
        if self._depth == 0:
            self._collects = gc.isenabled()
            gc.disable()
        self._depth += 1

    def on_end(self, event: events.Event) -> None:
        self._depth -= 1
        if self._depth == 0 and self._collects:
            gc.enable()
        # `Event.is_failed` says the opposite in Numba 0.68
        failed = event._exc_details is not None and event._exc_details[0] is not None
        assert event.data is not None
        files = self._files.pop(event.data["dispatcher"], ())
        for file in files if failed else ():
            self.give_back(file)
