# pyright: reportArgumentType=false, reportReturnType=false, reportIndexIssue=false, reportCallIssue=false
# pyright: reportAttributeAccessIssue=false, reportGeneralTypeIssues=false, reportOptionalSubscript=false
# shapely's types do not tell one shape from an array of them.
"""Holes: places where the floor ends with nothing below, all the way down; and where the level ends.

Which floors end so is asked of the graph's cells; how far the emptiness goes is a polygon, cut out of the
mesh.
"""

from typing import NamedTuple

import numpy as np
import shapely

from navmesh.level.mesh_queries import crossed
from navmesh.surface.storeys import APART
from navmesh.surface.surface import DIRECTIONS
from runtime.playtest.mesh import standing
from runtime.playtest.site import Site

__all__ = ["Hole", "find_holes"]

_WINDOW = 8.0  # [m] first looked at around a place, then twice as much, until the hole is whole
_STOREY = 1.0  # [m] rims nearer to each other in height are of the same hole


class Hole(NamedTuple):
    """A place without floor. ``place`` (3,) [m]: its middle, at the height of the rim (of an open edge: on
    the rim); ``outline``: seen from above; ``span`` (2, 3) [m]: across its narrow side; ``long`` [m]: its
    other side; ``rim`` (r, 3) [m]: where walking ends beside it; ``enclosed``: whether floor or walls are all
    around it, so that it is not the outer edge of the level."""

    place: np.ndarray
    outline: shapely.Geometry
    span: np.ndarray
    long: float
    rim: np.ndarray
    enclosed: bool

    @property
    def area(self) -> float:
        """[m²]"""
        return float(shapely.area(self.outline))


def find_holes(site: Site, reached: np.ndarray) -> list[Hole]:
    """The holes that a body can fall through that walks in the parts ``reached`` (p,) bool, and the open
    edges of the level there."""
    rim, over = _open_rim(site, reached)
    left = np.ones(len(rim), dtype=bool)
    holes = []
    while left.any():
        first = int(np.argmax(np.where(left, rim[:, 2], -np.inf)))
        outline, enclosed = _emptiness(site, over[first], float(rim[first, 2]))
        left[first] = False
        if shapely.is_empty(outline):
            continue
        mine = shapely.dwithin(outline, shapely.points(over[:, :2]), 0.01)
        if enclosed:  # there may be another hole below
            mine &= np.abs(rim[:, 2] - rim[first, 2]) <= _STOREY
        left &= ~mine
        mine[first] = True
        hole = _hole(outline, rim[mine], enclosed)
        if not enclosed or _width_inside(outline) >= site.character.stride:
            holes.append(hole)
    return holes


def _width_inside(outline: shapely.Geometry) -> float:
    """[m] the widest disc that fits in."""
    return 2.0 * float(shapely.length(shapely.maximum_inscribed_circle(outline, tolerance=0.005)))


def _hole(outline: shapely.Geometry, rim: np.ndarray, enclosed: bool) -> Hole:
    height = float(np.median(rim[:, 2]))
    corners = shapely.get_coordinates(shapely.minimum_rotated_rectangle(outline))[:4]
    sides = np.linalg.norm(corners - np.roll(corners, -1, axis=0), axis=1)
    k = int(np.argmax(sides))  # the narrow side is from the middle of a long side to the middle of the other
    ends = [0.5 * (corners[j % 4] + corners[(j + 1) % 4]) for j in (k, k + 2)]
    middle = shapely.centroid(outline)
    if not shapely.contains(outline, middle):
        middle = shapely.point_on_surface(outline)
    place = np.append(shapely.get_coordinates(middle)[0], height) if enclosed else rim[len(rim) // 2]
    span = np.column_stack([ends, [height, height]]) if enclosed else np.array([place, place])
    return Hole(place, outline, span, float(sides[k]), rim, enclosed)


def _open_rim(site: Site, reached: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where floor of the parts ``reached`` ends with nothing below and no wall between: centres of cells and,
    as high, of the empty squares beside them, (k, 3) [m] each."""
    surface, rules = site.graph.surface, site.graph.rules
    known = site.graph.label >= 0
    known[known] = np.append(reached, False)[site.node_part[site.graph.label[known]]]
    cell, way = np.nonzero((surface.storey == APART) & known[:, None])
    rim = surface.centers(cell)
    over = rim + np.column_stack([DIRECTIONS[way] * surface.resolution, np.zeros(len(way))])
    empty = ~_has_floor(site, over, rules.max_step)
    rim, over = rim[empty], over[empty]
    heights = rules.max_step + 0.05 + 0.3 * np.arange(4) * (rules.headroom - rules.max_step - 0.1)
    mesh_grid, origin = site.mesh_grid.arrays, surface.origin
    free = [
        not any(crossed(mesh_grid, ax, ay, az + up, bx, by, bz + up) for up in heights)
        for (ax, ay, az), (bx, by, bz) in zip(rim - origin, over - origin, strict=True)
    ]
    return rim[free], over[free]


def _has_floor(site: Site, points: np.ndarray, step: float) -> np.ndarray:
    """(k,) bool: whether a face that faces up is below ``points`` (k, 3) [m], or a ``step`` above."""
    mesh = site.mesh
    faces, tree = mesh.upward
    point, face = tree.query(shapely.points(points[:, :2]), predicate="intersects")
    plane = mesh.plane[faces[face]]
    high = np.einsum("kc,kc->k", plane[:, :2], points[point, :2]) + plane[:, 2]
    found = np.zeros(len(points), dtype=bool)
    found[point[high <= points[point, 2] + step + 1e-6]] = True
    return found


def _emptiness(site: Site, place: np.ndarray, height: float) -> tuple[shapely.Geometry, bool]:
    """The place without floor around ``place`` (3,), for one who stands at ``height`` [m], and whether it is
    enclosed; empty where a wall stands in it."""
    mesh, rules = site.mesh, site.graph.rules
    faces, tree = mesh.upward
    bounds = site.graph.terrain.bounds[:, :2] + np.array([[-1.0], [1.0]])
    half, point = 0.5 * _WINDOW, shapely.points(place[:2])
    while True:
        low, high = np.maximum(place[:2] - half, bounds[0]), np.minimum(place[:2] + half, bounds[1])
        window = shapely.box(*low, *high)
        near = tree.query(window)
        below = near[mesh.low[faces[near], 2] <= height + rules.max_step]
        floor = shapely.union_all(shapely.buffer(tree.geometries[below], 1e-4, join_style="mitre"))
        walls = standing(mesh, low, high, height + rules.max_step, height + rules.headroom)
        parts = shapely.get_parts(shapely.difference(window, shapely.union(floor, walls)))
        mine = parts[shapely.dwithin(parts, point, 1e-6)]
        if not len(mine):
            return shapely.Polygon(), False
        edge = shapely.boundary(window)
        if not shapely.dwithin(mine[0], edge, 1e-6):
            return mine[0], True
        if (low <= bounds[0]).all() and (high >= bounds[1]).all():
            return mine[0], False
        half *= 2.0
