"""What keeps two parts of a level apart: the easiest thing to mend, of all the places where they come near
each other.

Where is told by the graph's cells, what and how much by the mesh (`runtime.playtest.openings`). Great heights
are left to the cells: of all ways from one set of cells to another, the one whose highest ledge is lowest.
Joining floors that are walked on, the least rise first, until the two sets are joined, finds it (Kruskal).
"""

import math
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from navmesh.disjoint_sets import root
from navmesh.level.mesh_queries import MeshGrid, crossed, lowest_above
from navmesh.obstacles.free_length import cells_of
from navmesh.surface.floor_store import gradient_of, height_of
from navmesh.surface.storeys import APART
from runtime.playtest.floorplan import Allowance
from runtime.playtest.openings import Barrier, Opening
from runtime.playtest.sides import Side
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

    def between(self, of: Side, to: Side, highest: float) -> Barrier | None:
        """What keeps cells ``of`` from cells ``to``: the first kind of barrier that there is anywhere between
        them, and of this kind the one that keeps them apart the least. Steps up (or down) are told up to
        ``highest`` [m]."""
        rules = self.site.graph.rules
        low, steep = _LOWEST * rules.headroom, max(_WALL, rules.max_slope)
        high = min(highest, 0.95 * rules.headroom)
        places = [each for each in self._places(of, to) if each.may_join(high)]
        if fits := [each for each in places if each.passes]:
            # the graph, which samples, has lost what only just passes
            return fits[0].tight()
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

    def _centred(self, low: Barrier | None, of: Side, to: Side) -> Barrier | None:
        """A ``low`` passage once more, in the middle of a larger box: it may be wider than what was looked
        at."""
        if low is None:
            return None
        around = np.array([_TILE, _TILE, 0.0])
        again = opening_at(self.site, np.array([low.place - around, low.place + around]), of, to)
        return again.low(low.size - 0.01) or low

    def _places(self, of: Side, to: Side) -> Iterator[Opening]:
        """Where cells ``of`` and ``to`` come near each other, the nearest first."""
        if not len(of.cells) or not len(to.cells):
            return
        a = of.places
        b = to.within(a.min(axis=0) - _FAR, a.max(axis=0) + _FAR)
        away, nearest = (np.asarray(each) for each in of.tree.query(b, distance_upper_bound=_FAR))
        near = np.flatnonzero(np.isfinite(away))
        near = near[np.argsort(away[near], kind="stable")]
        middles = 0.5 * (b[near] + a[nearest[near]])
        tiles = np.unique(np.floor(middles / _TILE), axis=0, return_index=True)[1]
        for k in near[np.sort(tiles)][:_MOST].tolist():
            yield opening_at(self.site, np.array([b[k], a[nearest[k]]]), of, to)

    def ledge(self, of: Side, to: Side) -> Barrier | None:
        """The lowest ledge on the way from cells ``of`` to cells ``to``: how far up, or (negative) down, its
        highest one goes on the easiest way."""
        floor, ends, rises = self._ledges
        here, there = np.zeros((2, int(floor.max(initial=-1)) + 1), np.bool_)
        here[floor[of.cells]] = there[floor[to.cells]] = True
        if (here & there).any():  # one walks there
            return None
        at, forward = _first_to_join(floor[ends], here, there)
        if at < 0 or rises[at] == 0.0:
            return None
        low, high = self.site.graph.surface.centers(ends[at])
        span = np.array([[*(0.5 * (low + high))[:2], z] for z in (low[2], high[2])])
        return Barrier("rise", float(rises[at] if forward else -rises[at]), span[1], span)

    @cached_property
    def _ledges(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(n,) which cells one walks between: they have the same number; and of neighbours that one does not,
        lower first (k, 2), the rise (k,) [m], in its order."""
        surface, rules = self.site.graph.surface, self.site.graph.rules
        low, high, rise = _ledges(
            self.site.mesh_grid.arrays, cells_of(surface), surface.cell_column, rules.max_step, rules.headroom
        )
        link, count = surface.link, len(surface)
        source = [np.flatnonzero(link[:, way] >= 0) for way in (0, 1)]
        target = [link[cells, way] for way, cells in enumerate(source)]
        walked = np.concatenate(source), np.concatenate(target)
        links = coo_array((np.ones(len(walked[0]), np.int8), walked), shape=(count, count))
        order = np.argsort(rise, kind="stable")
        floor = connected_components(links, directed=False)[1]
        return floor, np.stack([low, high], axis=1)[order], rise[order]


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


def opening_at(site: Site, ends: np.ndarray, here: Side, there: Side) -> Opening:
    """The opening around ``ends`` (2, 3) [m] on its two sides; of ``here`` and ``there`` what is near."""
    rules, radius = site.graph.rules, site.character.radius
    aside = _BESIDE + 2.0 * radius
    up = rules.max_step + 0.3
    margin = np.array([aside, aside, up])
    box = np.array([ends.min(axis=0) - margin, ends.max(axis=0) + margin])
    return Opening(
        site.mesh, box, Allowance.of(rules), radius, here.within(box[0], box[1]), there.within(box[0], box[1])
    )


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
