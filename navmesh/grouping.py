"""Things by the group that they belong to."""

import numpy as np

from surefoot.kernels import allocating_kernel

__all__ = ["by_group", "grouped"]


@allocating_kernel(nogil=True)
def by_group(group, count):
    """The numbers of what belongs to each of so many groups, where ``group`` (l,) int32 says to which: start
    (count + 1,), number (l,) int32, rising within each."""
    start, number = np.zeros(count + 1, np.int32), np.empty(group.size, np.int32)
    for own in group:
        start[own + 1] += 1
    for i in range(count):
        start[i + 1] += start[i]
    last = start.copy()
    for i in range(group.size):
        number[last[group[i]]] = i
        last[group[i]] += 1
    return start, number


def grouped(group: np.ndarray, count: int, *values: np.ndarray) -> tuple[np.ndarray, ...]:
    """Start (count + 1,) int32 of each group, and the ``values`` in the order of the groups."""
    start, order = by_group(np.ascontiguousarray(group, np.int32), count)
    return start, *(np.ascontiguousarray(each[order]) for each in values)
