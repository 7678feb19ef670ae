"""Passages that are too narrow for the body though the way around them is long: doors that do not let it
in."""

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from runtime.playtest.barriers import width_at
from runtime.playtest.site import Site

__all__ = ["Passage", "narrow_passages"]

_AROUND = 3.0  # [m] from a passage to the places before and behind it
_DETOUR = 10.0  # [m] that the way around must be longer, to be worth a word
_SLIT = 0.3  # [m] narrower passages are cracks
_APART = 2.0  # [m] passages nearer to each other than this are one


class Passage(NamedTuple):
    """``place`` (3,) [m] of the narrowest spot, its ``width`` [m], and the lengths [m] of the way
    ``through`` it and of the way ``around`` it."""

    place: np.ndarray
    width: float
    through: float
    around: float


def narrow_passages(site: Site, reached: np.ndarray) -> list[Passage]:
    """Passages between places that the body reaches on foot (``reached`` (p,) bool, per part)."""
    graph, radius = site.graph, site.character.radius
    # a passage's samples can lie beside its middle: its true width is measured where one is found
    thin = min(max(graph.rules.min_radius, 0.05), 0.5 * radius)
    doors = np.flatnonzero((graph.radii < radius) & (graph.radii >= thin))
    roomy = np.flatnonzero(np.append(reached, False)[site.node_part])
    if not len(doors) or len(roomy) < 2:
        return []
    tree = KDTree(graph.positions)
    wide, narrow = _walks(site, radius), _walks(site, thin)
    fits = np.zeros(len(graph), dtype=bool)
    fits[roomy] = True
    starts, goals = [], []
    for door in doors:
        near = np.array(tree.query_ball_point(graph.positions[door], _AROUND), dtype=np.int64)
        joined = connected_components(narrow[near][:, near], directed=False)[1]
        near = near[(joined == joined[near == door]) & fits[near]]
        pair = _sides(wide, near, np.linalg.norm(graph.positions[near] - graph.positions[door], axis=1))
        if pair is not None:
            starts.append(graph.positions[pair[0]])
            goals.append(graph.positions[pair[1]])
    if not starts:
        return []
    through = graph.find_paths(np.array(starts), np.array(goals), radius=thin)
    skills = dict(site.character.skills)
    around = graph.find_paths(np.array(starts), np.array(goals), radius=radius, skills=skills)
    extra = around.length - through.length
    worth = (through.status == "complete") & (around.status == "complete")
    worth &= (through.length <= 2.0 * _AROUND + 1.0) & (extra >= _DETOUR)
    found: list[Passage] = []
    for k in np.flatnonzero(worth)[np.argsort(-extra[worth], kind="stable")]:
        points = through[int(k)].on_surface(0.05)
        place = points[np.argmin(graph.clearance_at(points))]
        width = width_at(site, place)
        if not _SLIT <= width < 2.0 * radius or any(
            np.linalg.norm(each.place - place) < _APART for each in found
        ):
            continue
        found.append(Passage(place, width, float(through.length[k]), float(around.length[k])))
    return found


def _walks(site: Site, radius: float) -> csr_array:
    """(m, m) sparse: the edges that a body of ``radius`` [m] passes."""
    graph = site.graph
    source = np.repeat(np.arange(len(graph)), np.diff(graph.edge_start))
    passes = (graph.edge_width >= radius) & (graph.radii[source] >= radius)
    passes &= graph.radii[graph.edge_target] >= radius
    ends = (source[passes], graph.edge_target[passes])
    return coo_array((np.ones(len(ends[0])), ends), shape=(len(graph),) * 2).tocsr()


def _sides(walks: csr_array, near: np.ndarray, away: np.ndarray) -> tuple[int, int] | None:
    """Of nodes ``near`` (k,) a passage, ``away`` (k,) [m] from it, the nearest on each side: two that one
    does not walk between without going farther off; None when all are on one side."""
    if len(near) < 2:
        return None
    count, side = connected_components(walks[near][:, near], directed=False)
    if count < 2:
        return None
    first = int(np.argmin(away))
    others = np.flatnonzero(side != side[first])
    return int(near[first]), int(near[others[np.argmin(away[others])]])
