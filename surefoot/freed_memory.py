"""Memory that was freed, given back to the system."""

import ctypes
import sys
from collections.abc import Callable
from functools import cache

__all__ = ["give_back"]


def give_back() -> None:
    """Let the C library give back to the system what the process has freed.

    glibc keeps freed blocks of up to 32 MB for later: after the build of a large level several hundred
    megabytes, as long as the process lives. Takes milliseconds for each 100 MB. Other C libraries have no
    such call, and nothing happens.
    """
    trim = _trim()
    if trim is not None:
        trim(0)


@cache
def _trim() -> Callable[[int], int] | None:
    if not sys.platform.startswith("linux"):
        return None
    return getattr(ctypes.CDLL(None), "malloc_trim", None)
