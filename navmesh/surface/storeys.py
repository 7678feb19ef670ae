"""Links between cells as storeys: which cell of the column on that side one walks to.

A byte says it, and it stays right however the cells of other columns are numbered: an update copies it.
"""

import numpy as np

from navmesh.errors import NavmeshError
from navmesh.surface.columns import column_of
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["APART", "MOST", "check_storeys", "linked", "links_of", "over", "storeys_of"]

APART = 255
"""The storey on a side on which walking ends."""
MOST = 255
"""Cells that a column can have."""


def check_storeys(column_start: np.ndarray, name: str) -> None:
    """Raise `NavmeshError` where a column has more than `MOST` cells."""
    if len(column_start) > 1 and (most := int(np.diff(column_start).max())) > MOST:
        raise NavmeshError(
            f"{name}: {most} floors above each other; expected at most {MOST}: check the unit scale"
        )


@kernel(error_model="numpy", forceinline=True)
def over(net, k, column, way):
    """The cell that one walks to from cell ``k`` of ``column`` in direction ``way``, see
    `navmesh.surface.surface.DIRECTIONS`; -1 where walking ends. ``net`` has column_start, storey and ny."""
    storey = np.int64(net.storey[k, way])
    if storey == APART:
        return np.int64(-1)
    step = np.int64(1) if way & 1 == 1 else np.int64(net.ny)
    return np.int64(net.column_start[column + step if way < 2 else column - step]) + storey


@kernel(error_model="numpy", forceinline=True)
def linked(net, k, way):
    """`over` of a cell whose column is yet to be looked up."""
    return over(net, k, column_of(net, k), way)


@allocating_kernel(nogil=True)
def storeys_of(column_start, cell_column, link):
    """(n, 4) uint8: the links (n, 4), numbers of cells or -1, as storeys."""
    storey = np.empty(link.shape, np.uint8)
    for c in range(link.shape[0]):
        for way in range(4):
            n = link[c, way]
            storey[c, way] = n - column_start[cell_column[n]] if n >= 0 else APART
    return storey


@allocating_kernel
def links_of(net):
    """(n, 4) int32: the numbers of the cells that storeys mean, or -1."""
    link = np.empty(net.storey.shape, np.int32)
    for c in range(link.shape[0]):
        for way in range(4):
            link[c, way] = linked(net, c, way)
    return link
