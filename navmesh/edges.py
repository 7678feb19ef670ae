"""Edges between nodes whose cells touch, with the widest body that passes and where it passes."""

import numpy as np
from numba import njit

__all__ = ["join_nodes"]


@njit(cache=True)
def _border_pairs(label, link, clearance):
    """Cell pairs on borders between labels, one for each pair of nodes: the one with most clearance."""
    borders = 0
    for c in range(label.shape[0]):
        for d in range(2):
            n = link[c, d]
            if n >= 0 and label[n] != label[c] and label[n] >= 0 and label[c] >= 0:
                borders += 1
    key = np.empty(borders, np.int64)
    pair = np.empty((borders, 2), np.int32)
    width = np.empty(borders)
    k = 0
    for c in range(label.shape[0]):
        for d in range(2):
            n = link[c, d]
            if n < 0 or label[n] == label[c] or label[n] < 0 or label[c] < 0:
                continue
            first, second = (c, n) if label[c] < label[n] else (n, c)
            key[k] = (np.int64(label[first]) << 32) | label[second]
            pair[k, 0] = first
            pair[k, 1] = second
            width[k] = min(clearance[c], clearance[n])
            k += 1
    return key, pair, width


@njit(cache=True)
def _assemble(order, key, pair, width, x, y, radii):
    """CSR arrays of the edges from border pairs that ``order`` sorts by key."""
    nodes = radii.shape[0]
    degree = np.zeros(nodes + 1, np.int32)
    chosen = np.empty(order.shape[0], np.int32)
    edges = 0
    for k in range(order.shape[0]):
        i = order[k]
        if edges > 0 and key[chosen[edges - 1]] == key[i]:
            if width[i] > width[chosen[edges - 1]]:
                chosen[edges - 1] = i
            continue
        chosen[edges] = i
        edges += 1
        degree[key[i] >> 32] += 1
        degree[key[i] & 0xFFFFFFFF] += 1
    start = np.zeros(nodes + 1, np.int32)
    for m in range(nodes):
        start[m + 1] = start[m] + degree[m]
    fill = start[:-1].copy()
    target = np.empty(2 * edges, np.int32)
    widest = np.empty(2 * edges)
    portal = np.empty((2 * edges, 4))
    border = np.empty((2 * edges, 2), np.int32)
    for k in range(edges):
        i = chosen[k]
        a = np.int32(key[i] >> 32)
        b = np.int32(key[i] & 0xFFFFFFFF)
        dx, dy = x[b] - x[a], y[b] - y[a]
        distance = np.hypot(dx, dy)
        lens = 0.5 * (radii[a] + radii[b] - distance)
        passes = max(width[i], min(lens, radii[a], radii[b]))
        for way in range(2):
            source, other = (a, b) if way == 0 else (b, a)
            e = fill[source]
            fill[source] += 1
            target[e] = other
            widest[e] = passes
            border[e, 0] = pair[i, way]
            border[e, 1] = pair[i, 1 - way]
            ux, uy = (dx, dy) if way == 0 else (-dx, -dy)
            if distance > 0.0:
                ux /= distance
                uy /= distance
            reach = 0.5 * (distance + (radii[source] ** 2 - radii[other] ** 2) / max(distance, 1e-12))
            reach = min(max(reach, -radii[source]), radii[source])
            chord = np.sqrt(max(0.0, radii[source] ** 2 - reach * reach))
            portal[e, 0] = x[source] + reach * ux - chord * uy
            portal[e, 1] = y[source] + reach * uy + chord * ux
            portal[e, 2] = x[source] + reach * ux + chord * uy
            portal[e, 3] = y[source] + reach * uy - chord * ux
    return start, target, widest, portal, border


def join_nodes(
    label: np.ndarray,
    link: np.ndarray,
    clearance: np.ndarray,
    x: np.ndarray,
    y: np.ndarray,
    radii: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Edges in CSR form, both ways: start (m + 1,), target (e,), width (e,), portal (e, 4), cells (e, 2).

    ``x``, ``y`` and ``radii`` (m,) are the discs; the other arrays are the surface's. The widest body that
    passes is max((Rᵢ + Rⱼ - d)/2, the clearance of the best pair of linked cells on the labels' border).
    """
    key, pair, width = _border_pairs(label, link, clearance)
    order = np.argsort(key, kind="stable")
    return _assemble(order, key, pair, width, x, y, radii)
