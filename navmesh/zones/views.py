"""What zones add to a graph when they are open: discs and edges, found beside those that are always there."""

import numpy as np

from navmesh.graph.edges import edges_beside
from navmesh.graph.nodes import cover_cells
from navmesh.surface.ridges import Field
from surefoot.kernels import allocating_kernel

__all__ = ["Views"]

_WIDER = 2e-3
"""[m] by which a disc or an edge must be wider to be worth a second one."""
_WIDE = 1.5
"""[m]: nobody is as wide. Discs that are wider need no others beside them that are wider still."""
Edges = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
"""What `navmesh.graph.edges.measure_edges` gives."""


class Views:
    """The nodes and edges of a divided graph while its views are found, one after another."""

    def __init__(self, label: np.ndarray, node_cell: np.ndarray, place: np.ndarray, edges: Edges) -> None:
        self.label = label
        """(n,) int32: the nodes of the cells, kept up to date by whoever blocks and opens zones."""
        self.node_cell = node_cell
        self.place = place
        """(m, 3) float64 [m]; may have room for more rows than there are nodes."""
        self.count = len(node_cell)
        """Nodes."""
        self.edges = [edges]
        """Those that always are there, then those of each view."""
        self.own = [(np.empty(0, np.int32),) * 2]
        """Of each view the rows whose cells have a node of it, and that; after an empty pair."""
        self.first = [self.count]
        """The first node of each view, and the end."""
        self._base = self.count
        self._key = _keys(edges)
        self._width = edges[1]
        self._wider: dict[int, float] = {}
        self._power = np.full(len(label), -np.inf)

    @property
    def size(self) -> np.ndarray:
        """(m,) float64 [m]: radii of all nodes."""
        return self.place[: self.count, 2].copy()

    def find(self, rows: np.ndarray, cells: np.ndarray, field: Field, least: float, grain: float) -> None:
        """Add the view of zones that are open now: of ``cells`` (k,), at ``rows``. ``field`` is that of now,
        without limits by the nodes from here on."""
        uncovered = _uncovered(cells, self.label, self.place, self._power, field, grain)
        at, order = uncovered, cells[uncovered]
        node_cell, place = cover_cells(order, field, least, self.label, self._power, self.count)
        self._add(node_cell, place)
        self._power[order] = -np.inf
        node = self.label[order]
        self.own.append((rows[at[node >= 0]].astype(np.int32), node[node >= 0]))
        self.first.append(self.count)
        edges = edges_beside(cells, self.label, field, self.place)
        fresh = self._are_wider(edges)
        self.edges.append(tuple(np.ascontiguousarray(each[fresh]) for each in edges))  # type: ignore[arg-type]

    def _add(self, node_cell: np.ndarray, place: np.ndarray) -> None:
        more = self.count + len(node_cell)
        if more > len(self.place):
            room = np.empty((max(more, 3 * len(self.place) // 2), 3))
            room[: self.count] = self.place[: self.count]
            cells = np.empty(len(room), np.int32)
            cells[: self.count] = self.node_cell[: self.count]
            self.place, self.node_cell = room, cells
        self.place[self.count : more], self.node_cell[self.count : more] = place, node_cell
        self.count = more

    def _are_wider(self, edges: Edges) -> np.ndarray:
        """Which of ``edges`` there is none as wide of yet."""
        key, width = _keys(edges), edges[1]
        known = np.full(len(key), -np.inf)
        if len(self._key):
            at = np.minimum(np.searchsorted(self._key, key), len(self._key) - 1)
            known = np.where(self._key[at] == key, self._width[at], -np.inf)
        for i in range(len(key)):
            before = max(known[i], self._wider.get(int(key[i]), -np.inf))
            known[i] = before
            if width[i] > before + _WIDER:
                self._wider[int(key[i])] = float(width[i])
        return width > known + _WIDER


def _keys(edges: Edges) -> np.ndarray:
    return (edges[0][:, 0].astype(np.int64) << 32) | edges[0][:, 1]


@allocating_kernel
def _uncovered(cells, label, place, power, field, grain):
    """Which of ``cells`` (k,) are wider than their node, (u,) int64 by falling clearance. They are taken from
    it: their label is -1, their power inf, and their clearance what it is without a node."""
    found, step = np.empty(cells.shape[0], np.int64), np.empty(cells.shape[0])
    count = 0
    for i in range(cells.shape[0]):
        c = cells[i]
        wide = np.hypot(field.nearest[c, 0], field.nearest[c, 1])
        if label[c] >= 0:
            known = place[label[c], 2]
            if known >= _WIDE or wide <= known + _WIDER:
                continue
        label[c], power[c], field.clearance[c] = -1, np.inf, wide
        found[count], step[count] = i, -np.floor(wide / grain)
        count += 1
    order = np.argsort(step[:count], kind="mergesort")
    return found[:count][order]
