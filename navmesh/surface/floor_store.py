"""The heights and slopes of all cells' floors, in blocks of columns; blocks that are alike are kept once.

Much of a level is level ground or a few planes. So each block of `SIDE` columns says where in a pool the
heights of its cells lie, and many blocks lie in the same place; slopes are numbers of rows of a table. What a
block says does not depend on how cells are numbered: an update replaces the blocks that it touches.
"""

import threading
from dataclasses import dataclass, field

import numpy as np

from navmesh.level.raster import Patch
from navmesh.surface.columns import column_of
from surefoot.kernels import allocating_kernel, kernel

__all__ = [
    "SIDE",
    "FloorStore",
    "gradient_in",
    "gradient_of",
    "height_in",
    "height_of",
    "join_floors",
    "pack_floors",
    "renew_floors",
]

_SHIFT = 5
SIDE = 1 << _SHIFT
"""Columns in a block, in the order of their numbers."""
_STALE = 8
"""All is packed anew when what updates have added is more than one part in so many of the cells."""
_FREE = 65536  # cells that updates may add before that is looked at
_LOCK = threading.Lock()


@dataclass(slots=True, eq=False)
class _Pool:
    """What several versions of a level share. Only what lies beyond ``used`` is ever written."""

    height: np.ndarray
    slope: np.ndarray
    slopes: np.ndarray
    used: int
    used_slopes: int


@dataclass(frozen=True, slots=True, eq=False)
class FloorStore:
    """The floors of the cells of a grid, or of a part of it."""

    at: np.ndarray
    """(blocks,) int32: where the cells of each block begin in the pool."""
    pool: _Pool = field(repr=False)
    size: int
    """Cells in the pool that are of this version, or of others that it comes from."""
    slopes_size: int
    """Rows of the table of slopes that are."""
    packed: int
    """Cells in the pool when all was packed last."""

    @property
    def height(self) -> np.ndarray:
        """(p,) float64 [m], the pool: heights above the surface's origin."""
        return self.pool.height

    @property
    def slope(self) -> np.ndarray:
        """(p,) int32: rows of ``slopes``."""
        return self.pool.slope

    @property
    def slopes(self) -> np.ndarray:
        """(s, 2) float64: dz/dx and dz/dy."""
        return self.pool.slopes

    def shift(self, column_start: np.ndarray) -> np.ndarray:
        """(blocks,) int32: what is to be added to a cell's number for its place in the pool."""
        return self.at - column_start[:-1:SIDE]

    def places(self, column_start: np.ndarray, columns: np.ndarray, cells: np.ndarray) -> np.ndarray:
        """Where in the pool ``cells`` (k,) of ``columns`` (k,) are."""
        block = columns >> _SHIFT
        return cells + self.at[block] - column_start[block << _SHIFT]

    def unpacked(self, column_start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The height (n,) and the gradient (n, 2) of all cells."""
        cells = int(column_start[-1])
        height, gradient = np.empty(cells), np.empty((cells, 2))
        _unpack(self.at, self.height, self.slope, self.slopes, column_start, height, gradient)
        return height, gradient


@kernel(error_model="numpy", forceinline=True)
def height_in(net, column, k):
    """Height [m] of the floor at the centre of cell ``k`` of ``column``."""
    return net.floor_height[k + net.floor_shift[column >> _SHIFT]]


@kernel(error_model="numpy", forceinline=True)
def height_of(net, k):
    """`height_in` of a cell whose column is yet to be looked up."""
    return height_in(net, column_of(net, k), k)


@kernel(error_model="numpy", forceinline=True)
def gradient_in(net, column, k):
    """Slope of the floor at the centre of cell ``k`` of ``column``, dz/dx and dz/dy."""
    slope = net.floor_slope[k + net.floor_shift[column >> _SHIFT]]
    return net.slopes[slope, 0], net.slopes[slope, 1]


@kernel(error_model="numpy", forceinline=True)
def gradient_of(net, k):
    """`gradient_in` of a cell whose column is yet to be looked up."""
    return gradient_in(net, column_of(net, k), k)


def pack_floors(column_start: np.ndarray, height: np.ndarray, gradient: np.ndarray) -> FloorStore:
    """The floors of cells with ``height`` (n,) [m] and ``gradient`` (n, 2), float64, bit for bit."""
    slope, slopes = _numbered(np.ascontiguousarray(gradient).view(np.int64))
    at, pool, pool_slope = _pooled(column_start, np.ascontiguousarray(height).view(np.int64), slope)
    return _store(at, pool.view(np.float64), pool_slope, slopes.view(np.float64))


def _store(at: np.ndarray, height: np.ndarray, slope: np.ndarray, slopes: np.ndarray) -> FloorStore:
    size, rows = len(height), len(slopes)
    return FloorStore(at, _Pool(height, slope, slopes, size, rows), size, rows, size)


def join_floors(parts: list[FloorStore]) -> FloorStore:
    """The floors of grids that follow each other, each but the last with a multiple of `SIDE` columns."""
    cells = np.cumsum([0, *(part.size for part in parts)])
    rows = np.cumsum([0, *(part.slopes_size for part in parts)])
    return _store(
        np.concatenate([part.at + np.int32(first) for part, first in zip(parts, cells, strict=False)]),
        np.concatenate([part.height for part in parts]),
        np.concatenate([part.slope + np.int32(first) for part, first in zip(parts, rows, strict=False)]),
        np.concatenate([part.slopes for part in parts]),
    )


def renew_floors(
    old: FloorStore, old_start: np.ndarray, new: FloorStore, new_start: np.ndarray, start: np.ndarray,
    window: tuple[int, int, int, int], patch: Patch, ny: int,
) -> FloorStore:  # fmt: skip
    """``old`` with the columns of ``window`` as in ``new``, the floors of ``patch``. ``old_start``,
    ``new_start`` and ``start`` are `column_start` of the one, the other, and of all after the change; ``ny``
    is of the whole grid."""
    blocks = _touched(np.array(window), ny, len(start) - 1)
    added = int((start[np.minimum((blocks + 1) * SIDE, len(start) - 1)] - start[blocks * SIDE]).sum())
    pool = _with_room(old, added, new.slopes_size)
    pool.slopes[old.slopes_size : old.slopes_size + new.slopes_size] = new.slopes[: new.slopes_size]
    at = old.at.copy()
    bits = pool.height.view(np.int64), pool.slope, pool.slopes.view(np.int64)  # 0.0 is not -0.0
    used = _put_blocks(
        blocks, at, old.at, old_start, new.at, new.height.view(np.int64), new.slope, new_start, start,
        np.array(window), patch, ny, old.size, old.slopes_size, *bits,
    )  # fmt: skip
    with _LOCK:
        if pool.used == old.size + added:
            pool.used = used  # the rest is free again
    renewed = FloorStore(at, pool, used, old.slopes_size + new.slopes_size, old.packed)
    if renewed.size - renewed.packed > _FREE + int(start[-1]) // _STALE:
        return pack_floors(start, *renewed.unpacked(start))
    return renewed


def _with_room(old: FloorStore, cells: int, rows: int) -> _Pool:
    """A pool that begins like that of ``old``, with so many cells and rows more that are for nobody else."""
    size, slopes = old.size + cells, old.slopes_size + rows
    with _LOCK:
        pool = old.pool
        if (pool.used, pool.used_slopes) != (old.size, old.slopes_size) or (
            size > len(pool.height) or slopes > len(pool.slopes)
        ):
            room, room_slopes = size + size // _STALE + _FREE, 2 * slopes
            pool = _Pool(
                _grown(pool.height, old.size, room), _grown(pool.slope, old.size, room),
                _grown(pool.slopes, old.slopes_size, room_slopes), 0, 0,
            )  # fmt: skip
        pool.used, pool.used_slopes = size, slopes
    return pool


def _grown(values: np.ndarray, used: int, room: int) -> np.ndarray:
    grown = np.empty((room, *values.shape[1:]), values.dtype)
    grown[:used] = values[:used]
    return grown


def _touched(window: np.ndarray, ny: int, columns: int) -> np.ndarray:
    """The blocks (b,) int64 with columns of ``window``, in order."""
    strips = np.arange(window[0], window[2], dtype=np.int64) * ny
    if window[1] >= window[3] or not len(strips):
        return np.empty(0, np.int64)
    first, last = (strips + window[1]) >> _SHIFT, (strips + window[3] - 1) >> _SHIFT
    mark = np.zeros((columns >> _SHIFT) + 2, np.int32)
    np.add.at(mark, first, 1)
    np.add.at(mark, last + 1, -1)
    return np.flatnonzero(np.cumsum(mark) > 0)


@kernel
def _put_blocks(
    blocks, at, old_at, old_start, new_at, new_height, new_slope, new_start, start, window, patch, ny,
    used, used_slopes, height, slope, slopes,
):  # fmt: skip
    """Write the ``blocks`` behind the ``used`` cells of the pool, and where they are into ``at``; those that
    are as they were stay where they are. Returns how many cells are used then."""
    columns = start.shape[0] - 1
    for i in range(blocks.shape[0]):
        block, begin = blocks[i], used
        for c in range(block << _SHIFT, min((block + 1) << _SHIFT, columns)):
            ix = c // ny
            iy = c - ix * ny
            size = start[c + 1] - start[c]
            if window[0] <= ix < window[2] and window[1] <= iy < window[3]:
                inside = (ix - patch.left) * patch.ny + iy - patch.near
                there = new_at[inside >> _SHIFT]
                there += new_start[inside] - new_start[inside >> _SHIFT << _SHIFT]
                for j in range(size):
                    height[used + j] = new_height[there + j]
                    slope[used + j] = new_slope[there + j] + used_slopes
            else:
                there = old_at[block] + old_start[c] - old_start[block << _SHIFT]
                for j in range(size):
                    height[used + j] = height[there + j]
                    slope[used + j] = slope[there + j]
            used += size
        last = min((block + 1) << _SHIFT, columns)
        there, size = np.int64(old_at[block]), old_start[last] - old_start[block << _SHIFT]
        same = size == used - begin
        for j in range(size if same else 0):
            a, b = slope[begin + j], slope[there + j]
            same &= height[begin + j] == height[there + j]
            same &= slopes[a, 0] == slopes[b, 0] and slopes[a, 1] == slopes[b, 1]
        if same:
            used = begin
        else:
            at[block] = begin
    return used


@kernel
def _unpack(at, pool, pool_slope, slopes, column_start, height, gradient):
    columns = column_start.shape[0] - 1
    for block in range(at.shape[0]):
        first = column_start[block << _SHIFT]
        last = column_start[min((block + 1) << _SHIFT, columns)]
        for k in range(first, last):
            there = at[block] + k - first
            height[k] = pool[there]
            gradient[k, 0], gradient[k, 1] = slopes[pool_slope[there], 0], slopes[pool_slope[there], 1]


_PRIME = np.int64(-7046029254386353131)  # of about 2^64 / 1.618: spreads what is multiplied by it


@kernel(forceinline=True)
def _mixed(hash_, value):
    hash_ = (hash_ ^ value) * _PRIME
    return hash_ ^ (hash_ >> np.int64(29))


@allocating_kernel(nogil=True)
def _numbered(gradient):
    """For each of the slopes (n, 2) int64, the bits of them, a number (n,) int32; and by number the slopes
    (s, 2)."""
    cells = gradient.shape[0]
    number, found = np.empty(cells, np.int32), np.empty((1024, 2), np.int64)
    table = np.full(4096, -1, np.int32)
    count, last = 0, np.int32(-1)
    for c in range(cells):
        p, q = gradient[c, 0], gradient[c, 1]
        if last >= 0 and found[last, 0] == p and found[last, 1] == q:
            number[c] = last
            continue
        if count == found.shape[0]:
            found = np.concatenate((found, np.empty_like(found)))
            table = np.full(2 * table.shape[0], -1, np.int32)
            for i in range(count):
                spot = _mixed(_mixed(np.int64(0), found[i, 0]), found[i, 1]) & (table.shape[0] - 1)
                while table[spot] >= 0:
                    spot = (spot + 1) & (table.shape[0] - 1)
                table[spot] = i
        spot = _mixed(_mixed(np.int64(0), p), q) & (table.shape[0] - 1)
        while table[spot] >= 0 and (found[table[spot], 0] != p or found[table[spot], 1] != q):
            spot = (spot + 1) & (table.shape[0] - 1)
        if table[spot] < 0:
            table[spot], found[count, 0], found[count, 1] = count, p, q
            count += 1
        last = table[spot]
        number[c] = last
    return number, found[:count].copy()


@allocating_kernel(nogil=True)
def _pooled(column_start, height, slope):
    """Where the cells of each block begin (blocks,) int32 in a pool of ``height`` (n,) int64, the bits of it,
    and ``slope`` (n,); and that pool."""
    columns = column_start.shape[0] - 1
    blocks = (columns + SIDE - 1) >> _SHIFT
    room = 64
    while room < 2 * blocks:
        room *= 2
    at, known = np.empty(blocks, np.int32), np.full(room, -1, np.int32)
    pool, pool_slope, used = np.empty_like(height), np.empty_like(slope), 0
    for block in range(blocks):
        first = column_start[block << _SHIFT]
        size = column_start[min((block + 1) << _SHIFT, columns)] - first
        code = np.int64(size)
        for k in range(first, first + size):
            code = _mixed(_mixed(code, height[k]), np.int64(slope[k]))
        spot = code & (room - 1)
        while known[spot] >= 0:
            there = at[known[spot]]
            alike = there + size <= used
            k = 0
            while alike and k < size:
                alike = pool[there + k] == height[first + k] and pool_slope[there + k] == slope[first + k]
                k += 1
            if alike:
                break
            spot = (spot + 1) & (room - 1)
        if known[spot] < 0:
            known[spot], at[block] = block, used
            for k in range(size):
                pool[used + k], pool_slope[used + k] = height[first + k], slope[first + k]
            used += size
        else:
            at[block] = at[known[spot]]
    return at, pool[:used].copy(), pool_slope[:used].copy()
