"""What keeps two parts of a level apart: the easiest thing to mend, of all the places where they come near
each other.

Where is told by the graph's cells, what and how much by the mesh (`runtime.playtest.openings`). Great heights
are left to the cells: of all ways from one set of cells to another, the one whose highest ledge is lowest.
Joining cells, the least rise first, until the two sets are joined, finds it (Kruskal).
"""

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np
from scipy.spatial import KDTree

from navmesh.disjoint_sets import root
from navmesh.level.mesh_queries import MeshGrid, crossed, lowest_above
from navmesh.obstacles.free_length import cells_of
from navmesh.surface.floor_store import gradient_of, height_of
from navmesh.surface.storeys import APART
from runtime.playtest.floorplan import Allowance
from runtime.playtest.openings import Barrier, Opening
from runtime.playtest.site import Site
from surefoot.kernels import allocating_kernel

__all__ = ["SLIT", "Barriers", "opening_at"]

HIGHEST = 6.0
"""[m] ledges higher than this are not looked for."""
SLIT = 0.3
"""[m] passages narrower than this are cracks."""
_LOWEST = 0.5  # of the headroom: lower passages are no doors
_WALL = np.radians(60.0)  # steeper slopes are walls, and no ramps
_FAR = 8.0  # [m] that two parts may be apart
_TILE = 2.0  # [m] of a boundary that is looked at in one
_BESIDE = 1.6  # [m] around it
_MOST = 40  # places looked at, the nearest first


class Barriers:
    """Barriers of a `Site`; what is asked first is worked out once."""

    def __init__(self, site: Site) -> None:
        self.site = site
        self._steps: tuple[np.ndarray, np.ndarray] | None = None

    def between(self, of: np.ndarray, to: np.ndarray, highest: float) -> Barrier | None:
        """What keeps cells ``of`` (bool, per cell) from cells ``to``: the first kind of barrier that there is
        anywhere between them, and of this kind the one that keeps them apart the least. Steps up (or down)
        are told up to ``highest`` [m]."""
        rules = self.site.graph.rules
        places = list(self._places(of, to))
        if fits := [each for each in places if each.passes]:
            # the graph, which samples, has lost what only just passes
            return fits[0].tight()
        low, steep = _LOWEST * rules.headroom, max(_WALL, rules.max_slope)
        high = min(highest, 0.95 * rules.headroom)
        return (
            _best(places, Opening.narrow, SLIT, 1.0)
            or self._centred(_best(places, Opening.low, low, 1.0), of, to)
            or _best(places, Opening.steep, steep, -1.0)
            or _best(places, Opening.rise, high, -1.0)
            or self._across(places, Opening.gap)
            or self._across(places, Opening.wall)
        )

    def _across(
        self, places: Sequence[Opening], find: Callable[[Opening, MeshGrid, np.ndarray], Barrier | None]
    ) -> Barrier | None:
        """The shortest way across that there is at any of ``places``."""
        mesh_grid, origin = self.site.mesh_grid, self.site.graph.surface.origin
        found = [each for place in places if (each := find(place, mesh_grid, origin)) is not None]
        return min(found, key=lambda each: each.size, default=None)

    def _centred(self, low: Barrier | None, of: np.ndarray, to: np.ndarray) -> Barrier | None:
        """A ``low`` passage once more, in the middle of a larger box: it may be wider than what was looked
        at."""
        if low is None:
            return None
        here, there = (self.site.graph.surface.centers(np.flatnonzero(side)) for side in (of, to))
        around = np.array([_TILE, _TILE, 0.0])
        again = opening_at(self.site, np.array([low.place - around, low.place + around]), here, there)
        return again.low(low.size - 0.01) or low

    def _places(self, of: np.ndarray, to: np.ndarray) -> Iterator[Opening]:
        """Where cells ``of`` and ``to`` come near each other, the nearest first."""
        surface = self.site.graph.surface
        here, there = np.flatnonzero(of), np.flatnonzero(to)
        if not len(here) or not len(there):
            return
        a, b = surface.centers(here), surface.centers(there)
        away, nearest = (np.asarray(each) for each in KDTree(a).query(b, distance_upper_bound=_FAR))
        near = np.flatnonzero(np.isfinite(away))
        near = near[np.argsort(away[near], kind="stable")]
        middles = 0.5 * (b[near] + a[nearest[near]])
        tiles = np.unique(np.floor(middles / _TILE), axis=0, return_index=True)[1]
        for k in near[np.sort(tiles)][:_MOST].tolist():
            ends = np.array([b[k], a[nearest[k]]])
            yield opening_at(self.site, ends, a, b)

    def ledge(self, of: np.ndarray, to: np.ndarray) -> Barrier | None:
        """The lowest ledge on the way from cells ``of`` (bool, per cell) to cells ``to``: how far up, or
        (negative) down, its highest one goes on the easiest way."""
        if self._steps is None:
            self._steps = self._all_steps()
        ends, rises = self._steps
        at, forward = _first_to_join(ends, of, to)
        if at < 0 or rises[at] == 0.0:
            return None
        low, high = self.site.graph.surface.centers(ends[at])
        span = np.array([[*(0.5 * (low + high))[:2], z] for z in (low[2], high[2])])
        return Barrier("rise", float(rises[at] if forward else -rises[at]), span[1], span)

    def _all_steps(self) -> tuple[np.ndarray, np.ndarray]:
        """Pairs (k, 2) of neighbouring cells, lower first, and the rise [m] of each, 0 where one walks; in
        the order of the rise."""
        surface, rules = self.site.graph.surface, self.site.graph.rules
        low, high, rise = _ledges(
            self.site.mesh_grid.arrays, cells_of(surface), surface.cell_column, rules.max_step, rules.headroom
        )
        link = surface.link
        walked = [np.flatnonzero(link[:, d] >= 0) for d in (0, 1)]
        source = np.concatenate([*walked, low])
        target = np.concatenate([*(link[cells, d] for d, cells in enumerate(walked)), high])
        rises = np.concatenate([np.zeros(len(source) - len(low)), rise])
        order = np.argsort(rises, kind="stable")
        return np.stack([source, target], axis=1)[order], rises[order]


def _best(
    places: Sequence[Opening], find: Callable[[Opening, float], Barrier | None], bound: float, sign: float
) -> Barrier | None:
    """The barrier with the greatest (``sign`` 1) or least (-1) size that ``find`` finds at any of ``places``,
    which takes the worst size worth finding, at first ``bound``."""
    best = None
    for place in places:
        found = find(place, bound)
        if found is not None and (best is None or sign * abs(found.size) > sign * abs(best.size)):
            best = found
            bound = math.radians(found.size) if found.kind == "steep" else abs(found.size)
    return best


def opening_at(site: Site, ends: np.ndarray, here: np.ndarray, there: np.ndarray) -> Opening:
    """The opening around ``ends`` (2, 3) [m] on its two sides; of ``here`` (k, 3) and ``there`` (m, 3) [m]
    what is near."""
    rules, radius = site.graph.rules, site.character.radius
    aside = _BESIDE + 2.0 * radius
    up = rules.max_step + 0.3
    margin = np.array([aside, aside, up])
    box = np.array([ends.min(axis=0) - margin, ends.max(axis=0) + margin])
    sides = (side[((side >= box[0]) & (side <= box[1])).all(axis=1)] for side in (here, there))
    return Opening(site.mesh, box, Allowance.of(rules), radius, *sides)


@allocating_kernel
def _first_to_join(ends, of, to):
    """The first of the pairs ``ends`` (k, 2), taken in order, that joins a member of ``of`` with one of
    ``to`` (Kruskal): its index, or -1, and whether its first end is on the side of ``of``."""
    parent = np.arange(len(of))
    has_of, has_to = of.copy(), to.copy()
    for k in range(len(ends)):
        a, b = root(parent, ends[k, 0]), root(parent, ends[k, 1])
        if a == b:
            continue
        if (has_of[a] and has_to[b]) or (has_of[b] and has_to[a]):
            return k, has_of[a]
        parent[a] = b
        has_of[b] |= has_of[a]
        has_to[b] |= has_to[a]
    return -1, False


@allocating_kernel
def _ledges(grid, cells, cell_column, step, headroom):
    """Neighbouring cells that one does not walk between, with nothing but a difference in height in the way.

    Returns (lower, higher (k,) int32, rise (k,) float64 [m], at their shared border).
    """
    start, storey, size, nx, ny = cells.column_start, cells.storey, cells.size, cells.nx, cells.ny
    most = 4 * len(cell_column)
    low = np.empty(most, np.int32)
    high = np.empty(most, np.int32)
    rise = np.empty(most, np.float64)
    count = 0
    half = 0.5 * size
    for c in range(len(cell_column)):
        column = cell_column[c]
        ix = column // ny
        iy = column - ix * ny
        for d in range(2):
            jx, jy = (ix + 1, iy) if d == 0 else (ix, iy + 1)
            if storey[c, d] != APART or jx >= nx or jy >= ny:
                continue
            z = height_of(cells, c) + gradient_of(cells, c)[d] * half
            for n in range(start[jx * ny + jy], start[jx * ny + jy + 1]):
                other = height_of(cells, n) - gradient_of(cells, n)[d] * half
                if storey[n, d + 2] != APART or abs(other - z) > HIGHEST or count >= most:
                    continue
                a, b = (c, n) if other >= z else (n, c)
                column_a, column_b = cell_column[a], cell_column[b]
                ax, ay = (column_a // ny + 0.5) * size, (column_a % ny + 0.5) * size
                bx, by = (column_b // ny + 0.5) * size, (column_b % ny + 0.5) * size
                top = max(height_of(cells, b), max(z, other))
                free = lowest_above(grid, ax, ay, height_of(cells, a) + 0.05, top + 0.6 * headroom) == np.inf
                for k in range(3):
                    up = top + step + (0.05 + 0.4 * k) * (headroom - step)
                    free = free and not crossed(grid, ax, ay, up, bx, by, up)
                if free:
                    low[count], high[count], rise[count] = a, b, abs(other - z)
                    count += 1
    return low[:count], high[:count], rise[:count]
