"""Passages that are too narrow for the body though the way around them is long: doors that do not let it
in.

One sees through them: from places where the body can be, lines go all ways, as far as through a door. What
they come to, past walls and over floor, and what is a long way to walk to is behind a passage.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components, dijkstra

from navmesh.level.mesh_queries import crossed, surface_below
from navmesh.level.raster import FLOOR, KIND
from runtime.playtest.barriers import SLIT, opening_at
from runtime.playtest.openings import Barrier
from runtime.playtest.sides import Side
from runtime.playtest.site import Site
from surefoot.kernels import allocating_kernel

__all__ = ["Passage", "narrow_passages"]

_THICK = 1.0  # [m] thickest wall that a passage leads through
_DETOUR = 10.0  # [m] that the way around must be longer, to be worth a word
_LONG = 8.0  # [m] shorter ways from node to node are not looked at
_AROUND = 1.5  # [m] around a passage that tells its two sides apart
_APART = 2.0  # [m] passages nearer to each other than this are one
_WAYS = 24  # directions that one looks in
_ALONG = 0.1  # [m] at which floor is looked for
_TILE = 0.5  # [m] of a boundary of which one place is looked at


class Passage(NamedTuple):
    """The narrowest spot, and the lengths [m] of the way ``through`` it and of the way ``around`` it."""

    barrier: Barrier
    through: float
    around: float


def narrow_passages(site: Site, reached: np.ndarray) -> list[Passage]:
    """Passages between places that the body reaches on foot (``reached`` (p,) bool, per part)."""
    graph, radius = site.graph, site.character.radius
    cells = np.flatnonzero(np.append(reached, False)[site.cell_part])
    if len(cells) < 2:
        return []
    side = Side(graph.surface, cells)
    places = side.places
    start, end = _seen_through(site, side)
    if not len(start):
        return []
    through = np.linalg.norm(places[end] - places[start], axis=1)
    # a route there can be longer than the same way back
    skills = dict(site.character.skills)
    ways = [(places[start], places[end]), (places[end], places[start])]
    routes = [graph.find_paths(*way, radius=radius, skills=skills) for way in ways]
    around = np.min([np.where(each.status == "complete", each.length, np.inf) for each in routes], axis=0)
    extra = around - through
    worth = np.isfinite(around) & (extra >= _DETOUR)
    found: list[Passage] = []
    for k in np.flatnonzero(worth)[np.argsort(-extra[worth], kind="stable")].tolist():
        ends = places[[start[k], end[k]]]
        if any(np.linalg.norm(each.barrier.place - ends.mean(axis=0)) < _APART for each in found):
            continue
        barrier = _narrowest(site, side, ends, int(cells[start[k]]), int(cells[end[k]]))
        if barrier is None or any(
            np.linalg.norm(each.barrier.place - barrier.place) < _APART for each in found
        ):
            continue
        found.append(Passage(barrier, float(through[k]), float(around[k])))
    return found


def _seen_through(site: Site, side: Side) -> tuple[np.ndarray, np.ndarray]:
    """Indices (k,) each of the places of a ``side`` that see each other over a boundary that is not walked:
    of every bit of it the nearest two."""
    cells, places = side.cells, side.places
    surface, rules, radius = site.graph.surface, site.graph.rules, site.character.radius
    edge = np.flatnonzero(surface.clearance[cells] < radius + 1.5 * surface.resolution)
    turns = 2.0 * math.pi * np.arange(_WAYS) / _WAYS
    far = 2.0 * (radius + surface.resolution) + _THICK
    points, ways = (
        np.repeat(edge, _WAYS),
        np.tile(np.column_stack([np.cos(turns), np.sin(turns)]), (len(edge), 1)),
    )
    least = 2.0 * radius  # walls on both sides keep the body's middle this far from the places behind
    heights = (
        rules.max_step + 0.05 + np.array([0.0, 0.35, 0.7, 0.92]) * (rules.headroom - rules.max_step - 0.05)
    )
    local = places[points] - surface.origin
    reach = _sights(site.mesh_grid.arrays, local, ways, far, rules.max_step, heights)
    starts, ends = [], []
    for along in np.arange(least, far + 1e-9, 0.5 * surface.resolution):
        seen = np.flatnonzero(reach >= along)
        at = places[points[seen]] + np.column_stack([along * ways[seen], np.zeros(len(seen))])
        off, cell = (
            np.asarray(each)
            for each in side.tree.query(at, distance_upper_bound=0.71 * surface.resolution + 0.1)
        )
        near = np.isfinite(off)
        starts.append(points[seen[near]])
        ends.append(cell[near])
    start, end = np.concatenate(starts), np.concatenate(ends)
    walked = _walked(site, cells[start], cells[end])
    start, end = start[~walked], end[~walked]
    away = np.linalg.norm(places[end] - places[start], axis=1)
    order = np.argsort(away, kind="stable")
    middle = np.floor(0.5 * (places[start] + places[end])[order] / _TILE)
    first = order[np.sort(np.unique(middle, axis=0, return_index=True)[1])] if len(order) else order
    return start[first], end[first]


def _walked(site: Site, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """(k,) bool: whether it is no long way to walk from cells ``start`` (k,) to cells ``end``, as far as the
    nodes tell."""
    graph = site.graph
    begin, stop = graph.label[start], graph.label[end]
    walked = np.zeros(len(start), dtype=bool)
    for nodes in np.array_split(np.unique(begin), max(1, len(graph) * len(np.unique(begin)) // 4_000_000)):
        away = np.asarray(dijkstra(site.walks, indices=nodes, limit=_LONG))
        mine = np.flatnonzero(np.isin(begin, nodes))
        walked[mine] = np.isfinite(away[np.searchsorted(nodes, begin[mine]), stop[mine]])
    return walked


def _narrowest(site: Site, whole: Side, ends: np.ndarray, start: int, end: int) -> Barrier | None:
    """The passage between cells ``start`` and ``end`` of the ``whole``, which are at ``ends`` (2, 3) [m];
    None where the body fits through."""
    surface = site.graph.surface
    middle, reach = ends.mean(axis=0), _AROUND + 0.5 * float(np.linalg.norm(ends[1] - ends[0]))
    around = np.array([reach, reach, 1.0])
    near = whole.cells[whole.rows_within(middle - around, middle + around)]
    link = surface.links(near)
    at = np.minimum(np.searchsorted(near, link), len(near) - 1)
    other = np.where(near[at] == link, at, -1)
    one, way = np.nonzero(other >= 0)
    links = coo_array((np.ones(len(one)), (one, other[one, way])), shape=(len(near),) * 2)
    side = connected_components(links, directed=False)[1]
    here, there = side[np.searchsorted(near, [start, end])]
    if here == there:
        return None
    place = opening_at(site, ends, *(Side(surface, near[side == each]) for each in (here, there)))
    return None if place.passes else place.narrow(SLIT)


@allocating_kernel
def _sights(grid, points, ways, far, step, heights):
    """How far [m] one sees from each of ``points`` (k, 3) along ``ways`` (k, 2), at most ``far``, at all of
    ``heights`` (h,) over the floor, and over floor that goes on without a rise of more than a ``step``."""
    reach = np.zeros(len(points))
    for k in range(len(points)):
        x, y, z = points[k]
        along = 0.0
        while along < far - 1e-9:
            u, v = x + _ALONG * ways[k, 0], y + _ALONG * ways[k, 1]
            floor, which = surface_below(grid, u, v, z - step, z + step)
            if which < 0 or grid.triangles[which, KIND] != FLOOR:
                break
            free = True
            for up in heights:
                free = free and not crossed(grid, x, y, z + up, u, v, floor + up)
            if not free:
                break
            x, y, z = u, v, floor
            along += _ALONG
        reach[k] = along
    return reach
