"""One process compiles a kernel; others that need it wait and load it."""

import gc
from pathlib import Path
from typing import Any

from numba.core import event as events

from surefoot.kernels.folder import LOCKS

__all__ = ["Turns"]

_PATIENCE = 600.0  # [s] after which a process stops waiting and compiles the kernel itself


class Turns(events.Listener):
    """Files that this process is writing, each locked. The operating system releases the lock when the
    process ends."""

    def __init__(self) -> None:
        self._locks: dict[Path, Any] = {}
        self._files: dict[Any, list[Path]] = {}
        self._depth, self._collects = 0, False
        events.register("numba:compile", self)

    def take(self, file: Path, kernel: Any) -> None:
        """Wait until no other process is compiling ``file``; does not wait where files cannot be locked."""
        if file in self._locks:
            return
        from filelock import FileLock, Timeout

        # never remove a lock file: processes waiting for it would hold different locks
        lock = FileLock(file.parent / LOCKS / file.stem)
        try:
            (file.parent / LOCKS).mkdir(exist_ok=True)
            lock.acquire(timeout=_PATIENCE)
        except (OSError, NotImplementedError, Timeout):
            return
        self._locks[file] = lock
        self._files.setdefault(kernel, []).append(file)

    def give_back(self, file: Path) -> None:
        """Let processes that wait for ``file`` continue."""
        lock = self._locks.pop(file, None)
        if lock is not None:
            lock.release()

    def on_start(self, event: events.Event) -> None:
        """Compiling creates little garbage, but makes the collector scan the whole program again and
        again."""
        if self._depth == 0:
            self._collects = gc.isenabled()
            gc.disable()
        self._depth += 1

    def on_end(self, event: events.Event) -> None:
        self._depth -= 1
        if self._depth == 0 and self._collects:
            gc.enable()
        # `Event.is_failed` is inverted in Numba 0.68
        failed = event._exc_details is not None and event._exc_details[0] is not None
        assert event.data is not None
        files = self._files.pop(event.data["dispatcher"], ())
        for file in files if failed else ():
            self.give_back(file)
