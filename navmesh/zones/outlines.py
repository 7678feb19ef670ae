"""The outline of a zone, and which cells and links of the surface it concerns."""

from collections.abc import Mapping
from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from navmesh.errors import NavmeshError
from navmesh.obstacles.free_length import cells_of
from navmesh.surface.columns import column_of
from navmesh.surface.floor_store import height_of
from navmesh.surface.storeys import linked
from navmesh.surface.surface import Surface
from navmesh.zones.distances import is_inside, touches
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["Concerned", "checked_outlines", "concerned_by"]

_BESIDE = 1.5
"""Cells by which the outline may be farther from a cell than where walking ends, for the cell to know it."""


class Concerned(NamedTuple):
    """The cells that know a zone, by rising number, and the links that it cuts, both ways."""

    cell: np.ndarray
    """(k,) int32."""
    nearest: np.ndarray
    """(k, 2) float64 [m]: from each cell's centre to the outline; 0 inside."""
    cut: np.ndarray
    """(l, 2) int32: cell and direction."""


def checked_outlines(outlines: Any) -> dict[str, np.ndarray]:
    """The outlines (k, 3) float64 by name; `NavmeshError` where they are none."""
    if not isinstance(outlines, Mapping):
        raise NavmeshError(f"outlines: expected corners (k, 3) [m] by the zone's name, not {outlines!r}")
    checked = {}
    for name, corners in outlines.items():
        if not isinstance(name, str) or not name:
            raise NavmeshError(f"outlines: expected a name for each zone, not {name!r}")
        try:
            array = np.array(corners, dtype=np.float64)
        except (TypeError, ValueError):
            array = np.empty(0)
        if array.ndim != 2 or array.shape[1:] != (3,) or len(array) < 2:
            raise NavmeshError(
                f"zone {name!r}: expected two corners or more (k, 3) [m] on the floor, not {corners!r}"
            )
        _check_corners(name, array)
        checked[name] = array
    return checked


def _check_corners(name: str, corners: np.ndarray) -> None:
    finite = np.isfinite(corners).all(axis=1)
    if not finite.all():
        at = int(np.argmin(finite))
        raise NavmeshError(
            f"zone {name!r}, corner {at}: expected finite coordinates [m], not {corners[at].tolist()}"
        )
    flat = corners[:, :2]
    if (flat == flat[0]).all():
        raise NavmeshError(
            f"zone {name!r}: expected corners at different places, all are at {flat[0].tolist()}"
        )
    count = len(flat)
    for i in range(count):
        for j in range(i + 2, count if i else count - 1):
            side = np.stack([flat[j], flat[(j + 1) % count]])
            if _cross(flat[i], flat[i + 1], *side):
                raise NavmeshError(
                    f"zone {name!r}: the sides from corners {i} and {j} cross; expected the corners in order "
                    "round the zone"
                )


def _cross(a: np.ndarray, b: np.ndarray, p: np.ndarray, q: np.ndarray) -> bool:
    """Whether the lines from a to b and from p to q cross, but for their ends."""

    def turn(u: np.ndarray, v: np.ndarray, w: np.ndarray) -> float:
        return float((v[0] - u[0]) * (w[1] - u[1]) - (v[1] - u[1]) * (w[0] - u[0]))

    return turn(a, b, p) * turn(a, b, q) < 0.0 and turn(p, q, a) * turn(p, q, b) < 0.0


def concerned_by(
    outline: np.ndarray, surface: Surface, rise: float, mark: np.ndarray, number: int
) -> Concerned:
    """What an ``outline`` (k, 3) [m], relative to the surface's origin, concerns of a ``surface``, whose
    floor counts up to ``rise`` [m] above and below the outline.

    ``mark`` (n,) int32 are notes of which cells have been looked at for which ``number``, above 0.
    """
    low, high = outline[:, 2].min() - rise, outline[:, 2].max() + rise
    cell, nearest, cut = _concerned(
        np.ascontiguousarray(outline[:, :2]), low, high, cells_of(surface), surface.clearance, mark, number
    )  # fmt: skip
    order = np.argsort(cell, kind="stable")
    return Concerned(cell[order], nearest[order], cut)


@kernel(error_model="numpy")
def _to_outline(outline, x, y):
    """The vector from (x, y) to the nearest place on the outline."""
    best, dx, dy = np.inf, 0.0, 0.0
    j = outline.shape[0] - 1
    for i in range(outline.shape[0]):
        ax, ay = outline[j, 0] - x, outline[j, 1] - y
        ex, ey = outline[i, 0] - outline[j, 0], outline[i, 1] - outline[j, 1]
        length = ex * ex + ey * ey
        t = min(max(-(ax * ex + ay * ey) / length, 0.0), 1.0) if length > 0.0 else 0.0
        vx, vy = ax + t * ex, ay + t * ey
        if vx * vx + vy * vy < best:
            best, dx, dy = vx * vx + vy * vy, vx, vy
        j = i
    return dx, dy


@kernel(error_model="numpy", forceinline=True)
def _is_cut(outline, low, high, cells, k, other, x, y, px, py):
    """Whether the outline cuts the link from cell ``k``, at (x, y), to the ``other``, at p."""
    if not (low <= height_of(cells, k) <= high or low <= height_of(cells, other) <= high):
        return False
    return touches(outline, x, y, px, py)


@allocating_kernel(error_model="numpy")
def _concerned(outline, low, high, cells, clearance, mark, number):
    column_start, nx, ny, h = cells.column_start, cells.nx, cells.ny, cells.size
    queue = np.empty(1024, np.int32)
    size = 0
    cut = np.empty((256, 2), np.int32)
    cuts = 0
    left, right = np.inf, -np.inf
    near, far = np.inf, -np.inf
    for i in range(outline.shape[0]):
        left, right = min(left, outline[i, 0]), max(right, outline[i, 0])
        near, far = min(near, outline[i, 1]), max(far, outline[i, 1])
    # from the cells inside, those with a cut link and those under the outline or beside it outwards
    for ix in range(max(int(np.floor(left / h)) - 1, 0), min(int(np.floor(right / h)) + 2, nx)):
        for iy in range(max(int(np.floor(near / h)) - 1, 0), min(int(np.floor(far / h)) + 2, ny)):
            x, y = (ix + 0.5) * h, (iy + 0.5) * h
            inside = is_inside(outline, x, y)
            dx, dy = _to_outline(outline, x, y)
            under = inside or dx * dx + dy * dy <= 0.5 * h * h
            for k in range(column_start[ix * ny + iy], column_start[ix * ny + iy + 1]):
                # what is nearer than where walking ends is seen, also where no cell is under it
                seen = dx * dx + dy * dy < clearance[k] * clearance[k]
                first = (under or seen) and low <= height_of(cells, k) <= high
                for d in range(4):
                    other = linked(cells, k, d)
                    if other < 0:
                        continue
                    px, py = x + ((d == 0) - (d == 2)) * h, y + ((d == 1) - (d == 3)) * h
                    if _is_cut(outline, low, high, cells, k, other, x, y, px, py):
                        if cuts == cut.shape[0]:
                            cut = np.concatenate((cut, np.empty_like(cut)))
                        cut[cuts, 0], cut[cuts, 1] = k, d
                        cuts += 1
                        first = True
                if first:
                    if size == queue.size:
                        queue = np.concatenate((queue, np.empty_like(queue)))
                    queue[size] = k
                    size += 1
                    mark[k] = number
    found = np.empty(1024, np.int32)
    nearest = np.empty((1024, 2))
    count = 0
    head = 0
    while head < size:
        k = queue[head]
        head += 1
        column = column_of(cells, k)
        ix = column // ny
        x, y = (ix + 0.5) * h, (column - ix * ny + 0.5) * h
        dx, dy = 0.0, 0.0
        if not (low <= height_of(cells, k) <= high and is_inside(outline, x, y)):
            dx, dy = _to_outline(outline, x, y)
        if sqrt(dx * dx + dy * dy) > clearance[k] + _BESIDE * h:
            continue
        if count == found.size:
            found = np.concatenate((found, np.empty_like(found)))
            nearest = np.concatenate((nearest, np.empty_like(nearest)))
        found[count], nearest[count, 0], nearest[count, 1] = k, dx, dy
        count += 1
        for d in range(4):
            other = linked(cells, k, d)
            if other < 0 or mark[other] == number:
                continue
            px, py = x + ((d == 0) - (d == 2)) * h, y + ((d == 1) - (d == 3)) * h
            if _is_cut(outline, low, high, cells, k, other, x, y, px, py):
                continue
            mark[other] = number
            if size == queue.size:
                queue = np.concatenate((queue, np.empty_like(queue)))
            queue[size] = other
            size += 1
    return found[:count].copy(), nearest[:count].copy(), cut[:cuts].copy()
