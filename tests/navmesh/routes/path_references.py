"""Slow, obvious versions of the kernels that find paths, and levels to compare on."""

import heapq
import math

import numpy as np

from navmesh import NodeGraph, Terrain, WalkRules
from tests.navmesh.shapes import box, join, plane

__all__ = [
    "build",
    "dense_walk",
    "pillars",
    "pillars_level",
    "plain_search",
    "rounded_shortest",
    "turned",
]

FIELD_ERROR = 0.002
"""[m] by which the clearance field may read too wide, see docs/how-it-works/navmesh.md. It never reads too
narrow."""


def pillars(
    rng: np.random.Generator, count: int, size: float = 14.0
) -> list[tuple[float, float, float, float]]:
    """Rectangles (x0, x1, y0, y1) of pillars on a floor of ``size`` [m]; they may touch."""
    low = rng.uniform(1.0, size - 3.0, (count, 2))
    wide = rng.uniform(0.3, 2.5, (count, 2))
    return [(x, x + w, y, y + d) for (x, y), (w, d) in zip(low.tolist(), wide.tolist(), strict=True)]


def pillars_level(rectangles, size: float = 14.0) -> tuple[np.ndarray, np.ndarray]:
    """The floor with the pillars on it, as a mesh."""
    return join(plane(0.0, size, 0.0, size), *(box(*r, 0.0, 3.0) for r in rectangles))


def turned(vertices: np.ndarray, angle: float) -> np.ndarray:
    """``vertices`` (v, 3), turned about the vertical axis by ``angle`` [rad]."""
    c, s = math.cos(angle), math.sin(angle)
    return vertices @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


def build(vertices: np.ndarray, faces: np.ndarray, **rules: float) -> NodeGraph:
    """The graph of a mesh."""
    return NodeGraph.build(Terrain.from_arrays(vertices, faces), WalkRules(**rules), obstacle_rules=None)


def dense_walk(
    surface, cell: int, a: np.ndarray, b: np.ndarray, step: float = 1e-3
) -> tuple[bool, int, float]:
    """Walk a-b (relative to the origin) in tiny steps: (reached, last cell, least gap to what ends walking).

    The gap is the distance to the nearest of the places that the cell under the point and those beside know.
    """
    count = max(1, math.ceil(float(np.linalg.norm(b - a)) / step))
    least = math.inf
    ix, iy = divmod(int(surface.cell_column[cell]), surface.shape[1])
    here, ends, along, squared = -1, np.empty((0, 4)), np.empty((0, 2)), np.empty(0)
    for i in range(count + 1):
        p = a + (b - a) * (i / count)
        jx, jy = (int(v // surface.resolution) for v in p)
        while (ix, iy) != (jx, jy):
            way = (0 if jx > ix else 2) if jx != ix else (1 if jy > iy else 3)
            cell = int(surface.link[cell, way])
            if cell < 0:
                return False, cell, -1.0
            ix, iy = divmod(int(surface.cell_column[cell]), surface.shape[1])
        if cell != here:
            here, ends = cell, _ends_about(surface, cell)
            along = ends[:, 2:] - ends[:, :2]
            squared = np.maximum(np.sum(along**2, axis=1), 1e-18)
        if len(ends):
            away = p - ends[:, :2]
            share = np.clip(np.sum(away * along, axis=1) / squared, 0.0, 1.0)
            least = min(least, float(np.linalg.norm(away - share[:, None] * along, axis=1).min()))
    return True, cell, least


def _ends_about(surface, cell: int) -> np.ndarray:
    """Segments (n, 4) at which walking ends that a cell and those beside it know."""
    beside = [int(k) for k in surface.link[cell] if k >= 0]
    around = {cell, *beside, *(int(k) for other in beside for k in surface.link[other] if k >= 0)}
    sources = {int(surface.source[k]) for k in around} - {-1}
    starts = surface.list_start
    segments = [surface.blocker[starts[k] : starts[k + 1]] for k in sources]
    return np.concatenate([np.empty((0, 4)), *segments])


def _crosses(a, b, portal) -> bool:
    """Whether a-b crosses the portal (6,) from its right side to its left, or touches it."""
    left, right = portal[:2], portal[3:5]
    u, v = b[:2] - a[:2], right - left
    turn = u[0] * v[1] - u[1] * v[0]
    if abs(turn) < 1e-12:
        return True
    w = left - a[:2]
    t = (w[0] * u[1] - w[1] * u[0]) / turn
    return -1e-9 <= t <= 1.0 + 1e-9


def line_length(portals: list[np.ndarray], s: np.ndarray, g: np.ndarray) -> float:
    """Length of the shortest line from s through ``portals`` (6,) in their order to g: it turns at their ends
    only, and goes straight between turns where it crosses all portals between."""
    rows = [(s, -1)] + [(p[side : side + 3], k) for k, p in enumerate(portals) for side in (0, 3)]
    rows.append((g, len(portals)))
    best = [0.0] + [math.inf] * (len(rows) - 1)
    for j in range(1, len(rows)):
        for i in range(j):
            (a, k), (b, m) = rows[i], rows[j]
            if (k < m or i == 0) and all(_crosses(a, b, portals[n]) for n in range(k + 1, m)):
                best[j] = min(best[j], best[i] + math.dist(a, b))
    return best[-1]


def plain_search(start, target, portal, begin: int, end: int, s, g) -> tuple[float, list[int]] | None:
    """The chain of nodes with the shortest line through its portals, of all chains: (length, nodes).

    None where there is none, or where more than 1500 have to be looked at.
    """
    heap = [(math.dist(s, g), [begin], [])]
    for _ in range(1500):
        if not heap:
            return None
        length, nodes, doors = heapq.heappop(heap)
        if nodes[-1] == end:
            return length, nodes
        for door in range(start[nodes[-1]], start[nodes[-1] + 1]):
            other = int(target[door])
            if other not in nodes:
                line = [portal[each] for each in [*doors, door]]
                heapq.heappush(heap, (line_length(line, s, g), [*nodes, other], [*doors, door]))
    return None


def rounded_shortest(start, goal, corner, radius: float) -> float:
    """Length of the shortest way from start to goal round a corner point, ``radius`` away from it, on the
    side that lies counter-clockwise from the start."""
    s, g = np.asarray(start) - corner, np.asarray(goal) - corner
    ds, dg = float(np.linalg.norm(s)), float(np.linalg.norm(g))
    sweep = (math.atan2(g[1], g[0]) - math.atan2(s[1], s[0])) % (2.0 * math.pi)
    turn = sweep - math.acos(radius / ds) - math.acos(radius / dg)
    if turn <= 0.0:
        return float(np.linalg.norm(s - g))
    return math.sqrt(ds**2 - radius**2) + math.sqrt(dg**2 - radius**2) + radius * turn


def scene(seed: int, count: int = 7) -> tuple[NodeGraph, np.random.Generator]:
    rng = np.random.default_rng(seed)
    return build(*pillars_level(pillars(rng, count))), rng


def gap_of(rectangles, points: np.ndarray, size: float = 14.0) -> np.ndarray:
    """Distance of ``points`` (n, 3) to the pillars and to the rim of the floor."""
    x, y = points[:, 0], points[:, 1]
    gap = np.minimum(np.minimum(x, size - x), np.minimum(y, size - y))
    for x0, x1, y0, y1 in rectangles:
        dx = np.maximum(np.maximum(x0 - x, x - x1), 0.0)
        dy = np.maximum(np.maximum(y0 - y, y - y1), 0.0)
        gap = np.minimum(gap, np.hypot(dx, dy))
    return gap
