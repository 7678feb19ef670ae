"""Counting outcomes of runs that take long."""

from collections.abc import Iterable
from itertools import islice

__all__ = ["enough"]


def enough(outcomes: Iterable[bool], least: int) -> bool:
    """Whether at least ``least`` of the ``outcomes`` are true; asks for no more of them than it takes."""
    return sum(1 for _ in islice(filter(None, outcomes), least)) == least
