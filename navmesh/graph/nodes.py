"""Nodes: the largest discs that fit the surface, greedily, until every cell wide enough is covered."""

import numpy as np

from navmesh.surface.clearance_field import centre_of
from navmesh.surface.columns import column_of
from navmesh.surface.ridges import half_width, middle_beside
from navmesh.surface.storeys import over
from navmesh.surface.surface import Surface
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["all_nodes", "disc_at", "grain_of", "order_by_clearance", "select_nodes"]


def grain_of(surface: Surface) -> float:
    """[m], steps of the clearance in which cells have their turn."""
    return surface.resolution / 64


def all_nodes(surface: Surface, least: float) -> tuple[np.ndarray, ...]:
    """What `select_nodes` gives for all cells of a surface."""
    order = order_by_clearance(surface.clearance, grain_of(surface))
    none = np.empty(0, np.int32)
    return select_nodes(order, surface.field, surface.field, none, least, none, np.empty((0, 3)))


@allocating_kernel(nogil=True)
def order_by_clearance(clearance, grain):
    """The cells by falling clearance in steps of ``grain`` [m], then by rising index: (n,) int32."""
    cells = clearance.shape[0]
    widest = 0.0
    for c in range(cells):
        widest = max(widest, clearance[c])
    steps = int(widest / grain) + 1
    start = np.zeros(steps + 1, np.int32)
    for c in range(cells):
        start[steps - int(clearance[c] / grain)] += 1
    for k in range(steps):
        start[k + 1] += start[k]
    order = np.empty(cells, np.int32)
    for c in range(cells):
        k = steps - 1 - int(clearance[c] / grain)
        order[start[k]] = c
        start[k] += 1
    return order


@kernel
def _claim_line(field, label, power, node, radius, c, column, d, dx, dy):
    """Claim c and the cells from it in y direction d (1 or 3) for a disc, as long as they lie in the disc.

    (dx, dy) goes from the disc's centre to c, which is in ``column``. A cell that is wider than the disc
    itself is left alone: its node must let pass whatever the cell lets pass.
    """
    step, beside = (field.cell, 1) if d == 1 else (-field.cell, -1)
    while c >= 0:
        score = dx * dx + dy * dy - radius * radius
        if score > 1e-12:
            return
        if score < power[c] and field.clearance[c] <= radius:
            power[c] = score
            label[c] = node
        c = over(field, c, column, d)
        column += beside
        dy += step


@kernel
def _claim(field, label, power, node, k, off_x, off_y, radius):
    """Claim what lies in a disc and is reached over links from cell ``k``, whose centre is (off_x, off_y)
    from its own: along x, then along y."""
    resolution, own = field.cell, column_of(field, k)
    for d in range(0, 3, 2):
        step, beside = (resolution, field.ny) if d == 0 else (-resolution, -field.ny)
        spine, column, dx = np.int64(k), own, off_x
        if d == 2:
            spine, column, dx = over(field, k, column, 2), column + beside, off_x - resolution
        while spine >= 0 and dx * dx <= radius * radius:
            _claim_line(field, label, power, node, radius, spine, column, 1, dx, off_y)
            below = over(field, spine, column, 3)
            _claim_line(field, label, power, node, radius, below, column - 1, 3, dx, off_y - resolution)
            spine = over(field, spine, column, d)
            column += beside
            dx += step


@kernel
def disc_at(field, c):
    """The disc whose turn it is at cell ``c``: (cell, x, y, radius)."""
    if half_width(field, c) < np.inf:
        return middle_beside(field, c)
    x, y = centre_of(field, c)
    return np.int64(c), x, y, field.clearance[c]


@allocating_kernel(nogil=True)
def select_nodes(order, field, whole, where, least, given_cell, given_place):
    """Greedy cover by maximal discs, (almost) largest first.

    ``order`` (n,) int32: cells by falling clearance (`order_by_clearance`); ``field`` is the
    `navmesh.surface.net.NET` of all, ``whole``, or that of a part of its cells, ``where`` (n,)
    int32, by rising number. A cell with at least ``least`` clearance that no disc as wide as itself covers
    becomes the place of one: its centre or, between opposite sides, the middle of the passage. At -1 - i in
    the order it is the turn of a node that is there anyway, in ``given_cell[i]`` at ``given_place[i]``.

    Returns ``node_cell`` (m,) int32, by their numbers in the whole, ``place`` (m, 3) float64, x, y and radius
    [m], ``maker`` (m,) int32, the entries of the order that made the nodes, and ``label`` (n,) int32: of the
    nodes that cover a cell the one in whose disc it is deepest (least d² - r²), or -1.
    """
    cells = field.clearance.shape[0]
    label = np.full(cells, -1, np.int32)
    power = np.full(cells, np.inf)
    node_cell, maker = np.empty(order.shape[0], np.int32), np.empty(order.shape[0], np.int32)
    place = np.empty((order.shape[0], 3))
    nodes, part = 0, where.shape[0] > 0
    for at in range(order.shape[0]):
        c = order[at]
        if c < 0:
            k = given_cell[-1 - c]
            x, y, r = given_place[-1 - c, 0], given_place[-1 - c, 1], given_place[-1 - c, 2]
        else:
            if label[c] >= 0:
                continue
            k, x, y, r = disc_at(whole, where[c] if part else c)
            if r < least:
                continue
        node_cell[nodes], maker[nodes] = k, c
        place[nodes, 0], place[nodes, 1], place[nodes, 2] = x, y, r
        cx, cy = centre_of(whole, k)
        _claim(field, label, power, nodes, np.searchsorted(where, k) if part else k, cx - x, cy - y, r)
        if c >= 0:
            label[c] = nodes  # also where the disc is too small to hold the cell's centre
        nodes += 1
    return node_cell[:nodes].copy(), place[:nodes].copy(), maker[:nodes].copy(), label
