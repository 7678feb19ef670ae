"""The walkable surface as cells: one per floor and square of the grid, joined where a body can walk.

A cell is a sample of the surface at the centre of its square: it exists where the centre is a floor
point (rule 1 of `navmesh.rules.WalkRules`) and its height is the mesh's own there. Storeys above each
other are several cells of one column. Neighbouring cells are linked unless a wall (rule 2) or the end
of the floor (rule 3) lies between their centres.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from navmesh.surface.columns import columns_of, columns_of_all
from navmesh.surface.floor_store import FloorStore
from navmesh.surface.net import NET, NO_GRAPH
from navmesh.surface.recall import recall
from navmesh.surface.storeys import APART, links_of
from surefoot.kernels.bundles import Bundle

__all__ = ["DIRECTIONS", "Surface"]

DIRECTIONS = np.array([(1, 0), (0, 1), (-1, 0), (0, -1)], dtype=np.int32)
"""(4, 2) int32: the steps in (ix, iy) of the four columns of `Surface.storey`; direction d + 2 goes back."""


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """The cells, as a structure of arrays. All coordinates are relative to `origin`."""

    origin: np.ndarray
    """(3,) float64 [m], world coordinates of the grid's corner; x and y are multiples of the resolution."""
    resolution: float
    """[m], side of a cell."""
    shape: tuple[int, int]
    """(nx, ny) columns. Column c = ix·ny + iy has its centre at ((ix + ½), (iy + ½))·resolution."""
    column_start: np.ndarray
    """(nx·ny + 1,) int32: the cells of column c are column_start[c]:column_start[c + 1], lowest first."""
    milestone: np.ndarray
    """(⌈n / 32⌉ + 1,) int32: the columns of every 32nd cell and of the last (`columns.py`)."""
    floor: FloorStore
    """`height` and `gradient` of the cells, packed."""
    storey: np.ndarray
    """(n, 4) uint8: which cell of the column in +x, +y, -x, -y one walks to, the lowest being 0, or `APART`
    where walking ends; see `navmesh.surface.storeys`."""
    clearance: np.ndarray
    """(n,) float64 [m]: horizontal distance from the cell's centre to where walking ends."""
    choice: np.ndarray
    """(n,) uint8: how the place was carried to the cell, see `navmesh.surface.clearance`."""
    kept_nearest: np.ndarray
    """(n, 2) float64: `nearest` where something changes it in place (zones), else (0, 2): it is recalled."""
    source: np.ndarray
    """(n,) int32: the list of blockers with that place in it, or -1 where walking ends nowhere."""
    list_cell: np.ndarray
    """(l,) int32, rising: the cell that each list of blockers is of; few cells have one."""
    list_start: np.ndarray
    """(l + 1,) int32: the blockers of list i are list_start[i]:list_start[i + 1]."""
    blocker: np.ndarray
    """(k, 4) float64 [m]: x, y of both ends of a segment at which walking ends, exact; see
    `navmesh.surface.blockers`."""

    def __len__(self) -> int:
        return len(self.clearance)

    @property
    def field(self) -> Any:
        """What kernels need to measure distances: a `navmesh.surface.net.NET` without floor and graph."""
        return self.net()

    def net(self, **graph: Any) -> Any:
        """A `NET` of the surface, with what is given of the rest, and `NO_GRAPH` for what is not."""
        return Bundle(
            NET, cell=self.resolution, nx=self.shape[0], ny=self.shape[1], column_start=self.column_start,
            milestone=self.milestone, storey=self.storey, nearest=self.kept_nearest,
            clearance=self.clearance, choice=self.choice, source=self.source,
            list_cell=self.list_cell, list_start=self.list_start, blocker=self.blocker,
            **{**NO_GRAPH, **graph},
        )  # fmt: skip

    @property
    def cell_column(self) -> np.ndarray:
        """(n,) int32: the column of each cell. Worked out for all cells each time."""
        return columns_of_all(self.column_start)

    @property
    def blocker_start(self) -> np.ndarray:
        """(n + 1,) int32: the blockers beside cell c are blocker_start[c]:blocker_start[c + 1]. Worked out
        each time."""
        count = np.zeros(len(self) + 1, np.int32)
        count[self.list_cell + 1] = np.diff(self.list_start[: len(self.list_cell) + 1])
        return np.cumsum(count, dtype=np.int32)

    @property
    def link(self) -> np.ndarray:
        """(n, 4) int32: the cell that one walks to in +x, +y, -x, -y, or -1 where walking ends. Symmetric.
        Worked out for all cells each time."""
        return links_of(self.field)

    @property
    def nearest(self) -> np.ndarray:
        """(n, 2) float64 [m]: the vector from the cell's centre to the nearest place where walking ends; its
        length is `clearance`. Recalled for all cells each time."""
        if len(self.kept_nearest):
            return self.kept_nearest
        nearest = np.empty((len(self), 2))
        recall(self.field, self.column_start, self.shape[0], nearest)
        return nearest

    @property
    def height(self) -> np.ndarray:
        """(n,) float64 [m]: height of the floor at the cell's centre, above origin[2]; unpacked each time."""
        return self.floor.unpacked(self.column_start)[0]

    @property
    def gradient(self) -> np.ndarray:
        """(n, 2) float64: slope of the floor at the cell's centre, dz/dx and dz/dy; on a riser cut to what
        `max_slope` allows. Unpacked each time."""
        return self.floor.unpacked(self.column_start)[1]

    def columns(self, cells: np.ndarray) -> np.ndarray:
        """`cell_column` (k,) of ``cells`` (k,)."""
        return columns_of(self.column_start, self.milestone, np.asarray(cells, np.int64))

    def links(self, cells: np.ndarray) -> np.ndarray:
        """`link` (k, 4) of ``cells`` (k,)."""
        storey = self.storey[cells]
        beside = self.columns(cells)[:, None] + DIRECTIONS @ np.array([self.shape[1], 1], np.int32)
        start = self.column_start[np.clip(beside, 0, len(self.column_start) - 1)]
        return np.where(storey == APART, -1, start + storey)

    def heights(self, cells: np.ndarray) -> np.ndarray:
        """`height` of ``cells`` (k,)."""
        return self.floor.height[self._floors(cells)]

    def gradients(self, cells: np.ndarray) -> np.ndarray:
        """`gradient` (k, 2) of ``cells`` (k,)."""
        return self.floor.slopes[self.floor.slope[self._floors(cells)]]

    def _floors(self, cells: np.ndarray) -> np.ndarray:
        return self.floor.places(self.column_start, self.columns(cells), cells)

    def centers(self, cells: np.ndarray | None = None) -> np.ndarray:
        """World coordinates (k, 3) float64 of the centres of ``cells`` (k,), or of all."""
        columns = self.cell_column if cells is None else self.columns(cells)
        heights = self.height if cells is None else self.heights(cells)
        ix, iy = np.divmod(columns, self.shape[1])
        half = np.stack([ix + 0.5, iy + 0.5], axis=1) * self.resolution
        return np.column_stack([half, heights]) + self.origin

    def lifted(self, places: np.ndarray, cells: np.ndarray) -> np.ndarray:
        """World coordinates (k, 3) float64 of ``places`` (k, 2) [m], relative to the origin, on the floor of
        ``cells`` (k,)."""
        centers = self.centers(cells) - self.origin
        rise = np.einsum("ij,ij->i", places - centers[:, :2], self.gradients(cells))
        return np.column_stack([places, centers[:, 2] + rise]) + self.origin
