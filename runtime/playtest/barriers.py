"""What keeps two parts of a level apart: the lowest ledge, the widest passage, the narrowest gap, a wall.

The questions are for a bottleneck: of all ways from one set of places to another, the one whose worst place
is least bad. Joining places, the least bad first, until the two sets are joined, finds it (Kruskal).
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from scipy.spatial import KDTree

from navmesh.affordances import detect_obstacles
from navmesh.free_length import cells_of
from navmesh.links import make_links
from navmesh.obstacle_rules import ObstacleRules
from navmesh.probes import crossed, lowest_above
from runtime.playtest.site import Site

__all__ = ["Barrier", "Barriers", "width_at"]

HIGHEST = 6.0
"""[m] ledges higher than this are not looked for."""
_WIDEST_GAP = 5.0  # [m] gaps wider than this are not looked for
_WALL = 1.2  # [m] greatest thickness of a wall that two floors are told apart by
_LEVEL = 0.5  # [m] floors on both sides of a wall differ by at most this


class Barrier(NamedTuple):
    """The easiest place to get through. ``kind``: "rise" (negative: a fall), "narrow", "gap" or "wall";
    ``size`` [m]: height, width of the passage, width of the gap, thickness; ``place`` (3,) [m]."""

    kind: str
    size: float
    place: np.ndarray


class Barriers:
    """Barriers of a `Site`; what is asked first is worked out once."""

    def __init__(self, site: Site) -> None:
        self.site = site
        self._steps: tuple[np.ndarray, np.ndarray] | None = None
        self._passages: tuple[np.ndarray, np.ndarray] | None = None
        self._gaps = None

    def rise(self, of: np.ndarray, to: np.ndarray) -> Barrier | None:
        """The lowest ledge on the way from cells ``of`` (bool, per cell) to cells ``to``: how far up, or
        (negative) down, its highest one goes on the easiest way."""
        if self._steps is None:
            self._steps = self._all_steps()
        ends, rises = self._steps
        at, forward = _first_to_join(ends, of, to)
        if at < 0 or rises[at] == 0.0:
            return None
        surface = self.site.graph.surface
        low, high = surface.centers(ends[at])
        place = np.array([*(0.5 * (low + high))[:2], high[2]])
        return Barrier("rise", float(rises[at] if forward else -rises[at]), place)

    def narrow(self, of: np.ndarray, to: np.ndarray) -> Barrier | None:
        """The widest passage on foot from nodes ``of`` (bool, per node) to nodes ``to``; its whole width."""
        graph = self.site.graph
        if self._passages is None:
            source = np.repeat(np.arange(len(graph)), np.diff(graph.edge_start))
            wide = np.minimum(
                np.minimum(graph.radii[source], graph.radii[graph.edge_target]), graph.edge_width
            )
            order = np.argsort(-wide, kind="stable")
            self._passages = np.stack([source, graph.edge_target], axis=1)[order], wide[order]
        ends, wide = self._passages
        at, _ = _first_to_join(ends, of, to)
        if at < 0:
            return None
        pair = ends[at]
        place = graph.positions[pair[np.argmin(graph.radii[pair])]]
        return Barrier("narrow", max(width_at(self.site, place), 2.0 * float(wide[at])), place)

    def gap(self, of: np.ndarray, to: np.ndarray) -> Barrier | None:
        """The narrowest gap to leap from nodes ``of`` to nodes ``to``."""
        graph = self.site.graph
        if self._gaps is None:
            rules = ObstacleRules(
                gap_width=(0.4, _WIDEST_GAP), body_radius=max(self.site.character.radius, 0.05)
            )
            found = detect_obstacles(graph.terrain, graph.surface, graph.rules, rules)
            found = found.select(found.affordance == "gap")
            self._gaps = make_links(found, graph.surface, graph.rules, rules.body_radius)
        links = self._gaps
        start, end = graph.label[links.start_cell], graph.label[links.end_cell]
        across = np.flatnonzero((start >= 0) & (end >= 0) & of[start] & to[end])
        if len(across) == 0:
            return None
        best = across[np.argmin(links.height[across])]
        return Barrier("gap", float(links.height[best]), links.edge[best])

    def wall(self, of: np.ndarray, to: np.ndarray) -> Barrier | None:
        """The wall where the two sets of cells are nearest to each other at about the same height, if one
        stands there."""
        surface = self.site.graph.surface
        here, there = np.flatnonzero(of), np.flatnonzero(to)
        if not len(here) or not len(there):
            return None
        a, b = surface.centers(here), surface.centers(there)
        far = _WALL + 2.0 * self.site.character.radius
        away, nearest = (np.asarray(each) for each in KDTree(b).query(a, distance_upper_bound=far))
        near = np.isfinite(away)
        near[near] &= np.abs(a[near, 2] - b[nearest[near], 2]) <= _LEVEL
        if not near.any():
            return None
        best = int(np.flatnonzero(near)[np.argmin(away[near])])
        if not self._is_wall(a[best] - surface.origin, b[nearest[best]] - surface.origin):
            return None
        return Barrier("wall", float(away[best]), 0.5 * (a[best] + b[nearest[best]]))

    def _is_wall(self, here: np.ndarray, there: np.ndarray) -> bool:
        """Whether anything stands between two places, at the height of a body."""
        rules = self.site.graph.rules
        heights = np.linspace(rules.max_step + 0.05, 0.95 * rules.headroom, 4)
        return any(
            crossed(self.site.probe.arrays, *here[:2], here[2] + up, *there[:2], there[2] + up)
            for up in heights
        )

    def _all_steps(self) -> tuple[np.ndarray, np.ndarray]:
        """Pairs (k, 2) of neighbouring cells, lower first, and the rise [m] of each, 0 where one walks; in
        the order of the rise."""
        surface, rules = self.site.graph.surface, self.site.graph.rules
        low, high, rise = _ledges(
            self.site.probe.arrays, cells_of(surface), surface.cell_column, rules.max_step, rules.headroom
        )
        walked = [np.flatnonzero(surface.link[:, d] >= 0) for d in (0, 1)]
        source = np.concatenate([*walked, low])
        target = np.concatenate([*(surface.link[cells, d] for d, cells in enumerate(walked)), high])
        rises = np.concatenate([np.zeros(len(source) - len(low)), rise])
        order = np.argsort(rises, kind="stable")
        return np.stack([source, target], axis=1)[order], rises[order]


def width_at(site: Site, place: np.ndarray) -> float:
    """[m] from the nearest side of a passage at ``place`` (3,) to the opposite one, on the level's triangles.

    The graph knows a width that is up to a cell too small; where no wall confirms a wider one it stands.
    """
    graph = site.graph
    edge = graph.nearest_edge(place)
    away = place[:2] - edge.place
    away = away / max(float(np.linalg.norm(away)), 1e-9)
    ray = graph.cast_ray(place, place + _WIDEST_GAP * np.append(away, 0.0))
    least = float(edge.distance + np.linalg.norm((ray.end - place)[:2]))
    x, y, z = place - graph.surface.origin
    knee = z + graph.rules.max_step + 0.05
    walls = [_to_wall(site.probe.arrays, x, y, knee, sign * away[0], sign * away[1]) for sign in (1.0, -1.0)]
    return sum(walls) if sum(walls) <= least + graph.surface.resolution else least


@njit(cache=True)
def _to_wall(grid, x, y, z, dx, dy):
    """[m] from (x, y, z) in the direction (dx, dy) to the first triangle, at most `_WIDEST_GAP`."""
    if not crossed(grid, x, y, z, x + _WIDEST_GAP * dx, y + _WIDEST_GAP * dy, z):
        return _WIDEST_GAP
    low, high = 0.0, _WIDEST_GAP
    while high - low > 1e-3:
        middle = 0.5 * (low + high)
        if crossed(grid, x, y, z, x + middle * dx, y + middle * dy, z):
            high = middle
        else:
            low = middle
    return low


@njit(cache=True)
def _root(parent, k):
    while parent[k] != k:
        parent[k] = parent[parent[k]]
        k = parent[k]
    return k


@njit(cache=True)
def _first_to_join(ends, of, to):
    """The first of the pairs ``ends`` (k, 2), taken in order, that joins a member of ``of`` with one of
    ``to`` (Kruskal): its index, or -1, and whether its first end is on the side of ``of``."""
    parent = np.arange(len(of))
    has_of, has_to = of.copy(), to.copy()
    for k in range(len(ends)):
        a, b = _root(parent, ends[k, 0]), _root(parent, ends[k, 1])
        if a == b:
            continue
        if (has_of[a] and has_to[b]) or (has_of[b] and has_to[a]):
            return k, has_of[a]
        parent[a] = b
        has_of[b] |= has_of[a]
        has_to[b] |= has_to[a]
    return -1, False


@njit(cache=True)
def _ledges(grid, cells, cell_column, step, headroom):
    """Neighbouring cells that one does not walk between, with nothing but a difference in height in the way.

    Returns (lower, higher (k,) int32, rise (k,) float64 [m], at their shared border).
    """
    start, _, height, gradient, link, size, nx, ny = cells
    most = 4 * len(height)
    low = np.empty(most, np.int32)
    high = np.empty(most, np.int32)
    rise = np.empty(most, np.float64)
    count = 0
    half = 0.5 * size
    for c in range(len(height)):
        column = cell_column[c]
        ix = column // ny
        iy = column - ix * ny
        for d in range(2):
            jx, jy = (ix + 1, iy) if d == 0 else (ix, iy + 1)
            if link[c, d] >= 0 or jx >= nx or jy >= ny:
                continue
            z = height[c] + gradient[c, d] * half
            for n in range(start[jx * ny + jy], start[jx * ny + jy + 1]):
                other = height[n] - gradient[n, d] * half
                if link[n, d + 2] >= 0 or abs(other - z) > HIGHEST or count >= most:
                    continue
                a, b = (c, n) if other >= z else (n, c)
                column_a, column_b = cell_column[a], cell_column[b]
                ax, ay = (column_a // ny + 0.5) * size, (column_a % ny + 0.5) * size
                bx, by = (column_b // ny + 0.5) * size, (column_b % ny + 0.5) * size
                top = max(height[b], max(z, other))
                free = lowest_above(grid, ax, ay, height[a] + 0.05, top + 0.6 * headroom) == np.inf
                for k in range(3):
                    up = top + step + (0.05 + 0.4 * k) * (headroom - step)
                    free = free and not crossed(grid, ax, ay, up, bx, by, up)
                if free:
                    low[count], high[count], rise[count] = a, b, abs(other - z)
                    count += 1
    return low[:count], high[:count], rise[:count]
