"""The nodes after a change, without choosing all of them anew.

Nodes are chosen in an order that only the cells' clearances and places make (`navmesh.graph.nodes`), and what
is chosen at a cell depends on the discs that cover it by then. So they are chosen anew in a rectangle, among
the others whose discs reach into it, each in its turn. If no disc that is new, gone, or over changed cells
reaches out of the rectangle, the choice is the same everywhere else. If one does, the rectangle grows.
"""

from dataclasses import dataclass

import numpy as np

from navmesh.graph.nodes import grain_of, order_by_clearance, select_nodes
from navmesh.level.raster import Patch
from navmesh.surface.build import Window
from navmesh.surface.renewal import cells_in, inside_of, moved_cells, within_of
from navmesh.surface.splicing import runs_of
from navmesh.surface.surface import Surface
from navmesh.surface.windows import columns_in
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["Nodes", "RenewedNodes", "boxes_of", "hull", "renew_nodes"]

_SEEN = 4
"""Columns around a cell on which it depends what disc it gets."""
_FARTHER = 16
"""Columns by which the rectangle grows farther than it has to: other discs often make others beyond."""


@dataclass(frozen=True, slots=True, eq=False)
class Nodes:
    """The discs, in the order in which they were chosen."""

    cell: np.ndarray
    """(m,) int32: the cell that each lies in."""
    place: np.ndarray
    """(m, 3) float64 [m]: x, y from the surface's origin, and radius."""
    maker: np.ndarray
    """(m,) int32: the cell at whose turn it was chosen."""
    label: np.ndarray
    """(n,) int32: the node that owns each cell, or -1."""
    position: np.ndarray
    """(m, 3) float64 [m]: the places on the floor, world coordinates."""


@dataclass(frozen=True, slots=True, eq=False)
class RenewedNodes:
    """Nodes after a change, and what has changed."""

    nodes: Nodes
    number: np.ndarray
    """(m before,) int32: what number each node of before has now, or -1."""
    window: Window
    """Outside of these columns no label is another than before, but for the numbers."""


def renew_nodes(
    old: Nodes, before: Surface, surface: Surface, window: Window, least: float, most: float
) -> RenewedNodes | None:
    """The nodes of ``surface``, which is as ``before``, with the ``old`` nodes, outside of ``window``.

    ``least`` [m] is the radius of the smallest. Bit for bit those that `select_nodes` finds in the
    whole. None where more than the share ``most`` of the grid would have to be looked at.
    """
    changed = hull(np.array(window), np.empty((0, 4), np.int64), 1, surface)
    reaching = old.place[_near(old.place, surface.resolution, changed)]
    area = hull(np.array(window), boxes_of(reaching, surface.resolution), _SEEN, surface)
    while np.prod(area[2:] - area[:2]) <= most * np.prod(surface.shape):
        chosen = _choose_in(area, old, before, surface, least)
        clipped = np.clip(chosen.boxes, 0, np.tile(surface.shape, 2))
        beyond = (clipped[:, :2] < area[:2]).any(axis=1) | (clipped[:, 2:] > area[2:]).any(axis=1)
        if not beyond.any():
            return _numbered(area, changed, chosen, old, before, surface)
        wider = hull(area, chosen.boxes[beyond], 0, surface)
        area = hull(wider + _FARTHER * np.sign(wider - area), np.empty((0, 4), np.int64), 0, surface)
    return None


@dataclass(frozen=True, slots=True, eq=False)
class _Chosen:
    """Nodes of a rectangle of columns, and those that reach into it."""

    nodes: Nodes
    """In their order; labels are of the cells ``where``."""
    was: np.ndarray
    """(k,) int64: the node of before that each is, or -1."""
    made: np.ndarray
    """(k,) bool: whether it was chosen in the rectangle."""
    replaced: np.ndarray
    """(r,) int64: the nodes of before that were chosen in the rectangle."""
    where: np.ndarray
    """(j,) int32: the cells that the labels are of."""
    within: np.ndarray
    """(j,) bool: which of them are in the rectangle."""
    boxes: np.ndarray
    """(b, 4): the columns under the discs that are new or gone."""


def _choose_in(area: np.ndarray, old: Nodes, before: Surface, surface: Surface, least: float) -> _Chosen:
    """Choose nodes anew in the columns of ``area``."""
    window, side = tuple(area.tolist()), surface.resolution
    near = _near(old.place, side, area)
    in_area = inside_of(before.columns(old.maker[near]), window, surface.shape[1])
    there, given = near[in_area], near[~in_area]
    around = tuple(hull(area, boxes_of(old.place[given], side), _SEEN, surface).tolist())
    field, where = cells_in(surface, around)
    within = within_of(field.column_start, around, window)
    inside = np.flatnonzero(within).astype(np.int32)
    order = inside[order_by_clearance(field.clearance[inside], grain_of(surface))]
    given_maker = moved_cells(old.maker[given], before, surface, window)
    at = _places_among(where[order], given_maker, surface.clearance, grain_of(surface))
    order = np.insert(order, at, -1 - np.arange(len(given), dtype=np.int32))
    given_cell = moved_cells(old.cell[given], before, surface, window)
    whole_cell, place, maker, label = select_nodes(
        order, field, surface.field, where, least, given_cell, old.place[given]
    )
    made = maker >= 0
    was, whole_maker = np.full(len(maker), -1), np.empty(len(maker), np.int32)
    was[~made] = given[-1 - maker[~made]]
    whole_maker[made], whole_maker[~made] = where[maker[made]], given_maker[-1 - maker[~made]]
    was[made] = _found_again(
        (*_turns(old.maker[there], before), _spots(old.cell[there], before), old.place[there]),
        (*_turns(whole_maker[made], surface), _spots(whole_cell[made], surface), place[made]),
        there,
    )
    changed = np.concatenate([old.place[np.setdiff1d(there, was)], place[was < 0]])
    nodes = Nodes(whole_cell, place, whole_maker, label, surface.lifted(place[:, :2], whole_cell))
    return _Chosen(nodes, was, made, there, where, within, boxes_of(changed, side))


def _numbered(
    area: np.ndarray, changed: np.ndarray, chosen: _Chosen, old: Nodes, before: Surface, surface: Surface
) -> RenewedNodes:
    """All nodes, those ``chosen`` in the ``area`` and the old ones made elsewhere, in their order. Outside of
    ``changed`` all columns have the cells that they had."""
    window = tuple(area.tolist())
    kept = np.delete(np.arange(len(old.cell)), chosen.replaced)
    maker = moved_cells(old.maker, before, surface, window)
    made = np.flatnonzero(chosen.made)
    at = _places_among(maker[kept], chosen.nodes.maker[made], surface.clearance, grain_of(surface))
    to = at + np.arange(len(made))  # where those made in the area come to stand
    from_kept = np.arange(len(kept)) + np.cumsum(np.bincount(at, minlength=len(kept) + 1)[: len(kept)])
    origin = np.empty(len(kept) + len(made), np.int64)
    origin[from_kept], origin[to] = kept, len(old.cell) + np.arange(len(made))

    def merged(of_old: np.ndarray, of_made: np.ndarray) -> np.ndarray:
        return np.concatenate([of_old, of_made])[origin]

    number = np.full(len(old.cell), -1, np.int32)
    number[kept] = from_kept
    again = chosen.was[made] >= 0
    number[chosen.was[made][again]] = to[again]
    local = np.empty(len(chosen.was) + 1, np.int32)
    local[-1] = -1
    local[:-1][~chosen.made] = number[chosen.was[~chosen.made]]
    local[made] = to
    start, _ = columns_in(surface.column_start, area, surface.shape[1])
    patch = Patch(surface.resolution, *area[:2].tolist(), *(area[2:] - area[:2]).tolist())
    runs, count = runs_of(before.column_start, start, window, patch, surface.shape[1])
    label = np.empty(count, np.int32)
    _renumber(old.label, np.concatenate([[-1], number]).astype(np.int32), runs, label)
    label[chosen.where[chosen.within]] = local[chosen.nodes.label[chosen.within]]
    nodes = Nodes(
        merged(moved_cells(old.cell, before, surface, window), chosen.nodes.cell[made]),
        merged(old.place, chosen.nodes.place[made]),
        merged(maker, chosen.nodes.maker[made]),
        label,
        merged(old.position, chosen.nodes.position[made]),
    )
    labelled = _where_labels_change(
        before.column_start, surface.column_start, old.label, label, number, area, changed, surface.shape[1]
    )
    return RenewedNodes(nodes, number, tuple(hull(changed, labelled, _SEEN, surface).tolist()))


def _found_again(old: tuple, new: tuple, names: np.ndarray) -> np.ndarray:
    """For each new node its name before, or -1: made at the same spot and at the same turn, in the same spot
    and alike."""
    if not len(names):
        return np.full(len(new[0]), -1)
    by = np.argsort(old[0])
    at = by[np.minimum(np.searchsorted(old[0][by], new[0]), len(by) - 1)]
    same = (old[-1][at] == new[-1]).all(axis=1)
    for one, other in zip(old[:-1], new[:-1], strict=True):
        same &= one[at] == other
    return np.where(same, names[at], -1)


def _turns(cells: np.ndarray, surface: Surface) -> tuple[np.ndarray, np.ndarray]:
    """The `_spots` of ``cells``, and (k,) int64 the steps of clearance in which they have their turn."""
    return _spots(cells, surface), (surface.clearance[cells] / grain_of(surface)).astype(np.int64)


def _spots(cells: np.ndarray, surface: Surface) -> np.ndarray:
    """(k,) int64: column and storey of ``cells``, which say which they are whatever is elsewhere."""
    columns = surface.columns(cells)
    return (columns.astype(np.int64) << 16) | (cells - surface.column_start[columns])


def boxes_of(place: np.ndarray, side: float) -> np.ndarray:
    """(m, 4) int64: windows that hold all columns under discs, and a column more on each side."""
    low = np.floor((place[:, :2] - place[:, 2:]) / side).astype(np.int64) - 2
    high = np.floor((place[:, :2] + place[:, 2:]) / side).astype(np.int64) + 3
    return np.column_stack([low, high])


@allocating_kernel(nogil=True)
def _near(place, side, area):
    """(k,) int64: the discs whose `boxes_of` touch ``area``."""
    found = np.empty(place.shape[0], np.int64)
    count = 0
    for i in range(place.shape[0]):
        x, y, r = place[i, 0], place[i, 1], place[i, 2]
        if (  # without rounding down
            (x - r) / side < area[2] + 2
            and (y - r) / side < area[3] + 2
            and (x + r) / side >= area[0] - 2
            and (y + r) / side >= area[1] - 2
        ):
            found[count] = i
            count += 1
    return found[:count].copy()


def hull(area: np.ndarray, boxes: np.ndarray, beyond: int, surface: Surface) -> np.ndarray:
    """The window of the grid that holds ``area`` and ``boxes``, and so many columns ``beyond``."""
    every = np.concatenate([area[None], boxes])
    low, high = every[:, :2].min(axis=0) - beyond, every[:, 2:].max(axis=0) + beyond
    return np.concatenate([np.maximum(low, 0), np.minimum(high, surface.shape)])


@allocating_kernel(nogil=True)
def _places_among(makers, others, clearance, grain):
    """How many of ``makers``, cells in the order of their turns, have it before each of ``others``, which are
    in that order, too: (k,) int64."""
    place = np.empty(others.shape[0], np.int64)
    low = 0
    for k in range(others.shape[0]):
        cell, step = others[k], int(clearance[others[k]] / grain)
        high = makers.shape[0]
        while low < high:
            middle = (low + high) // 2
            its = int(clearance[makers[middle]] / grain)
            if its > step or (its == step and makers[middle] < cell):
                low = middle + 1
            else:
                high = middle
        place[k] = low
    return place


@allocating_kernel(nogil=True)
def _where_labels_change(old_start, start, old_label, label, number, area, changed, ny):
    """The window of the columns of ``area``, and not of ``changed``, whose cells have other labels: (1, 4)
    int64, or (0, 4)."""
    found = np.array([[1 << 40, 1 << 40, -1, -1]])
    for ix in range(area[0], area[2]):
        for iy in range(area[1], area[3]):
            if changed[0] <= ix < changed[2] and changed[1] <= iy < changed[3]:
                continue
            first = old_start[ix * ny + iy]
            for k in range(start[ix * ny + iy], start[ix * ny + iy + 1]):
                was = old_label[first + k - start[ix * ny + iy]]
                if label[k] != (number[was] if was >= 0 else -1):
                    found[0, 0], found[0, 1] = min(found[0, 0], ix), min(found[0, 1], iy)
                    found[0, 2], found[0, 3] = max(found[0, 2], ix + 1), max(found[0, 3], iy + 1)
    return found if found[0, 2] >= 0 else found[:0]


@kernel(nogil=True)
def _renumber(old_label, number, runs, label):
    """Fill in the labels of what lies in runs of before: ``number[was + 1]``."""
    for row in range(0, runs.shape[0], 2):
        first, at = runs[row, 1], runs[row, 3]
        given, taken = old_label[first : first + runs[row, 2]], label[at : at + runs[row, 2]]
        for k in range(given.shape[0]):
            taken[k] = number[np.uint32(given[k] + 1)]
