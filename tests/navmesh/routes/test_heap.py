"""The open list of a search."""

import heapq

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit

from navmesh.routes.heap import push, take_first


@njit
def play(moves):
    """Keys (k,) taken, and their items: a move that is negative takes, another one is put in as its key."""
    keys, items = np.empty(moves.size), np.empty(moves.size, np.int32)
    taken, which = np.empty(moves.size), np.empty(moves.size, np.int32)
    size = count = 0
    for i, move in enumerate(moves):
        if move >= 0.0:
            push(keys, items, size, move, i)
            size += 1
        elif size > 0:
            taken[count], which[count] = keys[0], items[0]
            count += 1
            take_first(keys, items, size)
            size -= 1
    return taken[:count], which[:count]


@settings(max_examples=200, deadline=None, derandomize=True)
@given(st.lists(st.integers(-3, 6), max_size=80))
def test_the_least_comes_first(moves: list[int]) -> None:
    expected, heap = [], []
    for move in moves:
        if move >= 0:
            heapq.heappush(heap, float(move))
        elif heap:
            expected.append(heapq.heappop(heap))
    taken, which = play(np.array(moves, dtype=np.float64))
    assert taken.tolist() == expected
    assert [moves[i] for i in which.tolist()] == expected
    assert len(set(which.tolist())) == len(which)
