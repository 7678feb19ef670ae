"""The open list of a search: a binary heap in two arrays, the keys and what they stand for."""

from surefoot.kernels import kernel

__all__ = ["push", "take_first"]


@kernel(error_model="numpy", forceinline=True)
def push(keys, items, size, key, item):
    """Add an entry to the ``size`` that are there."""
    i = size
    while i > 0:
        up = (i - 1) >> 1
        if keys[up] <= key:
            break
        keys[i] = keys[up]
        items[i] = items[up]
        i = up
    keys[i] = key
    items[i] = item


@kernel(error_model="numpy", forceinline=True)
def take_first(keys, items, size):
    """Remove the entry with the least key, the first, of ``size``."""
    last = size - 1
    hole = 0
    down = 1
    # the hole sinks to the bottom, with no branch that is hard to foretell; what then fills it rises little
    while down + 1 < last:
        down += keys[down + 1] < keys[down]
        keys[hole] = keys[down]
        items[hole] = items[down]
        hole = down
        down = 2 * hole + 1
    if down < last:
        keys[hole] = keys[down]
        items[hole] = items[down]
        hole = down
    push(keys, items, hole, keys[last], items[last])
