"""Work of a build that threads share."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from numbers import Integral
from typing import Any, TypeVar

from navmesh.errors import NavmeshError

__all__ = ["MOST", "checked_threads", "in_threads", "shares"]

MOST = 256
_Result = TypeVar("_Result")


def checked_threads(threads: Any) -> int:
    """A number of threads, `MOST` at most: more gain nothing, and the result is the same. Raises
    `NavmeshError` for anything but a whole number of at least 1."""
    if isinstance(threads, bool) or not isinstance(threads, Integral) or threads < 1:
        raise NavmeshError(f"threads = {threads!r}: expected a whole number of at least 1")
    return min(int(threads), MOST)


def in_threads(
    work: Callable[..., _Result], arguments: Sequence[Sequence[Any]], threads: int
) -> list[_Result]:
    """What ``work`` gives for each of ``arguments``, in their order. It runs side by side as far as it lets
    go of the interpreter's lock, as kernels with ``nogil`` do."""
    if threads == 1 or len(arguments) < 2:
        return [work(*each) for each in arguments]
    with ThreadPoolExecutor(min(threads, len(arguments))) as pool:
        return list(pool.map(lambda each: work(*each), arguments))


def shares(count: int, threads: int) -> list[int]:
    """Where the shares of ``count`` things begin and end: one for each of the ``threads``, but no more than
    things."""
    number = min(threads, max(count, 1))
    return [count * share // number for share in range(number + 1)]
