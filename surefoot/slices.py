"""Long work in slices: a generator that yields after each piece how much work that was.

def work() -> Slices[float]:
    ...
    yield 3000  # in any unit that does not depend on the clock
    return result

finish(work())  # all of it at once
"""

from collections.abc import Generator
from typing import TypeVar

__all__ = ["Slices", "finish"]

_Result = TypeVar("_Result")
Slices = Generator[int, None, _Result]
"""Yields the work of each piece; returns the result."""


def finish(work: Slices[_Result]) -> _Result:
    """Do all of ``work``; return its result."""
    while True:
        try:
            next(work)
        except StopIteration as end:
            return end.value
