"""Independent pieces of a tick, side by side."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, wait

__all__ = ["Threads"]


class Threads:
    """Up to ``count`` threads that share work, and wait in between. They run side by side as far as the work
    lets go of the interpreter's lock, as MuJoCo's steps do."""

    def __init__(self, count: int) -> None:
        self._count = count
        self._pool: ThreadPoolExecutor | None = None

    def each(self, work: Callable[[int], object], count: int) -> None:
        """Call ``work`` with 0 to ``count`` - 1, in any order and side by side; the caller's thread takes
        part. Returns, or raises the first error, when all have ended."""
        numbers = iter(range(count))

        def take_part() -> None:
            for number in numbers:
                work(number)

        helpers = min(self._count, count) - 1
        if helpers < 1:
            take_part()
            return
        if self._pool is None:
            self._pool = ThreadPoolExecutor(self._count - 1)
        others = [self._pool.submit(take_part) for _ in range(helpers)]
        try:
            take_part()
        finally:
            wait(others)
        for other in others:
            other.result()
