"""Distribute uses over processes: each takes the next one, and loads what the others have compiled."""

import os
import subprocess
import sys
from collections import deque
from collections.abc import Callable, Mapping
from pathlib import Path
from queue import SimpleQueue
from threading import Thread

import numba

from surefoot.compile_notice import counted
from surefoot.kernels.cache import used
from surefoot.kernels.folder import cache_folder

__all__ = ["run_shared"]


def run_shared(uses: Mapping[str, Callable[[], None]], told: Callable[[int, str], object]) -> set[str]:
    """Run ``uses`` in as many processes as there are cores, and in this one those that fail there.
    ``told(count, what)`` is called in this thread with the number of kernels compiled so far, and for
    what. Returns the names of the files of all kernels that they used.
    """
    waiting = deque(uses)
    count, files = 0, set[str]()
    if _can_share():
        news: SimpleQueue[tuple[str, str]] = SimpleQueue()
        helpers = [_Helper(waiting, news) for _ in range(min(_cores(), len(uses)))]
        failed = []
        try:
            running = len(helpers)
            while running:
                kind, what = news.get()
                running -= kind == "end"
                if kind == "compiled":
                    count += 1
                    told(count, what)
                elif kind == "used":
                    files.add(what)
                elif kind == "failed":
                    failed.append(what)
        finally:
            for helper in helpers:
                helper.process.kill()
                helper.process.wait()
        waiting.extend(failed)
    for what in waiting:
        told(count, what)
        with counted(lambda more, before=count, what=what: told(before + more, what)):
            uses[what]()
    return files | used()


def _can_share() -> bool:
    """Whether this Python can be started again, and its compiled code is cached."""
    executable = Path(sys.executable or "").name.lower()
    return _cores() > 1 and cache_folder() is not None and executable.startswith(("python", "pypy"))


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class _Helper(Thread):
    """A process that runs uses from ``waiting`` until none is left, and the thread that reports its ``news``:
    ("compiled" or "failed", use), ("used", file), finally ("end", "")."""

    def __init__(self, waiting: deque[str], news: SimpleQueue[tuple[str, str]]) -> None:
        super().__init__(daemon=True)
        self._waiting, self._news = waiting, news
        place = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
        if numba.config.CACHE_DIR:  # type: ignore[attr-defined]
            place["NUMBA_CACHE_DIR"] = numba.config.CACHE_DIR  # type: ignore[attr-defined]
        self.process = subprocess.Popen(
            [sys.executable, "-m", "runtime.warmup.helper"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=place,
        )  # fmt: skip
        self.start()

    def run(self) -> None:
        assert self.process.stdin is not None and self.process.stdout is not None
        try:
            while self._waiting:
                what = self._waiting.popleft()
                if not self._has_run(what):
                    self._news.put(("failed", what))
                    break
        except IndexError:  # another process took the last
            pass
        finally:
            self._news.put(("end", ""))

    def _has_run(self, what: str) -> bool:
        assert self.process.stdin is not None and self.process.stdout is not None
        try:
            print(what, file=self.process.stdin, flush=True)
        except OSError:
            return False
        for line in self.process.stdout:
            if line == "done\n":
                return True
            kind, _, name = line.strip().partition(" ")
            self._news.put((kind, name or what))
        return False
