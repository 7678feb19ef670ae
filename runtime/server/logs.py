"""A log that clients cannot fill."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["Sparing", "sparing"]

_MOST, _EVERY = 10, 60.0  # entries per so many seconds
_LOGS = ("surefoot.serve", "asyncio")  # asyncio logs each message to a lost connection


class Sparing(logging.Filter):
    """Passes `_MOST` entries of a log per `_EVERY` seconds; the next one afterwards reports how many were
    dropped."""

    def __init__(self) -> None:
        super().__init__()
        self._begun, self._count = -_EVERY, 0

    def filter(self, record: logging.LogRecord) -> bool:
        if record.created - self._begun >= _EVERY:
            left_out = max(self._count - _MOST, 0)
            self._begun, self._count = record.created, 0
            if left_out:
                text = f"{record.getMessage()} ({left_out} more entries were dropped before this one)"
                record.msg, record.args = text, ()
        self._count += 1
        return self._count <= _MOST


@contextmanager
def sparing() -> Iterator[None]:
    """Within the block, limit the server's logs."""
    filters = [(logging.getLogger(name), Sparing()) for name in _LOGS]
    for log, each in filters:
        log.addFilter(each)
    try:
        yield
    finally:
        for log, each in filters:
            log.removeFilter(each)
