"""Slow, obvious versions of the kernels that find paths, and levels to compare on."""

import heapq
import itertools
import math

import numpy as np
from shapes import box, join, plane

from navmesh import NodeGraph, Terrain, WalkRules

__all__ = [
    "build",
    "chain_cost",
    "crossing",
    "dense_walk",
    "pillars",
    "pillars_level",
    "plain_search",
    "rounded_shortest",
    "turned",
]


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
    for i in range(count + 1):
        p = a + (b - a) * (i / count)
        jx, jy = (int(v // surface.resolution) for v in p)
        while (ix, iy) != (jx, jy):
            way = (0 if jx > ix else 2) if jx != ix else (1 if jy > iy else 3)
            cell = int(surface.link[cell, way])
            if cell < 0:
                return False, cell, -1.0
            ix, iy = divmod(int(surface.cell_column[cell]), surface.shape[1])
        around = {cell, *(int(k) for k in surface.link[cell] if k >= 0)}
        for k in around:
            kx, ky = divmod(int(surface.cell_column[k]), surface.shape[1])
            centre = (np.array([kx, ky]) + 0.5) * surface.resolution
            least = min(least, float(np.linalg.norm(p - centre - surface.nearest[k])))
    return True, cell, least


def crossing(left, right, a, b) -> np.ndarray:
    """The point of the portal left-right (3,) on the shortest way from a over it to b: by golden section."""
    low, high = 0.0, 1.0
    shrink = (math.sqrt(5.0) - 1.0) / 2.0

    def length(t: float) -> float:
        p = left + t * (right - left)
        return math.dist(a[:2], p[:2]) + math.dist(p[:2], b[:2])

    for _ in range(80):
        one, two = high - shrink * (high - low), low + shrink * (high - low)
        if length(one) <= length(two):
            high = two
        else:
            low = one
    return left + 0.5 * (low + high) * (right - left)


def plain_search(start, target, portal, begin: int, end: int, s, g) -> tuple[float, list[int]] | None:
    """A* along entry points over doors (`navmesh.structs.make_doors`): (cost, nodes), or None."""
    best = {begin: (math.dist(s, g), 0.0, np.asarray(s), -1)}
    heap = [(math.dist(s, g), begin)]
    while heap:
        total, node = heapq.heappop(heap)
        known, cost, entry, parent = best[node]
        if total > known:
            continue
        if node == end:
            nodes = [node]
            while parent >= 0:
                nodes.append(parent)
                parent = best[parent][3]
            return total, nodes[::-1]
        for door in range(start[node], start[node + 1]):
            other = int(target[door])
            if other == parent:
                continue
            at = crossing(portal[door, :3], portal[door, 3:], entry, np.asarray(g))
            there = cost + math.dist(entry, at)
            total = there + math.dist(at, g)
            if other not in best or total < best[other][0] - 1e-9:
                best[other] = (total, there, at, node)
                heapq.heappush(heap, (total, other))
    return None


def chain_cost(start, target, portal, nodes: list[int], s, g) -> float:
    """Length from s through the doors between ``nodes`` to g, each crossed as `plain_search` crosses it."""
    cost, at = 0.0, np.asarray(s)
    for node, other in itertools.pairwise(nodes):
        door = next(d for d in range(start[node], start[node + 1]) if target[d] == other)
        there = crossing(portal[door, :3], portal[door, 3:], at, np.asarray(g))
        cost, at = cost + math.dist(at, there), there
    return cost + math.dist(at, g)


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
