"""Nearby bodies: a uniform grid, rebuilt each tick by a counting sort."""

from math import sqrt

import numpy as np

from surefoot.kernels import allocating_kernel

__all__ = ["MOST", "brute_neighbours", "find_neighbours"]

MOST = 10
"""Most neighbours of a body that are considered."""
STOREY = 1.5
"""[m] height difference from which bodies are on different storeys."""


@allocating_kernel
def _sort_into_squares(x, y, size):
    """Bodies in order of their squares: (order, first of each square (nx·ny + 1,), square of each body, ny,
    corner x, y, size). Squares grow where the bodies are far apart, so that there are not many more of them
    than of bodies."""
    n = x.size
    low_x, low_y = x.min(), y.min()
    wide, deep = x.max() - low_x, y.max() - low_y
    size = max(size, sqrt(wide * deep / (4.0 * n + 64.0)), (wide + deep) / (4.0 * n + 64.0))
    nx, ny = int(wide / size) + 1, int(deep / size) + 1
    square = np.empty(n, np.int64)
    first = np.zeros(nx * ny + 1, np.int64)
    for i in range(n):
        square[i] = int((x[i] - low_x) / size) * ny + int((y[i] - low_y) / size)
        first[square[i] + 1] += 1
    for s in range(nx * ny):
        first[s + 1] += first[s]
    place = first[:-1].copy()
    order = np.empty(n, np.int64)
    for i in range(n):
        order[place[square[i]]] = i
        place[square[i]] += 1
    return order, first, nx, ny, low_x, low_y, size


@allocating_kernel
def find_neighbours(x, y, z, reach, wanted):
    """The nearest bodies within ``reach`` (n,) [m] of each and on the same storey, at most `MOST`, nearest
    first; of equally near ones the first. Only for those ``wanted`` (n,) bool.

    Returns (order, neighbours, count): ``order`` (n,) lists the bodies so that near ones are near each other
    in it; neighbours (n, MOST) int64 by body, count (n,) int64.
    """
    n = x.size
    neighbours = np.empty((n, MOST), np.int64)
    count = np.zeros(n, np.int64)
    if n == 0:
        return np.empty(0, np.int64), neighbours, count
    order, first, nx, ny, low_x, low_y, size = _sort_into_squares(x, y, 0.5 * max(reach.max(), 1e-3))
    sx, sy, sz = x[order], y[order], z[order]
    far = np.empty(MOST)
    for s in range(n):
        i = order[s]
        if not wanted[i]:
            continue
        px, py, pz = sx[s], sy[s], sz[s]
        limit = reach[i] * reach[i]
        found = 0
        x0 = max(int((px - reach[i] - low_x) / size), 0)
        x1 = min(int((px + reach[i] - low_x) / size), nx - 1)
        y0 = max(int((py - reach[i] - low_y) / size), 0)
        y1 = min(int((py + reach[i] - low_y) / size), ny - 1)
        for column in range(x0, x1 + 1):
            for t in range(first[column * ny + y0], first[column * ny + y1 + 1]):
                dx, dy = sx[t] - px, sy[t] - py
                squared = dx * dx + dy * dy
                if squared > limit or t == s or abs(sz[t] - pz) > STOREY:
                    continue
                j = order[t]
                if found == MOST and squared == limit and j > neighbours[i, MOST - 1]:
                    continue
                at = found if found < MOST else MOST - 1
                while at > 0 and (
                    far[at - 1] > squared or (far[at - 1] == squared and neighbours[i, at - 1] > j)
                ):
                    far[at] = far[at - 1]
                    neighbours[i, at] = neighbours[i, at - 1]
                    at -= 1
                far[at] = squared
                neighbours[i, at] = j
                found = min(found + 1, MOST)
                if found == MOST:
                    limit = far[MOST - 1]
        count[i] = found
    return order, neighbours, count


def brute_neighbours(x: np.ndarray, y: np.ndarray, z: np.ndarray, reach: np.ndarray) -> list[list[int]]:
    """`find_neighbours` by looking at every pair: the lists of all bodies."""
    lists = []
    for i in range(len(x)):
        near = [
            ((x[j] - x[i]) ** 2 + (y[j] - y[i]) ** 2, j)
            for j in range(len(x))
            if j != i and abs(z[j] - z[i]) <= STOREY
        ]
        lists.append([j for squared, j in sorted(near)[:MOST] if squared <= reach[i] ** 2])
    return lists
