"""Edges between nodes whose cells touch, with the widest body that passes and where it passes."""

from itertools import pairwise
from typing import Any

import numpy as np

from navmesh.surface.clearance_field import centre_of
from navmesh.surface.columns import column_of
from navmesh.surface.ridges import half_width, widest_through
from navmesh.surface.storeys import over
from navmesh.threads import in_threads, shares
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["border_pairs", "join_nodes", "measure_edges", "rows_of_edges", "widest_pair"]


_WIDE = 1.5
"""[m] Passages this wide are known well enough by their cells: no body is as wide."""
_FINE = 0.002
"""[m] of a passage's half width that are not worth another look."""


@allocating_kernel(nogil=True)
def border_pairs(label, field, first_cell, last_cell):
    """The pairs of linked cells with different labels, for cells from ``first_cell`` up to, not including,
    ``last_cell`` and those ahead of them: for each a key, the lesser label in the upper half (k,) int64, the
    cells (k, 2) int32, that of the lesser label first, and the lesser clearance (k,)."""
    borders = 0
    begin = column_of(field, first_cell) if first_cell > 0 else np.int64(0)
    column = begin
    for c in range(first_cell, last_cell):
        while field.column_start[column + 1] <= c:
            column += 1
        for d in range(2):
            n = over(field, c, column, d)
            if n >= 0 and label[n] != label[c] and label[n] >= 0 and label[c] >= 0:
                borders += 1
    key = np.empty(borders, np.int64)
    pair = np.empty((borders, 2), np.int32)
    width = np.empty(borders)
    k, column = 0, begin
    for c in range(first_cell, last_cell):
        while field.column_start[column + 1] <= c:
            column += 1
        for d in range(2):
            n = over(field, c, column, d)
            if n < 0 or label[n] == label[c] or label[n] < 0 or label[c] < 0:
                continue
            first, second = (c, n) if label[c] < label[n] else (n, c)
            key[k] = (np.int64(label[first]) << 32) | label[second]
            pair[k, 0] = first
            pair[k, 1] = second
            width[k] = min(field.clearance[c], field.clearance[n])
            k += 1
    return key, pair, width


@allocating_kernel(nogil=True)
def _by_ends(key, nodes):
    """The border pairs by rising key, those of one key in their order: (k,) int32. Sorted by counting, first
    by the greater end and then by the lesser."""
    order, again = np.arange(key.shape[0]).astype(np.int32), np.empty(key.shape[0], np.int32)
    for shift in (0, 32):
        start = np.zeros(nodes + 1, np.int32)
        for k in range(key.shape[0]):
            start[((key[k] >> shift) & 0xFFFFFFFF) + 1] += 1
        for m in range(nodes):
            start[m + 1] += start[m]
        for k in range(key.shape[0]):
            m = (key[order[k]] >> shift) & 0xFFFFFFFF
            again[start[m]] = order[k]
            start[m] += 1
        order, again = again, order
    return order


@kernel
def widest_pair(order, first, last, pair, width, least, most, field):
    """Where the widest body passes the border pairs ``order[first:last]`` of one edge, and the pair there:
    (index of the pair, x, y, radius). Radii up to ``least`` [m] and from ``most`` on are all the same."""
    best = order[first]
    for k in range(first + 1, last):
        if width[order[k]] > width[best]:
            best = order[k]
    c, n = pair[best, 0], pair[best, 1]
    x, y = centre_of(field, c if field.clearance[c] > field.clearance[n] else n)
    radius = max(width[best], least)
    for k in range(first, last):
        c, n = pair[order[k], 0], pair[order[k], 1]
        if radius >= _WIDE or radius + _FINE >= most:
            break
        one, other = half_width(field, c), half_width(field, n)
        bound = min(one, other) if one == np.inf or other == np.inf else max(one, other)
        if radius + _FINE < bound < np.inf:
            px, py, passes = widest_through(field, c, n, radius)
            if passes > radius:
                best, x, y, radius = order[k], px, py, passes
    return best, x, y, min(radius, most)


@allocating_kernel(nogil=True)
def _measure(order, key, pair, width, place, field):
    """The edges that the border pairs in ``order``, which sorts them by key, make up: ends (e, 2) int32, the
    lesser first; width (e,), gate (e, 2) float64 and pair (e, 2) int32."""
    begin = np.empty(order.shape[0] + 1, np.int32)
    edges = 0
    for k in range(order.shape[0]):
        if k == 0 or key[order[k - 1]] != key[order[k]]:
            begin[edges] = k
            edges += 1
    begin[edges] = order.shape[0]
    ends, border = np.empty((edges, 2), np.int32), np.empty((edges, 2), np.int32)
    widest, gate = np.empty(edges), np.empty((edges, 2))
    for k in range(edges):
        i = order[begin[k]]
        a = np.int32(key[i] >> 32)
        b = np.int32(key[i] & 0xFFFFFFFF)
        one, other = place[a, 2], place[b, 2]
        lens = 0.5 * (one + other - np.hypot(place[b, 0] - place[a, 0], place[b, 1] - place[a, 1]))
        i, x, y, passes = widest_pair(
            order, begin[k], begin[k + 1], pair, width, lens, min(one, other), field
        )
        ends[k, 0], ends[k, 1], widest[k], gate[k, 0], gate[k, 1] = a, b, passes, x, y
        border[k, 0], border[k, 1] = pair[i, 0], pair[i, 1]
    return ends, widest, gate, border


@allocating_kernel(nogil=True)
def rows_of_edges(nodes, ends, widest, gate, border):
    """`join_nodes`' arrays from those of edges (e, 2), sorted by the lesser and then by the greater end."""
    start = np.zeros(nodes + 1, np.int32)
    edges = ends.shape[0]
    for k in range(edges):
        start[ends[k, 0] + 1] += 1
        start[ends[k, 1] + 1] += 1
    for m in range(nodes):
        start[m + 1] += start[m]
    fill = start[:-1].copy()
    target, width = np.empty(2 * edges, np.int32), np.empty(2 * edges)
    place, cells = np.empty((2 * edges, 2)), np.empty((2 * edges, 2), np.int32)
    for k in range(edges):
        for way in range(2):
            e = fill[ends[k, way]]
            fill[ends[k, way]] += 1
            target[e], width[e] = ends[k, 1 - way], widest[k]
            cells[e, 0], cells[e, 1] = border[k, way], border[k, 1 - way]
            place[e, 0], place[e, 1] = gate[k, 0], gate[k, 1]
    return start, target, width, place, cells


def measure_edges(
    key: np.ndarray, pair: np.ndarray, width: np.ndarray, field: Any, place: np.ndarray, threads: int = 1
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """`_measure` for all edges of some `border_pairs`."""
    order = _by_ends(key, len(place))
    sorted_key = key[order]
    bounds = np.searchsorted(sorted_key, sorted_key[shares(len(key), threads)[:-1]]) if len(key) else [0]
    parts = [[order[first:last]] for first, last in pairwise([*bounds, len(key)])]
    found = in_threads(lambda part: _measure(part, key, pair, width, place, field), parts, threads)
    ends, widest, gate, border = (np.concatenate(each) for each in zip(*found, strict=True))
    return ends, widest, gate, border


def join_nodes(
    label: np.ndarray, field: Any, place: np.ndarray, threads: int = 1
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Edges in CSR form, both ways: start (m + 1,), target (e,), width (e,), gate (e, 2), cells (e, 2).

    ``place`` (m, 3) are the discs' x, y and radius [m]; ``label`` says who owns each cell. The widest body
    that passes is max((Rᵢ + Rⱼ - d)/2, the clearance of the best pair of linked cells on the labels'
    border); where the sides of a passage face each other, the clearance in its middle instead of the cells'.
    """
    parts = pairwise(shares(len(label), threads))
    found = in_threads(lambda *part: border_pairs(label, field, *part), list(parts), threads)
    key, pair, width = (
        np.concatenate(each) if len(found) > 1 else each[0] for each in zip(*found, strict=True)
    )
    return rows_of_edges(len(place), *measure_edges(key, pair, width, field, place, threads))
