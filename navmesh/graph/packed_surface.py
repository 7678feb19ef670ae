"""A surface as a file holds it: only what cannot be worked out from the rest.

How many cells a column has and which storey a link leads to are small numbers, mostly the same, which pack
well. Links back, and clearances, are worked out when the file is read: that takes less time than to unpack
them would, and gives the same bits as the build (`navmesh.surface.build.surface_of`).
"""

import numpy as np

from navmesh.surface.build import Cells, Grid, lists_of, surface_of
from navmesh.surface.floor_store import pack_floors
from navmesh.surface.storeys import APART, MOST
from navmesh.surface.surface import Surface
from surefoot.files.schema import Array, Numbers
from surefoot.kernels import kernel

__all__ = ["PACKED_SURFACE", "columns_of", "pack_surface", "unpack_surface"]

PACKED_SURFACE: dict[str, Array] = {
    "origin": Numbers(3),
    "count": Numbers("columns", low=0, dtype="int32"),
    "height": Numbers("cells"),
    "gradient": Numbers("cells", 2),
    "storey": Numbers("cells", 2, low=0, dtype="int32"),
    "blocker_count": Numbers("cells", low=0, dtype="int32"),
    "blocker": Numbers("blockers", 4),
}
"""Arrays by name. count: cells in each column; storey: for the links in +x and +y which cell of the column
there, the lowest being 1, or 0 where walking ends; blocker_count: blockers of each cell. The others are those
of `Surface`."""
_SLACK = 1e-6  # [m] by which clearances may reach beyond the grid


def pack_surface(surface: Surface) -> dict[str, np.ndarray]:
    """The arrays of `PACKED_SURFACE`."""
    height, gradient = surface.floor.unpacked(surface.column_start)
    return {
        "origin": surface.origin,
        "count": np.diff(surface.column_start),
        "height": height,
        "gradient": gradient,
        "storey": (surface.storey[:, :2] + np.uint8(1)).astype(np.int32),  # APART becomes 0
        "blocker_count": np.diff(surface.blocker_start),
        "blocker": surface.blocker,
    }


def columns_of(count: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """The column of each of ``cells``, of surfaces with so many cells in each column."""
    return np.searchsorted(np.cumsum(count), cells, side="right")


def unpack_surface(arrays: dict[str, np.ndarray], resolution: float, shape: tuple[int, int]) -> Surface:
    """The surface that was packed into ``arrays``, which fit `PACKED_SURFACE`. Raises `ValueError`, saying
    what is wrong, for arrays that are those of no surface."""
    nx, ny = shape
    count, lists = arrays["count"], arrays["blocker_count"]
    cells, blockers = len(arrays["height"]), len(arrays["blocker"])
    if len(count) != nx * ny or int(count.sum(dtype=np.int64)) != cells:
        raise ValueError(f"surface_count is not of {nx} * {ny} columns with {cells} cells")
    if int(lists.sum(dtype=np.int64)) != blockers:
        raise ValueError(f"surface_blocker_count is not of {blockers} blockers")
    column = np.repeat(np.arange(nx * ny, dtype=np.int32), count)
    if len(count) and count.max() > MOST:
        raise ValueError(f"surface_count[{int(np.argmax(count))}] is more than {MOST}")
    start, storey = _starts(count), np.full((cells, 4), APART, np.uint8)
    odd = _link(start, column, arrays["storey"], storey, ny)
    if odd >= 0:
        raise ValueError(f"surface_storey[{odd}] leads to no cell beside it, or to one that another leads to")
    floor = pack_floors(start, arrays["height"], arrays["gradient"])
    found = Cells(start, storey, *lists_of(lists), arrays["blocker"], floor)
    surface = surface_of(found, Grid(arrays["origin"], resolution, shape))
    ix = column // np.int32(ny)
    iy = column - ix * np.int32(ny)
    room = np.minimum(np.minimum(ix, nx - 1 - ix), np.minimum(iy, ny - 1 - iy))
    out = surface.clearance > (room + 0.5) * resolution + _SLACK
    if out.any():
        raise ValueError(f"the clearance of cell {int(np.argmax(out))} reaches beyond the grid")
    return surface


def _starts(count: np.ndarray) -> np.ndarray:
    start = np.zeros(len(count) + 1, np.int32)
    np.cumsum(count, out=start[1:])
    return start


@kernel
def _link(column_start, cell_column, storey, both, ny):
    """Fill in ``both`` (n, 4), which is `APART`. Returns -1, or the first cell whose storeys are wrong."""
    for c in range(storey.shape[0]):
        column = cell_column[c]
        for d in range(2):
            if storey[c, d] == 0:
                continue
            other = column + (ny if d == 0 else 1)
            if other >= column_start.shape[0] - 1 or (d == 1 and other % ny == 0):
                return c
            n = column_start[other] + storey[c, d] - 1
            if n >= column_start[other + 1] or both[n, d + 2] != APART:
                return c
            both[c, d], both[n, d + 2] = storey[c, d] - 1, c - column_start[column]
    return -1
