"""Polygons of a mesh file as triangles that cover what the polygons cover, concave ones too."""

import mapbox_earcut
import numpy as np

__all__ = ["CrossingPolygon", "triangulate", "triangulate_owned"]

_FLAT = 1e-9  # areas below this share of the polygon's squared size are rounding
_PLANAR = 1e-3  # a polygon is planar if no corner is farther from its plane than this share of its size
_HUGE = 1e60  # polygons of a larger squared size are damage; whoever reads them refuses their coordinates
_SAME = 1e-3  # areas of polygon and triangles that differ by this share are different


class CrossingPolygon(ValueError):
    """The outline of polygon ``index`` crosses itself, so that nobody can say what it covers."""

    def __init__(self, index: int) -> None:
        self.index = index
        super().__init__("the outline of the polygon crosses itself; split it into triangles")


def triangulate(points: np.ndarray, corners: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """(f, 3) int64: triangles of the polygons, in their order and with their sense of rotation.

    ``points`` (v, 3) float64, finite; ``corners`` (k,) integers into them, polygon after polygon, of which
    ``sizes`` (p,) says how many corners each has. A polygon is looked at along its normal (Newell's). Those
    with fewer than three corners, or all in a line, have no triangles. Raises `CrossingPolygon` for a planar
    one whose outline crosses itself; one that is bent so far that it seems to is taken as it comes.
    """
    return triangulate_owned(points, corners, sizes)[0]


def triangulate_owned(
    points: np.ndarray, corners: np.ndarray, sizes: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """`triangulate`'s triangles, and for each the polygon that it is of, (f,) int64."""
    corners, sizes = np.asarray(corners, dtype=np.int64), np.asarray(sizes, dtype=np.int64)
    starts = np.cumsum(sizes) - sizes
    if len(sizes) and (sizes == 3).all():
        return corners.reshape(-1, 3), np.arange(len(sizes))
    faces, owners = [np.empty((0, 3), np.int64)], [np.empty(0, np.int64)]
    for size in np.unique(sizes[sizes >= 3]).tolist():
        own = np.flatnonzero(sizes == size)
        ring = corners[starts[own][:, None] + np.arange(size)]
        fans = _fan(ring)
        if size > 3:
            with np.errstate(over="ignore", invalid="ignore"):
                good = _upright(points, ring, fans)
            for k in np.flatnonzero(~good).tolist():
                faces.append(_cut(points[ring[k]], ring[k], int(own[k])))
                owners.append(np.full(len(faces[-1]), own[k]))
            fans, own = fans[good], own[good]
        faces.append(fans.reshape(-1, 3))
        owners.append(np.repeat(own, size - 2))
    owner = np.concatenate(owners)
    order = np.argsort(owner, kind="stable")
    return np.concatenate(faces)[order], owner[order]


def _fan(ring: np.ndarray) -> np.ndarray:
    """(m, n - 2, 3): the triangles around the first corner of polygons (m, n)."""
    first = np.broadcast_to(ring[:, :1], ring[:, 2:].shape)
    return np.stack([first, ring[:, 1:-1], ring[:, 2:]], axis=2)


def _upright(points: np.ndarray, ring: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(m,) bool: whether no triangle of a polygon is turned over. Then they cover what the polygon covers:
    their areas, with signs, add up to the polygon's area in any case."""
    good = np.empty(len(ring), dtype=bool)
    for part in np.array_split(np.arange(len(ring)), len(ring) * ring.shape[1] // 1_000_000 + 1):
        at = points[triangles[part]]
        twice = np.cross(at[:, :, 1] - at[:, :, 0], at[:, :, 2] - at[:, :, 0])
        normal = twice.sum(axis=1)
        length = np.linalg.norm(normal, axis=1)
        around = points[ring[part]]
        squared = (np.ptp(around, axis=1) ** 2).sum(axis=1)
        along = np.einsum("mti,mi->mt", twice, normal) / np.maximum(length, 1e-300)[:, None]
        flat = (along >= -_FLAT * squared[:, None]).all(axis=1) & (length > _FLAT * squared)
        good[part] = flat | ~(squared < _HUGE)
    return good


def _cut(at: np.ndarray, ring: np.ndarray, index: int) -> np.ndarray:
    """The triangles of one polygon with corners ``at`` (n, 3), called ``ring`` (n,), by clipping ears."""
    at = at - at[0]
    normal = np.cross(at, np.roll(at, -1, axis=0)).sum(axis=0)
    squared = float((np.ptp(at, axis=0) ** 2).sum())
    area = float(np.linalg.norm(normal))
    if area <= _FLAT * squared:
        if _encloses_nothing(at, squared):
            return np.empty((0, 3), np.int64)
        normal = np.linalg.svd(at - at.mean(axis=0), full_matrices=False)[2][2]
        return _bent(at, ring, normal, squared, index)
    normal /= area
    across = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    across /= np.linalg.norm(across)
    flat = np.ascontiguousarray(at @ np.stack([across, np.cross(normal, across)], axis=1))
    ears = mapbox_earcut.triangulate_float64(flat, np.array([len(flat)], np.uint32))
    triangles = ears.astype(np.int64).reshape(-1, 3)
    a, b, c = flat[triangles].transpose(1, 0, 2)
    twice = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    if abs(np.abs(twice).sum() - area) > _SAME * area + _FLAT * squared:
        return _bent(at, ring, normal, squared, index)
    triangles[twice < 0.0] = triangles[twice < 0.0][:, ::-1]
    return ring[triangles]


def _bent(at: np.ndarray, ring: np.ndarray, normal: np.ndarray, squared: float, index: int) -> np.ndarray:
    """The triangles of a polygon whose outline seems to cross itself, if it is bent: one of the surfaces that
    it spans."""
    if np.ptp(at @ normal) <= _PLANAR * np.sqrt(squared):
        raise CrossingPolygon(index)
    return _fan(ring[None]).reshape(-1, 3)


def _encloses_nothing(at: np.ndarray, squared: float) -> bool:
    """Whether an outline without area runs along a line, or goes back the way that it came."""
    far = at[np.linalg.norm(at, axis=1).argmax()]
    if np.linalg.norm(np.cross(at, far), axis=1).max() <= _FLAT * squared:
        return True
    left: list[tuple[float, ...]] = []
    for corner in [
        tuple(each) for each in at.tolist()
    ] * 2:  # twice: the turn back may be at the first corner
        if left and left[-1] == corner:
            continue
        if len(left) > 1 and left[-2] == corner:
            left.pop()
        else:
            left.append(corner)
    return len(set(left)) < 3
